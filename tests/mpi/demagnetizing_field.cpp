// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The demagnetising field of a lattice divided among ranks is bitwise identical to that on a single
// rank, and so are steps that evaluate it, in each stage or once a step.
#include "../support/backends.hpp"
#include "divisions.hpp"

#include <cayspin/demagnetization/demagnetizing_field.hpp>

#include <bit>
#include <type_traits>

namespace cayspin::test {
namespace {

template <class Real>
using HostSpins = SpinField<Real, Kokkos::HostSpace>;

struct Body {
  std::array<std::int64_t, 3> shape;
  std::array<int, 3> images = {};

  Lattice lattice(Boundary boundary = Boundary::open) const {
    return {shape, {1, 1.3, 0.4}, {boundary, boundary, boundary}};
  }
};

// One, two and three dimensions; fewer wave numbers along x than ranks; blocks of rows that parts
// share.
Body const bodies[] = {
    {{13, 17, 19}},        {{7, 5, 9}},    {{9, 37, 1}},           {{35, 1, 12}},
    {{1, 41, 1}},          {{1, 1, 23}},   {{1, 12, 9}},           {{2, 8, 8}},
    {{70, 9, 4}},          {{16, 16, 16}}, {{6, 7, 8}, {2, 0, 0}}, {{5, 6, 11}, {0, 1, 3}},
    {{4, 9, 1}, {3, 2, 0}}};

template <class Real>
class DemagnetizingFieldOnRanks : public ::testing::Test {
 protected:
  static std::vector<double> numbers_of(HostSpins<Real> const& field) {
    auto const numbers = copy_to_host(field);
    return {numbers.begin(), numbers.end()};
  }

  /// Expects work(body, spins) to return bitwise identical numbers on divided lattices and on one
  /// rank: first three for each of the sites, then any that are equal on all ranks.
  template <class Work>
  void expect_equal_bits(Boundary boundary, int depth, Work const& work) {
    int compared = 0;
    for (Body const& body : bodies) {
      auto const lattice = body.lattice(boundary);
      auto const m = random_directions(lattice.sites(), 3);
      auto whole_spins = spins_of<HostSpins<Real>>(lattice, m);
      auto const of_one = work(body, whole_spins);
      auto const sites = static_cast<std::ptrdiff_t>(3 * lattice.sites());
      for (auto const& division : divisions(lattice, depth)) {
        SCOPED_TRACE(name_of(lattice, division));
        mpi::Domain const domain(MPI_COMM_WORLD, lattice, depth, division);
        auto const& local = domain.local();
        auto spins = spins_of<HostSpins<Real>>(local, numbers_of_part(local, m));
        auto const found = work(body, spins);
        auto expected = numbers_of_part(local, {of_one.begin(), of_one.begin() + sites});
        expected.insert(expected.end(), of_one.begin() + sites, of_one.end());
        ASSERT_EQ(found.size(), expected.size());
        for (std::size_t i = 0; i < found.size(); ++i)
          ASSERT_EQ(std::bit_cast<std::uint64_t>(found[i]),
                    std::bit_cast<std::uint64_t>(expected[i]))
              << "number " << i << ": " << found[i] << " and " << expected[i];
        ++compared;
      }
    }
    EXPECT_GT(compared, 3);
  }
};
using Precisions = ::testing::Types<float, double>;
TYPED_TEST_SUITE(DemagnetizingFieldOnRanks, Precisions);

TYPED_TEST(DemagnetizingFieldOnRanks, HasEqualBits) {
  using Real = TypeParam;
  this->expect_equal_bits(Boundary::open, 1, [&](Body const& body, HostSpins<Real> const& spins) {
    auto const& lattice = spins.lattice();
    HostSpins<Real> const field("field", lattice);
    DemagnetizingField<Real> const demag(lattice, {0.8, body.images});
    // The second call uses work memory left by the first one.
    for (int again = 0; again < 2; ++again) demag(spins, field, 0);
    return this->numbers_of(field);
  });
}

// All ranks together need as much memory as a single rank would, plus one spectrum.
TEST(DemagnetizingFieldOfParts, SharesItsMemory) {
  auto const lattice = Lattice::cubic(31, 16, 16);
  auto const of_one = DemagnetizingField<double>::work_bytes(lattice);
  mpi::Domain const domain(MPI_COMM_WORLD, lattice, 1);
  auto bytes = DemagnetizingField<double>::work_bytes(domain.local());
  MPI_Allreduce(MPI_IN_PLACE, &bytes, 1, MPI_INT64_T, MPI_SUM, MPI_COMM_WORLD);
  std::int64_t const spectrum = 6 * 8 * 32 * 16 * 16;
  EXPECT_EQ(bytes, of_one + (ranks() > 1 ? spectrum : 0));
}

TYPED_TEST(DemagnetizingFieldOnRanks, StepsWithEqualBits) {
  using Real = TypeParam;
  using Spins = HostSpins<Real>;
  using Field = HostField<Spins, DemagnetizingField<Real>>;
  Kokkos::DefaultHostExecutionSpace const exec;
  auto const run = [&](auto const& demag, auto stepper, Spins& spins) {
    auto const& lattice = spins.lattice();
    LandauLifshitz const generator(
        EffectiveField(Exchange(lattice, 0.4), demag, Zeeman{{0.1, 0, 0.2}}), 0.1);
    std::vector<double> numbers;
    auto const look = [&](auto const& exec_of_run, Step const& step, Spins const& now) {
      Sample const s = sample(exec_of_run, generator, step, now, generator);
      numbers.insert(numbers.end(), {s.energy.value, s.energy.magnitude, s.magnetization.x,
                                     s.magnetization.y, s.magnetization.z, s.largest_rate});
    };
    integrate(exec, stepper, generator, spins, Times{0, 0.05, 5}, look);
    auto of_sites = this->numbers_of(spins);
    of_sites.insert(of_sites.end(), numbers.begin(), numbers.end());
    return of_sites;
  };
  auto const field_of = [](Body const& body, Spins const& spins) {
    return Field(spins, DemagnetizingField<Real>(spins.lattice(), {0.8, body.images}));
  };
  this->expect_equal_bits(Boundary::periodic, 4, [&](Body const& body, Spins& spins) {
    return run(field_of(body, spins), Rkmk4<Spins>(spins), spins);
  });
  this->expect_equal_bits(Boundary::open, 2, [&](Body const& body, Spins& spins) {
    SlowField const demag(spins, field_of(body, spins));
    return run(demag, Multirate(spins, LieHeun<Spins>(spins), demag, {.substeps = 2}), spins);
  });
}

}  // namespace
}  // namespace cayspin::test
