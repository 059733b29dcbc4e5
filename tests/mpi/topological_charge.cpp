// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The topological charge of a divided lattice is bitwise identical to that of the whole one, and
// planes are numbered as in the whole one.
#include "../support/backends.hpp"

#include <cayspin/cayspin.hpp>
#include <cayspin/mpi/domain.hpp>

namespace cayspin::test {
namespace {

TEST(TopologicalCharge, OfPartsHasTheBitsOfTheWhole) {
  using Spins = SpinField<double, Kokkos::HostSpace>;
  Kokkos::DefaultHostExecutionSpace const exec;
  int ranks = 0;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  for (auto const boundary : {Boundary::open, Boundary::periodic})
    for (mpi::Division const& division : {mpi::Division{ranks, 1}, mpi::Division{1, ranks}}) {
      auto const lattice = Lattice::cubic(19, 13, 9, 1, boundary);
      auto const m = random_directions(lattice.sites(), 7);
      auto const spins = spins_of<Spins>(lattice, m);

      mpi::Domain const domain(MPI_COMM_WORLD, lattice, 1, division);
      Lattice const& local = domain.local();
      std::vector<double> own;
      for (std::int64_t z = 0; z < local.own(2); ++z)
        for (std::int64_t y = 0; y < local.own(1); ++y) {
          auto const row = domain.begin()[1] + local.ghosts[1].before + y +
                           13 * (domain.begin()[2] + local.ghosts[2].before + z);
          own.insert(own.end(), m.begin() + 3 * 19 * row, m.begin() + 3 * 19 * (row + 1));
        }
      auto const part = spins_of<Spins>(local, own);
      EXPECT_EQ(topological_charge(exec, part), topological_charge(exec, spins));
      for (std::int64_t z = 0; z < 9; ++z)
        EXPECT_EQ(topological_charge(exec, part, z), topological_charge(exec, spins, z)) << z;
      EXPECT_THROW(topological_charge(exec, part, 9), std::invalid_argument);
    }
}

}  // namespace
}  // namespace cayspin::test
