// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/colour_site.hpp>
#include <cayspin/detail/for_each_site.hpp>

#include <cstdint>
#include <string>

// Loops over the sites of one colour of a checkerboard, those with x + y + z of a parity. The
// functor changes these in place and reads their neighbours, which are all of the other colour.
//
// A host pack loads what lies between its sites in their rows and in the neighbour rows, too. That
// no task writes any of it meanwhile, rows of even and of odd y + z go one after the other: then
// none writes to neighbour rows, and in a row all writes are to the sites of the packs themselves.
namespace cayspin::detail {

/// Rows whose y + z has a parity, or all.
enum class RowsOf : std::int32_t { even = 0, odd = 1, both = 2 };

/// Calls functor(site) for packs begin .. end - 1 of a row, each of which takes 2 lanes of it.
template <class Value, class Functor>
KOKKOS_FORCEINLINE_FUNCTION void for_each_pack_of_colour(Row const& row, std::int32_t first_x,
                                                         std::int32_t begin, std::int32_t end,
                                                         Functor& functor) {
  constexpr std::int32_t sites = 2 * lanes_of<Value>;
  std::int32_t const last = (row.nx + sites - 1) / sites - 1;
  if constexpr (lanes_of<Value> == 1) {
    for (std::int32_t pack = begin; pack < end; ++pack)
      if (first_x + pack * sites < row.nx) functor(Site<Value, true>(row, first_x + pack * sites));
  } else {
    // The ends of the row share one instance of the functor.
#if defined(__GNUC__) && !defined(__clang__) && !defined(__CUDACC__)
#pragma GCC unroll 1
#endif
    for (std::int32_t pack = 0; pack <= last; pack += Kokkos::max<std::int32_t>(last, 1))
      if (begin <= pack && pack < end && first_x + pack * sites < row.nx)
        functor(ColourSite<Value, true>(row, first_x + pack * sites));
    std::int32_t const inner_end = Kokkos::min(end, last);
    for (std::int32_t pack = Kokkos::max<std::int32_t>(begin, 1); pack < inner_end; ++pack)
      functor(ColourSite<Value, false>(row, first_x + pack * sites));
  }
}

/// The host loop.
template <class Real, class Functor>
struct ColourRowLoop {
  Functor functor;
  RowLayout layout;
  RowBlocks blocks;
  RowsOf rows = RowsOf::both;

  CAYSPIN_DETAIL_NOINLINE void operator()(std::int64_t task) const {
    Functor local = functor;
    auto const block = blocks(task);
    for (std::int32_t y = block.y_begin; y < block.y_end; ++y)
      if (rows == RowsOf::both || ((y + block.z) & 1) == static_cast<std::int32_t>(rows))
        for_each_pack_of_colour<Pack<Real>>(Row(layout, y, block.z),
                                            (y + block.z + functor.colour) & 1, block.pack_begin,
                                            block.pack_end, local);
  }
};

template <class Real, class Functor>
ColourRowLoop<Real, Functor> colour_row_loop(Functor const& functor, RowLayout const& layout) {
  return {functor, layout, RowBlocks(layout, (pack_count<Real>(layout) + 1) / 2)};
}

/// The device loop: a thread for each site of the colour.
template <class Real, class Functor>
struct ColourSiteLoop {
  Functor functor;
  RowLayout layout;

  KOKKOS_FUNCTION void operator()(std::int64_t index) const {
    std::int64_t const half = (layout.nx + 1) / 2;
    Row const row(layout, index / half);
    auto const x =
        static_cast<std::int32_t>(2 * (index % half)) + ((row.y + row.z + functor.colour) & 1);
    if (x < layout.nx) functor(Site<Real, true>(row, x));
  }
};

/// Calls functor(site) for the sites with x + y + z of the parity functor.colour.
template <class Real, class Exec, class Functor>
void for_each_site_of_colour(Exec const& exec, std::string const& label, RowLayout const& layout,
                             Functor const& functor) {
  if constexpr (is_host_execution<Exec>) {
    auto loop = colour_row_loop<Real>(functor, layout);
    bool const alone = layout.rows() == 1 || runs_on_calling_thread<Exec>(layout.sites());
    for (RowsOf const rows : {RowsOf::even, RowsOf::odd}) {
      if (!alone) loop.rows = rows;
      for_each_task(exec, label, loop.blocks.count(), layout.sites(), loop);
      if (alone) break;
    }
  } else {
    using Policy = Kokkos::RangePolicy<Exec, Kokkos::IndexType<std::int64_t>>;
    std::int64_t const half = (layout.nx + 1) / 2;
    Kokkos::parallel_for(label, Policy(exec, 0, layout.rows() * half),
                         ColourSiteLoop<Real, Functor>{functor, layout});
  }
}

}  // namespace cayspin::detail
