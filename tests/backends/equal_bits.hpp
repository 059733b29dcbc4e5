// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "../support/coefficients.hpp"
#include "../support/landau_lifshitz.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <string>

namespace cayspin::test {

using Threaded = Kokkos::DefaultHostExecutionSpace;

/// Fixture of typed tests with fields in host memory.
template <class Real>
struct InHostMemory : ::testing::Test {
  using Field = SpinField<Real, Kokkos::HostSpace>;
};

inline std::string name_of(Lattice const& lattice) {
  std::string name;
  for (int a = 0; a < 3; ++a)
    name += std::to_string(lattice.shape[a]) +
            (lattice.boundary[a] == Boundary::periodic ? " periodic " : " open ");
  return name;
}

/// Lattices with irregular extents, open and periodic: with rows shorter and longer than a pack and
/// than a task; with few sites, which the calling thread computes by itself, and with many.
inline std::vector<Lattice> odd_lattices() {
  std::vector<Lattice> lattices;
  std::array<std::int64_t, 3> const shapes[] = {
      {1, 1, 1},   {2, 1, 1},   {7, 1, 1}, {100, 1, 1},  {9001, 1, 1}, {20011, 1, 1},
      {53, 67, 1}, {3, 971, 1}, {9, 7, 5}, {15, 14, 13}, {33, 20, 7},  {61, 37, 11}};
  for (auto const& shape : shapes)
    for (Boundary const b : {Boundary::open, Boundary::periodic})
      lattices.push_back({shape, {1, 0.9, 1.1}, {b, b, b}});
  return lattices;
}

inline Slab every_term(Lattice const& lattice) {
  return {.lattice = lattice,
          .exchange = 0.7,
          .anisotropy = 0.6,
          .axis = {1, 2, 3},
          .demag = 0.8,
          .applied = {0.3, 0.1, 0.4},
          .damping = 0.1};
}

constexpr auto natural = [](Slab const& slab) { return slab.natural(); };

/// Returns a generator with site-dependent coefficients and vacancies.
template <class Field>
auto site_dependent(Slab const& slab) {
  auto const numbers = [&](auto const& value) { return numbers_on<Field>(slab.lattice, value); };
  EffectiveField const field(
      SiteDependentExchange(numbers([](auto site) { return 0.1 * (site % 8); })),
      SiteDependentUniaxialAnisotropy(numbers([](auto site) { return 0.4 - 0.1 * (site % 9); }),
                                      random_spins<Field>(slab.lattice, 3)),
      Zeeman{slab.applied});
  return LandauLifshitz(
      FieldWithVacancies(field, numbers([](auto site) { return site % 6 == 1 ? 0 : 1; })),
      numbers([](auto site) { return 0.05 * (site % 5); }));
}

template <class Real>
void expect_equal_bits(std::vector<Real> const& a, std::vector<Real> const& b,
                       std::string const& where) {
  ASSERT_EQ(a.size(), b.size()) << where;
  EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(Real)), 0) << where;
}

inline void expect_equal_bits(double a, double b, std::string const& where) {
  EXPECT_EQ(std::bit_cast<std::uint64_t>(a), std::bit_cast<std::uint64_t>(b)) << where;
}

/// The spins after four steps on an execution space, and their scalars.
template <class Exec, class Stepper, class Generator>
struct Outcome {
  using Field = typename Stepper::spins_type;
  using Real = typename Field::value_type;

  Outcome(Generator const& generator, Field const& start) {
    Exec const exec;
    Field spins = copy_of(start);
    Stepper stepper(spins);
    for (int n = 0; n < 4; ++n) stepper.step(exec, generator, spins, n * 0.1, 0.1);
    exec.fence();
    numbers = copy_to_host(spins);
    seen = sample(exec, generator, Step{}, spins, generator);
  }

  std::vector<Real> numbers;
  Sample seen;
};

template <class Stepper, class Choose>
void expect_same_on_host_spaces_of(Choose const& choose, std::vector<Lattice> const& lattices) {
  SCOPED_TRACE(::testing::internal::GetTypeName<Stepper>());
  using Field = typename Stepper::spins_type;
  for (Lattice const& lattice : lattices) {
    auto const generator = choose(every_term(lattice));
    using Generator = std::remove_const_t<decltype(generator)>;
    auto const start = random_spins<Field>(lattice, 11);
    Outcome<Host, Stepper, Generator> const one(generator, start);
    Outcome<Threaded, Stepper, Generator> const many(generator, start);
    auto const where = name_of(lattice);
    ASSERT_NE(one.numbers, copy_to_host(start)) << "nothing moved: " << where;
    expect_equal_bits(one.numbers, many.numbers, where + "spins");
    Sample const &a = one.seen, &b = many.seen;
    expect_equal_bits(a.energy.value, b.energy.value, where + "energy");
    expect_equal_bits(a.energy.magnitude, b.energy.magnitude, where + "energy magnitude");
    expect_equal_bits(a.norm_defect, b.norm_defect, where + "norm defect");
    expect_equal_bits(a.largest_rate, b.largest_rate, where + "largest rate");
    expect_equal_bits(a.magnetization.x, b.magnetization.x, where + "m_x");
    expect_equal_bits(a.magnetization.y, b.magnetization.y, where + "m_y");
    expect_equal_bits(a.magnetization.z, b.magnetization.z, where + "m_z");
  }
}

/// Compares spins and scalars after four steps on Serial and the threaded space, bit by bit.
template <class... Steppers, class Choose>
void expect_same_on_host_spaces(Choose const& choose,
                                std::vector<Lattice> const& lattices = odd_lattices()) {
  (expect_same_on_host_spaces_of<Steppers>(choose, lattices), ...);
}

}  // namespace cayspin::test
