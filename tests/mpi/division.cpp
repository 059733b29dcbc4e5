// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Divisions of lattices, and the refusal of wrong ones.
#include <cayspin/cayspin.hpp>
#include <cayspin/crystal.hpp>
#include <cayspin/field/pair_couplings.hpp>
#include <cayspin/mpi/domain.hpp>

#include <gtest/gtest.h>

#include <vector>

namespace cayspin::test {
namespace {

using mpi::divide;
using mpi::Division;

TEST(Division, RepeatsLeast) {
  EXPECT_EQ(divide(Lattice::cubic(8, 64, 64), 4, 2), (Division{1, 2}));
  EXPECT_EQ(divide(Lattice::cubic(8, 64, 64), 4, 4), (Division{2, 2}));
  EXPECT_EQ(divide(Lattice::cubic(8, 16, 64), 4, 4), (Division{1, 4}));
  EXPECT_EQ(divide(Lattice::cubic(8, 128, 16), 4, 4), (Division{4, 1}));
  EXPECT_EQ(divide(Lattice::cubic(64, 64, 64), 4, 64), (Division{8, 8}));
  EXPECT_EQ(divide(Lattice::square(64, 64), 4, 3), (Division{3, 1}));
  EXPECT_EQ(divide(Lattice::chain(64), 4, 1), (Division{1, 1}));
}

TEST(Division, DependsOnTheDepths) {
  EXPECT_EQ(divide(Lattice::cubic(8, 64, 64), {1, 4}, 2), (Division{2, 1}));
  EXPECT_EQ(divide(Lattice::cubic(8, 64, 64), {4, 1}, 2), (Division{1, 2}));
  EXPECT_EQ(divide(Lattice::cubic(8, 64, 64), {1, 4}, 4), (Division{4, 1}));
  // Ghosts along z are whole cells, here of two planes.
  EXPECT_EQ(divide(Crystal::bcc().lattice({3, 12, 8}), 1, 2), (Division{2, 1}));
}

TEST(Division, DepthsAreCountedInWords) {
  EXPECT_EQ(mpi::to_text(1), "1 row or plane");
  EXPECT_EQ(mpi::to_text({1, 2}), "1 row or 2 planes");
  EXPECT_EQ(mpi::to_text(4), "4 rows or planes");
}

TEST(Division, WhatDoesNotFitIsRefused) {
  EXPECT_THROW(divide(Lattice::chain(64), 4, 2), std::invalid_argument);
  EXPECT_THROW(divide(Lattice::cubic(8, 7, 7), 4, 2), std::invalid_argument);
  EXPECT_EQ(divide(Lattice::cubic(8, 7, 8), 4, 2), (Division{1, 2}));
}

TEST(Division, DomainsAreHeldAgainstTheRanks) {
  EXPECT_THROW(mpi::Domain(MPI_COMM_SELF, Lattice::cubic(8, 8, 8), 2, {2, 1}),
               std::invalid_argument);
  EXPECT_THROW(mpi::Domain(MPI_COMM_SELF, Lattice::cubic(8, 8, 8), 0), std::invalid_argument);
  mpi::Domain const alone(MPI_COMM_SELF, Lattice::cubic(8, 8, 8), 2);
  EXPECT_EQ(alone.local().shape, (std::array<std::int64_t, 3>{8, 8, 8}));
}

// The ghosts of such a lattice would belong to no rank.
TEST(Division, PartsAreNotDivided) {
  int ranks = 0;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  mpi::Domain const domain(MPI_COMM_WORLD, Lattice::cubic(8, 8, 32), 2, {1, ranks});
  EXPECT_THROW(mpi::Domain(MPI_COMM_SELF, domain.local(), 2), std::invalid_argument);
  auto with_ghosts = Lattice::cubic(8, 8, 32);
  with_ghosts.ghosts[2] = {2, 2};
  EXPECT_THROW(mpi::Domain(MPI_COMM_SELF, with_ghosts, 2), std::invalid_argument);
}

// Planes of parts and of their ghosts come in whole cells.
TEST(Division, PartsOfCrystalsHoldWholeCells) {
  int ranks = 0, rank = 0;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  auto const bcc = Crystal::bcc().lattice({3, 7, 9});
  EXPECT_EQ(divide(bcc, 4, 2), (Division{1, 2}));
  EXPECT_TRUE(mpi::can_divide(bcc, {2, 5}, {3, 3}));
  EXPECT_FALSE(mpi::can_divide(bcc, {2, 7}, {1, 3}));
  EXPECT_FALSE(mpi::can_divide(bcc, {3, 5}, {3, 3}));
  mpi::Domain const domain(MPI_COMM_WORLD, bcc, {1, 3}, {1, ranks});
  auto const& local = domain.local();
  EXPECT_EQ(domain.begin()[2] % 2, 0);
  EXPECT_EQ(local.own(2) % 2, 0);
  EXPECT_EQ(local.ghosts[2], (Ghosts{rank > 0 ? 4 : 0, rank + 1 < ranks ? 4 : 0}));
  EXPECT_EQ(local.ghosts[1], Ghosts{});
}

// Every rank throws, whichever rank differs.
TEST(Division, RanksThatDisagreeAreRefused) {
  int rank = 0, ranks = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  if (ranks == 1) return;
  auto const last = rank + 1 == ranks;
  auto const open = Lattice::cubic(4, 4, 32), longer = Lattice::cubic(4, 4, 36),
             closed = Lattice::cubic(4, 4, 32, 1, Boundary::periodic);
  EXPECT_THROW(mpi::Domain(MPI_COMM_WORLD, last ? longer : open, 2), std::invalid_argument);
  EXPECT_THROW(mpi::Domain(MPI_COMM_WORLD, last ? closed : open, 2), std::invalid_argument);
  EXPECT_THROW(mpi::Domain(MPI_COMM_WORLD, open, last ? 3 : 2), std::invalid_argument);
  auto crystal = open;
  crystal.cell_sites = 2;
  EXPECT_THROW(mpi::Domain(MPI_COMM_WORLD, last ? crystal : open, 2), std::invalid_argument);
  auto const copies = open.with_replicas(2);
  EXPECT_THROW(mpi::Domain(MPI_COMM_WORLD, last ? copies : open, 2), std::invalid_argument);
  crystal.cell_sites = 0;
  EXPECT_THROW(mpi::Domain(MPI_COMM_WORLD, crystal, 2), std::invalid_argument);
  EXPECT_THROW(mpi::Domain(MPI_COMM_WORLD, open, mpi::Depth(2, last ? 3 : 2)),
               std::invalid_argument);
}

TEST(Division, SteppersNeedTheirGhosts) {
  int ranks = 0;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  mpi::Domain const domain(MPI_COMM_WORLD, Lattice::cubic(4, 4, 16), 3);
  SpinField<double> const spins("spins", domain.local());
  if (ranks > 1)
    EXPECT_THROW(Rkmk4 const stepper(spins), std::invalid_argument);
  else
    Rkmk4 const stepper(spins);
  LieHeun const fits(spins);
}

TEST(Division, CouplingsNeedGhostsAsFarAsTheyReach) {
  int ranks = 0;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  if (ranks == 1) return;
  auto const lattice = Lattice::cubic(3, 4, 12);
  std::vector const bonds{Coupling::of({0, 0}, {0, 0, -2}, 1.0)};
  mpi::Domain const thin(MPI_COMM_WORLD, lattice, 1, {1, ranks}),
      thick(MPI_COMM_WORLD, lattice, {1, 2}, {1, ranks});
  EXPECT_THROW(PairCouplings(thin.local(), bonds), std::invalid_argument);
  // Evaluations are refused, because between the stages of a step, ghosts are not updated as deep
  // as the bonds reach.
  PairCouplings const field(thick.local(), bonds);
  SpinField<double> const spins("spins", thick.local());
  EXPECT_THROW(energy(Kokkos::DefaultExecutionSpace(), field, spins), std::invalid_argument);
}

}  // namespace
}  // namespace cayspin::test
