// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/colour_site.hpp>
#include <cayspin/detail/for_each_site.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>

// Loops over the sites of one colour of a checkerboard: those where x + y + z has one parity. The
// functor changes them in place and reads their neighbours, which all have the other colour.
//
// From neighbour rows, a pack on the host also loads the sites between those that it needs. No
// other task may write to them at the same time. Therefore rows with even y + z run first, then
// rows with odd y + z: no task then writes to the neighbour rows of another. In its own row a pack
// loads no sites that other packs write.
namespace cayspin::inline v0_2::detail {

/// Rows with one parity of y + z, or all rows.
enum class RowsOf : std::int32_t { even = 0, odd = 1, both = 2 };

template <class Value, bool AtEdge>
using PackOfColour =
    std::conditional_t<lanes_of<Value> == 1, Site<Value>, ColourSite<Value, AtEdge>>;

/// True if the functor accepts two sites. Two independent sites keep the processor busy when the
/// work on each is a long chain of dependent operations.
template <class Functor>
inline constexpr bool takes_pairs = requires { requires Functor::takes_pairs; };

/// Host loop. A functor that accepts pairs is called with two packs, possibly in different rows. A
/// single leftover pack is passed twice.
template <class Real, class Functor>
struct ColourRowLoop {
  Functor functor;
  RowLayout layout;
  RowBlocks blocks;
  RowsOf rows = RowsOf::both;

  CAYSPIN_DETAIL_NOINLINE void operator()(std::int64_t task) const {
    constexpr std::int32_t at_once = takes_pairs<Functor> ? 2 : 1;
    Functor local = functor;
    auto const block = blocks(task);
    std::int32_t const last = (layout.nx + pack_sites - 1) / pack_sites - 1;
    std::int32_t const inner_end = Kokkos::min(block.pack_end, last);
    Waiting waiting;
    for (std::int32_t y = block.y_begin; y < block.y_end; ++y) {
      if (rows != RowsOf::both && ((y + block.z) & 1) != static_cast<std::int32_t>(rows)) continue;
      Row const row(layout, y, block.z);
      std::int32_t const plane = layout.plane_of_replica(block.z);
      std::int32_t const x = (y + plane + layout.parity + functor.colour) & 1;
      std::int32_t pack = Kokkos::max<std::int32_t>(block.pack_begin, 1);
      for (; pack + at_once <= inner_end; pack += at_once) {
        Inner const site(row, x + pack * pack_sites);
        if constexpr (at_once == 2)
          local(site, Inner(row, x + (pack + 1) * pack_sites));
        else
          local(site);
      }
      // Handles the ends of the row, and an inner pack without a partner.
      bool const ends_block = at_once == 2 && y + (rows == RowsOf::both ? 1 : 2) >= block.y_end;
      waiting.add(row, block.pack_begin == 0 ? x : layout.nx);
      waiting.add(row, pack < inner_end ? x + pack * pack_sites : layout.nx);
      waiting.add(row, last > 0 && last < block.pack_end ? x + last * pack_sites : layout.nx);
      while (waiting.count >= at_once || (ends_block && waiting.count > 0)) waiting.serve(local);
    }
  }

 private:
  using Value = Pack<Real>;
  using Inner = PackOfColour<Value, false>;
  using Edge = PackOfColour<Value, true>;
  static constexpr std::int32_t pack_sites = 2 * lanes_of<Value>;

  /// Packs that the inner loop does not handle. They wait for a partner if the functor takes pairs.
  /// All are served by one instance of the kernel, because kernels are large and slow to compile.
  struct Waiting {
    struct Place {
      Row row;
      std::int32_t x;
    };
    std::optional<Place> places[4];
    int count = 0;

    void add(Row const& row, std::int32_t x) {
      if (x < row.nx) places[count++] = Place{row, x};
    }
    CAYSPIN_DETAIL_NOINLINE void serve(Functor const& kernel) {
      Place const first = *places[--count];
      if constexpr (takes_pairs<Functor>) {
        Place const second = count > 0 ? *places[--count] : first;
        kernel(Edge(first.row, first.x), Edge(second.row, second.x));
      } else {
        kernel(Edge(first.row, first.x));
      }
    }
  };
};

template <class Real, class Functor>
ColourRowLoop<Real, Functor> colour_row_loop(Functor const& functor, RowLayout const& layout) {
  return {functor, layout, RowBlocks(layout, (pack_count<Real>(layout) + 1) / 2, layout.own)};
}

/// Device loop body for every other site of each row.
template <class Real, class Functor>
struct OnDeviceSiteOfColour {
  Functor functor;
  std::int32_t parity;  // RowLayout::parity

  template <class Index>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(DeviceLayout<Index> const& layout, std::int32_t half,
                                              std::int32_t y, std::int32_t z) const {
    std::int32_t const plane = layout.plane_of_replica(z);
    std::int32_t const x = 2 * half + ((y + plane + parity + functor.colour) & 1);
    if (x <= layout.last[0]) functor(DeviceSite<Real, Index>(layout, x, y, z));
  }
};

/// Calls functor(site) for the sites of one colour, without ghosts: x + y + z has the parity
/// functor.colour, where y and z are those in the whole lattice, or in a replica. On hosts it calls
/// functor(first, second) if the functor takes pairs.
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
    for_each_tile(exec, label, layout, DeviceTiles((layout.nx + 1) / 2, layout.own),
                  OnDeviceSiteOfColour<Real, Functor>{functor, layout.parity});
  }
}

}  // namespace cayspin::inline v0_2::detail
