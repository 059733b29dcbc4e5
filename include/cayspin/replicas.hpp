// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/execution.hpp>
#include <cayspin/spin_field.hpp>

#include <concepts>
#include <cstdint>
#include <stdexcept>
#include <string>

// Fields on Lattice::with_replicas: many independent copies of a small lattice, which a stepper
// advances together. Site s of replica r is number r * (sites of one replica) + s among all sites.
namespace cayspin::inline v0_2 {

namespace detail {

/// Functor that copies the sites of one replica between the field of all replicas and a field of
/// this replica only.
template <class Real, int Components, bool ToReplica>
struct CopyReplica {
  SiteArray<Real, Components> of_all, of_one;
  RowLayout all, one;
  std::int64_t first;  // number of the replica's site 0 among all sites

  KOKKOS_FUNCTION void operator()(std::int64_t site) const {
    std::ptrdiff_t const in_all = all.offset(first + site), in_one = one.offset(site);
    for (int c = 0; c < Components; ++c) {
      Real& here = of_all.data[c * of_all.stride + in_all];
      Real& there = of_one.data[c * of_one.stride + in_one];
      (ToReplica ? here : there) = ToReplica ? there : here;
    }
  }
};

template <bool ToReplica, class Exec, class Real, int Components, class MemorySpace>
void copy_between(Exec const& exec, SiteField<Real, Components, MemorySpace> const& of_all,
                  std::int64_t replica, SiteField<Real, Components, MemorySpace> const& of_one) {
  check_access<Exec, MemorySpace>();
  auto const& lattice = of_all.lattice();
  require_sites("cayspin::copy_replica", of_all.sites());
  require_lattice("cayspin::copy_replica's field of one replica", of_one.lattice(),
                  lattice.with_replicas(1));
  if (replica < 0 || replica >= lattice.replicas)
    throw std::invalid_argument("cayspin::copy_replica: there is no replica " +
                                std::to_string(replica) + "; accepted: 0 .. " +
                                std::to_string(lattice.replicas - 1));
  Kokkos::parallel_for(
      "cayspin::copy_replica",
      Kokkos::RangePolicy<Exec, Kokkos::IndexType<std::int64_t>>(exec, 0, of_one.sites()),
      CopyReplica<Real, Components, ToReplica>{of_all.array(), of_one.array(), of_all.layout(),
                                               of_one.layout(), replica * of_one.sites()});
}

}  // namespace detail

/// Copies one replica of a field into a field on the lattice of one replica. Does not wait. Throws
/// std::invalid_argument when `to` is on another lattice, and when there is no such replica.
template <class Exec, std::floating_point Real, int Components, class MemorySpace>
void copy_replica(Exec const& exec, SiteField<Real, Components, MemorySpace> const& from,
                  std::int64_t replica, SiteField<Real, Components, MemorySpace> const& to) {
  detail::copy_between<false>(exec, from, replica, to);
}

/// Copies a field on the lattice of one replica into one of the replicas of a field. Does not wait.
/// Throws like copy_replica.
template <class Exec, std::floating_point Real, int Components, class MemorySpace>
void copy_to_replica(Exec const& exec, SiteField<Real, Components, MemorySpace> const& from,
                     SiteField<Real, Components, MemorySpace> const& to, std::int64_t replica) {
  detail::copy_between<true>(exec, to, replica, from);
}

}  // namespace cayspin::inline v0_2
