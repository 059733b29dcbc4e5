// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/backend.hpp>
#include <cayspin/lattice.hpp>
#include <cayspin/part.hpp>

#include <Kokkos_Core.hpp>

#include <cstddef>
#include <cstdint>

namespace cayspin::inline v0_2 {

/// Rows y_begin .. y_end - 1 of planes z_begin .. z_end - 1.
struct RowRange {
  std::int32_t y_begin = 0, y_end = 0, z_begin = 0, z_end = 0;

  KOKKOS_FUNCTION std::int32_t ny() const { return y_end - y_begin; }
  KOKKOS_FUNCTION std::int32_t nz() const { return z_end - z_begin; }
  KOKKOS_FUNCTION std::int64_t count() const { return std::int64_t(ny()) * nz(); }
};

/// Memory layout of the sites: one array per component, with rows along x padded to whole cache
/// lines. If rows are longer than a line, the strides of rows, planes and components are odd
/// numbers of lines, and a stride of planes of a page or more is not close to a whole number of
/// pages. This keeps neighbours from competing for the same cache sets.
struct RowLayout {
  std::int32_t nx = 0, ny = 0, nz = 0;
  std::int32_t replica_planes = 0;  // planes of one replica
  bool periodic[3] = {false, false, false};
  std::ptrdiff_t pitch = 0;             // stride of rows
  std::ptrdiff_t plane = 0;             // stride of planes
  std::ptrdiff_t component_stride = 0;  // stride of components
  std::ptrdiff_t origin = 0;  // position of site 0 in the allocation; a pack may read before it
  RowRange own;               // all rows but the ghosts
  Part const* part = nullptr;
  std::int32_t parity = 0;  // of y + z in the whole lattice, for rows with an even y + z here

  template <class Real>
  static RowLayout of(Lattice const& lattice) {
    constexpr std::ptrdiff_t line =
        detail::cache_line_bytes / static_cast<std::ptrdiff_t>(sizeof(Real));
    auto const odd_lines = [](std::ptrdiff_t count) {
      std::ptrdiff_t const lines = (count + line - 1) / line;
      return (lines % 2 == 0 ? lines + 1 : lines) * line;
    };
    RowLayout layout;
    layout.nx = static_cast<std::int32_t>(lattice.shape[0]);
    layout.ny = static_cast<std::int32_t>(lattice.shape[1]);
    layout.replica_planes = static_cast<std::int32_t>(lattice.shape[2]);
    layout.nz = static_cast<std::int32_t>(lattice.shape[2] * lattice.replicas);
    for (std::size_t axis = 0; axis < 3; ++axis)
      layout.periodic[axis] = lattice.boundary[axis] == Boundary::periodic;
    if (layout.nx == 1) layout.periodic[0] = false;  // no neighbours
    layout.own = {
        static_cast<std::int32_t>(lattice.ghosts[1].before),
        static_cast<std::int32_t>(layout.ny - lattice.ghosts[1].after),
        static_cast<std::int32_t>(lattice.ghosts[2].before),
        static_cast<std::int32_t>(layout.nz - lattice.ghosts[2].after),
    };
    layout.part = lattice.part;
    if (lattice.part != nullptr) {
      auto const begin = lattice.part->begin();
      layout.parity = static_cast<std::int32_t>((begin[1] + begin[2]) & 1);
    }
    std::ptrdiff_t const rows = std::ptrdiff_t(layout.ny) * layout.nz;
    layout.pitch =
        rows > 1 && layout.nx > line ? odd_lines(layout.nx) : (layout.nx + line - 1) / line * line;
    layout.plane = layout.ny * layout.pitch;
    if (layout.nz > 1 && layout.nx > line)
      layout.plane = line * lines_of_plane(layout.plane / line);
    layout.component_stride = odd_lines(layout.nz * layout.plane);
    layout.origin = line;
    return layout;
  }

  /// Returns the stride of planes in cache lines: at least `least`, odd, and, from a page on, at
  /// least a sixth of a page away from whole pages.
  static std::ptrdiff_t lines_of_plane(std::ptrdiff_t least) {
    constexpr std::ptrdiff_t page = detail::page_bytes / detail::cache_line_bytes,
                             sixth = page / 6 | 1;
    std::ptrdiff_t const lines = least | 1, past = lines % page;
    if (lines < page || (past >= sixth && past <= page - sixth)) return lines;
    return lines + sixth - past + (past < sixth ? 0 : page);
  }

  RowRange all() const { return {0, ny, 0, nz}; }
  /// Returns the part's own rows, with up to `more` ghost rows and ghost planes on each side.
  RowRange own_and(std::int32_t more) const {
    auto const low = [&](std::int32_t own_begin) {
      return own_begin > more ? own_begin - more : 0;
    };
    auto const high = [&](std::int32_t own_end, std::int32_t extent) {
      return extent - own_end > more ? own_end + more : extent;
    };
    return {low(own.y_begin), high(own.y_end, ny), low(own.z_begin), high(own.z_end, nz)};
  }

  KOKKOS_FUNCTION bool has_replicas() const { return replica_planes != nz; }
  /// Returns the number of a plane within its replica.
  KOKKOS_FUNCTION std::int32_t plane_of_replica(std::int32_t z) const {
    return has_replicas() ? z % replica_planes : z;
  }
  KOKKOS_FUNCTION std::int64_t rows() const { return std::int64_t(ny) * nz; }
  KOKKOS_FUNCTION std::int64_t sites() const { return rows() * nx; }
  std::size_t allocation(int components) const {
    return static_cast<std::size_t>(2 * origin + components * component_stride);
  }
  /// Returns the offset of the site with the number `site` = ix + nx * (iy + ny * iz), where the
  /// indices and ny leave out the ghosts.
  KOKKOS_FUNCTION std::ptrdiff_t offset(std::int64_t site) const {
    std::int64_t row = site / nx;
    if (part != nullptr) row = (own.z_begin + row / own.ny()) * ny + own.y_begin + row % own.ny();
    return row_offset(row) + site % nx;
  }
  KOKKOS_FUNCTION std::ptrdiff_t row_offset(std::int64_t y, std::int64_t z) const {
    return z * plane + y * pitch;
  }
  KOKKOS_FUNCTION std::ptrdiff_t row_offset(std::int64_t row) const {
    return row_offset(row % ny, row / ny);
  }
};

/// A field as kernels and field terms hold it; terms read it with stencil.site().load(array).
/// Component c of the site for which RowLayout::offset returns `offset` is data[c * stride +
/// offset].
template <class Real, int Components>
struct SiteArray {
  using value_type = Real;
  static constexpr int components = Components;
  Real* data = nullptr;
  std::ptrdiff_t stride = 0;
};

/// A SiteArray that a kernel only writes. `streaming`: if true, stores bypass the caches, for
/// fields that do not fit into them.
template <class Real, int Components>
struct OutputArray : SiteArray<Real, Components> {
  bool streaming = false;
};

}  // namespace cayspin::inline v0_2
