// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "../support/mean_field.hpp"
#include "equal_bits.hpp"

#include <cmath>
#include <vector>

namespace cayspin::test {

/// The lattices of odd_lattices(), and some with long rows, which a sweep cuts into many blocks.
inline std::vector<Lattice> swept_lattices() {
  auto lattices = odd_lattices();
  std::array<std::int64_t, 3> const wide[] = {{2003, 41, 3}, {3001, 53, 1}, {1003, 17, 13}};
  for (auto const& shape : wide)
    for (Boundary const b : {Boundary::open, Boundary::periodic})
      lattices.push_back({shape, {1, 0.9, 1.1}, {b, b, b}});
  lattices.push_back(
      {{301, 37, 5}, {1, 1, 1}, {Boundary::open, Boundary::periodic, Boundary::open}});
  lattices.push_back(
      {{301, 5, 37}, {1, 1, 1}, {Boundary::periodic, Boundary::open, Boundary::periodic}});
  return lattices;
}

/// The lattices of swept_lattices() with at most 60000 sites, for slower tests.
inline std::vector<Lattice> smaller_swept_lattices() {
  auto lattices = swept_lattices();
  std::erase_if(lattices, [](Lattice const& lattice) { return lattice.sites() > 60000; });
  return lattices;
}

inline bool can_sweep(Lattice const& lattice, int stages) {
  auto const rows = lattice.shape[1];
  return lattice.boundary[1] == Boundary::open || rows == 1 || rows >= stages;
}

/// Returns a generator with exchange, anisotropy and a rotating field.
inline auto turning(Slab const& slab) {
  return LandauLifshitz(EffectiveField(Exchange(slab.lattice, slab.exchange),
                                       UniaxialAnisotropy(slab.anisotropy, slab.axis),
                                       TimeDependentZeeman([](double t) {
                                         return Vec3<double>{std::cos(t), std::sin(t), 0.3};
                                       })),
                        slab.damping);
}

/// Expects passes instead of sweeps under a field that depends on the spins of all sites.
template <class Stepper, class... Options>
void expect_passes_under_a_nonlocal_field(double dt, Options const&... options) {
  using Field = typename Stepper::spins_type;
  auto const lattice = Lattice::cubic(70, 20, 20);
  LandauLifshitz const generator(EffectiveField(Exchange(lattice, 1), MeanField(0.7)), 0.1);
  auto one = random_spins<Field>(lattice, 4), other = copy_of(one);
  Stepper passing(one, options...), sweeping(other, options...);
  passing.use(Path::pass);
  sweeping.use(Path::sweep);
  Threaded const exec;
  passing.step(exec, generator, one, 0, dt);
  sweeping.step(exec, generator, other, 0, dt);
  EXPECT_EQ(sweeping.path(), Path::pass);
  EXPECT_EQ(sweeping.work_bytes(), passing.work_bytes());
  expect_equal_bits(copy_to_host(one), copy_to_host(other), "nonlocal");
}

/// Expects a stepper to choose passes for 8^3 sites and sweeps for n^3 sites, and to take as much
/// memory as predicted.
template <class Stepper, class... Options>
void expect_chosen_and_predicted(std::int64_t n, Options const&... options) {
  int const threads = Threaded().concurrency();
  for (auto const& [extent, path] : {std::pair(std::int64_t{8}, Path::pass), {n, Path::sweep}}) {
    auto const lattice = Lattice::cubic(extent, extent, extent);
    Stepper const stepper(typename Stepper::spins_type("spins", lattice), options...);
    EXPECT_EQ(stepper.path(), path) << extent;
    EXPECT_EQ(stepper.work_bytes(), Stepper::work_bytes(lattice, {.threads = threads})) << extent;
  }
}

}  // namespace cayspin::test
