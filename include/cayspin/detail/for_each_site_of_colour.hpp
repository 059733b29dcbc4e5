// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/for_each_site.hpp>

#include <cstdint>
#include <string>

// Loops over the sites of one colour of a checkerboard, those with x + y + z of a parity. The
// functor changes these in place and reads their neighbours, which are all of the other colour.
//
// A host pack holds sites of both colours, loads whole packs and writes the lanes of its colour
// alone. Other tasks write sites of this colour meanwhile; so that none of them is loaded, rows of
// even and of odd y + z go one after the other: what is loaded from a row's neighbours, none
// writes. Where one row is shared among tasks, the number beside a task's first or last pack may be
// of this colour; it falls into a lane of the other colour, of which nothing is kept.
namespace cayspin::detail {

/// Rows whose y + z has a parity, or all.
enum class RowsOf : std::int32_t { even = 0, odd = 1, both = 2 };

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
        for_each_pack<Pack<Real>>(Row(layout, y, block.z), block.pack_begin, block.pack_end, local);
  }
};

template <class Real, class Functor>
ColourRowLoop<Real, Functor> colour_row_loop(Functor const& functor, RowLayout const& layout) {
  return {functor, layout, RowBlocks(layout, pack_count<Real>(layout))};
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

/// Calls functor(site) for the sites with x + y + z of the parity functor.colour; on hosts for
/// packs that hold others too.
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
