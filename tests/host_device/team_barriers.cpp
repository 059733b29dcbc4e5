// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Teams on the emulated device. Each thread of each team runs once, and not before the fence. After
// a barrier, every thread sees what the others wrote before it; without a barrier, some do not.
#include "../support/backends.hpp"

using namespace cayspin::test;

namespace {

constexpr int teams = 5, threads = 3;
using Numbers = Kokkos::View<int**, Kokkos::LayoutLeft, HostDeviceMemory>;

struct PassOn {
  Numbers before, after;
  bool waits;
  template <class Team>
  KOKKOS_FUNCTION void operator()(Team const& team) const {
    int const rank = team.team_rank(), next = (rank + 1) % team.team_size();
    before(team.league_rank(), rank) += 10 * team.league_size() + rank;
    if (waits) team.team_barrier();
    after(team.league_rank(), rank) += before(team.league_rank(), next);
  }
};

int wrong_numbers(bool waits) {
  Numbers const before("before", teams, threads), after("after", teams, threads);
  auto const here = Kokkos::create_mirror_view(after);
  HostDevice const exec;
  Kokkos::parallel_for("cayspin::test::pass_on",
                       Kokkos::TeamPolicy<HostDevice>(exec, teams, threads),
                       PassOn{before, after, waits});
  Kokkos::deep_copy(exec, here, after);
  EXPECT_EQ(here(0, 0), 0) << "before the fence";
  exec.fence();
  int wrong = 0;
  for (int team = 0; team < teams; ++team)
    for (int rank = 0; rank < threads; ++rank)
      wrong += here(team, rank) != 10 * teams + (rank + 1) % threads;
  return wrong;
}

TEST(Teams, WaitAtBarriers) { EXPECT_EQ(wrong_numbers(true), 0); }
// The last thread of a team sees what the first one wrote.
TEST(Teams, DoNotWaitWithoutABarrier) { EXPECT_EQ(wrong_numbers(false), teams * (threads - 1)); }

struct EndsEarly {
  template <class Team>
  KOKKOS_FUNCTION void operator()(Team const& team) const {
    if (team.team_rank() > 0) team.team_barrier();
  }
};

TEST(TeamsDeathTest, MeetTheSameBarriers) {
  EXPECT_DEATH(
      {
        HostDevice const exec;
        Kokkos::parallel_for("cayspin::test::ends_early",
                             Kokkos::TeamPolicy<HostDevice>(exec, 1, threads), EndsEarly());
        exec.fence();
      },
      "ends before a barrier of the others");
}

}  // namespace
