// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Ranks divide the cores that they share, unless the user has said how many threads there are.
#include "simulation/threads_of_rank.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace cayspin::simulation::test {
namespace {

/// Removes the variables that set a number of threads, and restores them at the end.
class ThreadsOfRank : public testing::Test {
 protected:
  ThreadsOfRank() {
    for (char const* const name : {"OMP_NUM_THREADS", "KOKKOS_NUM_THREADS"}) {
      if (char const* const value = std::getenv(name)) before_[name] = value;
      ::unsetenv(name);
    }
  }
  ~ThreadsOfRank() override {
    for (auto const& [name, value] : before_) ::setenv(name.c_str(), value.c_str(), 1);
  }

 private:
  std::map<std::string, std::string> before_;
};

TEST_F(ThreadsOfRank, AreAShareOfTheCores) {
  EXPECT_EQ(threads_of_rank("openmp", 16, 4), 4);
  EXPECT_EQ(threads_of_rank("openmp", 16, 3), 5);
  EXPECT_EQ(threads_of_rank("openmp", 16, 1), 16);
  EXPECT_EQ(threads_of_rank("openmp", 2, 4), 1);
}

TEST_F(ThreadsOfRank, AreNotSetForSerial) {
  EXPECT_EQ(threads_of_rank("serial", 16, 4), std::nullopt);
}

TEST_F(ThreadsOfRank, AreNotSetBesideAVariable) {
  for (char const* const name : {"OMP_NUM_THREADS", "KOKKOS_NUM_THREADS"}) {
    ::setenv(name, "3", 1);
    EXPECT_EQ(threads_of_rank("openmp", 16, 4), std::nullopt) << name;
    ::unsetenv(name);
  }
}

std::vector<int> sharing_of_each(std::vector<Cores> const& cores) {
  std::vector<int> sharing;
  for (std::size_t rank = 0; rank < cores.size(); ++rank)
    sharing.push_back(sharing_cores(cores, rank));
  return sharing;
}

TEST(CoresOfRanks, AreSharedByRanksThatMayRunOnThem) {
  Cores const first(0x0f), second(0xf0), both(0xff), unknown;
  EXPECT_EQ(sharing_of_each({both, both, both}), (std::vector{3, 3, 3}));
  EXPECT_EQ(sharing_of_each({first, second}), (std::vector{1, 1}));
  EXPECT_EQ(sharing_of_each({first, second, first}), (std::vector{2, 1, 2}));
  EXPECT_EQ(sharing_of_each({first, second, both}), (std::vector{2, 2, 3}));
  EXPECT_EQ(sharing_of_each({unknown, unknown}), (std::vector{2, 2}));
}

TEST(CoresOfRanks, AreKnownOnLinux) {
#if defined(__linux__)
  EXPECT_TRUE(cores_of_process().any());
#endif
  EXPECT_GE(cores_for_threads(), 1);
}

}  // namespace
}  // namespace cayspin::simulation::test
