// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/execution.hpp>
#include <cayspin/detail/site.hpp>

#include <algorithm>
#include <string>

namespace cayspin::detail {

/// Host tasks are rows, or pieces of rows this many sites long, so that one long row is shared too.
inline constexpr std::int32_t sites_per_task = 4096;

inline std::int32_t tasks_per_row(RowLayout const& layout) {
  return std::max<std::int32_t>(1, layout.nx / sites_per_task);
}

/// Calls functor(site) for all sites of one task, a pack at a time.
template <class Value, class Functor>
KOKKOS_FORCEINLINE_FUNCTION void for_each_pack(RowLayout const& layout, std::int64_t task,
                                               std::int32_t per_row, Functor& functor) {
  constexpr std::int32_t lanes = lanes_of<Value>;
  Row const row(layout, task / per_row);
  std::int32_t const packs = (layout.nx + lanes - 1) / lanes;
  auto const part = static_cast<std::int32_t>(task % per_row);
  auto const begin = static_cast<std::int32_t>(std::int64_t(packs) * part / per_row);
  auto const end = static_cast<std::int32_t>(std::int64_t(packs) * (part + 1) / per_row);
  // The ends of the row share one instance of the functor: kernels are large, and compile slowly.
  std::int32_t const last = packs - 1;
#if defined(__GNUC__) && !defined(__clang__) && !defined(__CUDACC__)
#pragma GCC unroll 1
#endif
  for (std::int32_t pack = 0; pack <= last; pack += Kokkos::max<std::int32_t>(last, 1))
    if (begin <= pack && pack < end) functor(Site<Value, true>(row, pack * lanes));
  for (std::int32_t pack = Kokkos::max<std::int32_t>(begin, 1); pack < Kokkos::min(end, last);
       ++pack)
    functor(Site<Value, false>(row, pack * lanes));
}

#if defined(__GNUC__)
#define CAYSPIN_DETAIL_NOINLINE [[gnu::noinline]]
#else
#define CAYSPIN_DETAIL_NOINLINE
#endif

/// The host loop. One compiled body serves all host spaces, so their results have the same bits.
template <class Real, class Functor>
struct RowLoop {
  Functor functor;
  RowLayout layout;
  std::int32_t per_row;

  CAYSPIN_DETAIL_NOINLINE void operator()(std::int64_t task) const {
    Functor local = functor;
    for_each_pack<Pack<Real>>(layout, task, per_row, local);
    streaming_fence();
  }
};

/// The device loop.
template <class Real, class Functor>
struct SiteLoop {
  Functor functor;
  RowLayout layout;

  KOKKOS_FUNCTION void operator()(std::int64_t site) const {
    Row const row(layout, site / layout.nx);
    functor(Site<Real, true>(row, static_cast<std::int32_t>(site % layout.nx)));
  }
};

/// Calls functor(site) for all sites of a lattice; functor is a plain struct whose call operator is
/// templated on the Site. The one parallel loop of the steppers.
template <class Real, class Exec, class Functor>
void for_each_site(Exec const& exec, std::string const& label, RowLayout const& layout,
                   Functor const& functor) {
  if constexpr (is_host_execution<Exec>) {
    std::int32_t const per_row = tasks_per_row(layout);
    for_each_task(exec, label, layout.rows() * per_row, layout.sites(),
                  RowLoop<Real, Functor>{functor, layout, per_row});
  } else {
    using Policy = Kokkos::RangePolicy<Exec, Kokkos::IndexType<std::int64_t>>;
    Kokkos::parallel_for(label, Policy(exec, 0, layout.sites()),
                         SiteLoop<Real, Functor>{functor, layout});
  }
}

}  // namespace cayspin::detail
