// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Teams of the device of host_device.hpp. Between two barriers, the threads of a team run one after
// another, so that kernels in which a barrier is missing fail in the same way each time.
#pragma once

#include "host_device.hpp"

#include <Kokkos_ExecPolicy.hpp>

#include <cstddef>
#include <functional>
#include <span>

namespace cayspin::test {

/// A thread of a team, as a kernel sees it.
class HostDeviceTeam {
 public:
  using execution_space = HostDevice;

  HostDeviceTeam(int league_rank, int league_size, int rank, int size, std::span<char> scratch,
                 std::function<void()> const& barrier)
      : league_rank_(league_rank),
        league_size_(league_size),
        rank_(rank),
        size_(size),
        scratch_(scratch),
        barrier_(barrier) {}

  int league_rank() const { return league_rank_; }
  int league_size() const { return league_size_; }
  int team_rank() const { return rank_; }
  int team_size() const { return size_; }
  void team_barrier() const { barrier_(); }
  Kokkos::ScratchMemorySpace<HostDevice> team_scratch(int) const {
    return {scratch_.data(), static_cast<int>(scratch_.size()), nullptr, 0};
  }

 private:
  int league_rank_, league_size_, rank_, size_;
  std::span<char> scratch_;
  std::function<void()> const& barrier_;
};

/// Calls body(thread) for all threads of all teams. Ends the program if threads of a team meet
/// different numbers of barriers.
void run_teams(int league_size, int team_size, std::size_t scratch_bytes,
               std::function<void(HostDeviceTeam const&)> const& body);

}  // namespace cayspin::test

namespace Kokkos::Impl {

template <class... Properties>
class TeamPolicyInternal<cayspin::test::HostDevice, Properties...>
    : public PolicyTraits<Properties...> {
 public:
  using execution_policy = TeamPolicyInternal;
  using traits = PolicyTraits<Properties...>;
  using member_type = cayspin::test::HostDeviceTeam;

  TeamPolicyInternal(cayspin::test::HostDevice const& space, int league_size, int team_size,
                     int = 1)
      : space_(space), league_size_(league_size), team_size_(team_size) {}

  cayspin::test::HostDevice const& space() const { return space_; }
  int league_size() const { return league_size_; }
  int team_size() const { return team_size_; }
  bool impl_auto_team_size() const { return false; }
  bool impl_auto_vector_length() const { return false; }
  /// Large teams take long here, so that only those that share scratch memory may be large.
  template <class Functor>
  int team_size_max(Functor const&, ParallelForTag const&) const {
    return scratch_bytes_ > 0 ? 512 : 3;
  }
  static int scratch_size_max(int) { return 40000; }  // as Kokkos' for CUDA
  std::size_t scratch_size(int) const { return scratch_bytes_; }
  TeamPolicyInternal& set_scratch_size(int, PerTeamValue const& bytes) {
    scratch_bytes_ = bytes.value;
    return *this;
  }

 private:
  cayspin::test::HostDevice space_;
  int league_size_, team_size_;
  std::size_t scratch_bytes_ = 0;
};

template <class Functor, class... Properties>
class ParallelFor<Functor, TeamPolicy<Properties...>, cayspin::test::HostDevice> {
 public:
  using Policy = TeamPolicy<Properties...>;
  ParallelFor(Functor const& functor, Policy const& policy) : functor_(functor), policy_(policy) {}

  void execute() const {
    policy_.space().enqueue([functor = functor_, teams = policy_.league_size(),
                             threads = policy_.team_size(), bytes = policy_.scratch_size(0)] {
      cayspin::test::run_teams(
          teams, threads, bytes,
          [&](cayspin::test::HostDeviceTeam const& thread) { functor(thread); });
    });
  }

 private:
  Functor const functor_;
  Policy const policy_;
};

}  // namespace Kokkos::Impl
