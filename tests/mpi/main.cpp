// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Runs the tests on all ranks at once. One rank prints; a failure on any rank fails the program.
#include <Kokkos_Core.hpp>
#include <gtest/gtest.h>
#include <mpi.h>

namespace {

/// Listener that makes a test fail on all ranks if it fails on one, so that the rank that prints
/// reports it.
class FailuresOfOthers : public ::testing::EmptyTestEventListener {
  void OnTestEnd(::testing::TestInfo const& test) override {
    int failed = test.result()->Failed() ? 1 : 0, here = failed;
    MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPI_INT, MPI_SUM, MPI_COMM_WORLD);
    if (failed > here) ADD_FAILURE() << failed << " of the ranks failed";
  }
};

}  // namespace

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  ::testing::InitGoogleTest(&argc, argv);
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  auto& listeners = ::testing::UnitTest::GetInstance()->listeners();
  if (rank != 0) delete listeners.Release(listeners.default_result_printer());
  listeners.Append(new FailuresOfOthers);
  int result = 0;
  {
    Kokkos::ScopeGuard const kokkos(argc, argv);
    result = RUN_ALL_TESTS();
  }
  MPI_Finalize();
  return result;
}
