// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "hdf5/handle.hpp"
#include "io/units.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace cayspin::inline v0_2::io {

inline constexpr int format_version = 1;
inline constexpr char const* single_precision = "single";
inline constexpr char const* double_precision = "double";
/// Largest chunk. HDF5 itself allows 4 GiB, but may take a whole chunk into memory to read or write
/// a part of it.
inline constexpr std::uint64_t most_chunk_bytes = 256 << 20;
inline constexpr std::uint64_t file_page_bytes = 4096;
inline constexpr int most_pending = 512;  // most samples written at once
inline constexpr char const* reduced_units = "reduced";
inline constexpr char const* si_units = "SI";

struct UnitAttribute {
  char const* name;
  double Units::*member;
};
inline constexpr UnitAttribute unit_attributes[] = {{"time_unit", &Units::time},
                                                    {"length_unit", &Units::length},
                                                    {"field_unit", &Units::field},
                                                    {"energy_unit", &Units::energy}};

/// Largest number of chunks for which each block of HDF5's chunk index fits into a page. With more
/// chunks, a block has 512 elements of 8 bytes and a header, and a kill can leave it half written.
inline constexpr std::int64_t most_chunks = 8180;

/// Returns the number of frames in a chunk. `bytes`: size of one frame's part of the chunk.
/// `chunks`: number of chunks if each held one frame. A chunk holds more than one frame in two
/// cases: if `chunks` is above `most_chunks`, then up to about `most_chunk_bytes`; and if the empty
/// end of its last page would be more than a sixteenth of its pages. (Chunks start on pages of the
/// file.)
inline std::int64_t frames_of_chunk(std::uint64_t bytes, std::int64_t chunks) {
  auto const empty_bytes = [&](std::uint64_t frames) {
    return (file_page_bytes - frames * bytes % file_page_bytes) % file_page_bytes;
  };
  auto const needed = static_cast<std::uint64_t>((chunks + most_chunks - 1) / most_chunks);
  auto const fits = std::max<std::uint64_t>(1, most_chunk_bytes / bytes);
  auto frames = std::clamp<std::uint64_t>(needed, 1, fits);
  while (16 * empty_bytes(frames) > frames * bytes + empty_bytes(frames)) ++frames;
  return static_cast<std::int64_t>(frames);
}

/// Returns the extents (1, z, y, x, 3) of the part of a frame that a chunk of /spins holds, for a
/// lattice (nx, ny, nz). A frame of more than `limit` bytes is cut along z into equal parts, the
/// last of which may be smaller. A plane of more than `limit` bytes is also cut along y, and a row
/// along x. `planes`: the most along z; 0 for no bound.
inline std::array<hsize_t, 5> frame_chunk(std::array<std::int64_t, 3> const& shape,
                                          std::uint64_t bytes_per_component,
                                          std::int64_t planes = 0,
                                          std::uint64_t limit = most_chunk_bytes) {
  std::array<hsize_t, 5> chunk{1, 1, 1, 1, 3};
  std::uint64_t inner = 3 * bytes_per_component;
  for (int axis = 0; axis < 3; ++axis) {
    auto const extent = static_cast<std::uint64_t>(shape[axis]);
    auto const fits = limit / inner;
    auto const pieces = fits >= extent ? 1 : fits == 0 ? extent : (extent + fits - 1) / fits;
    chunk[3 - axis] = (extent + pieces - 1) / pieces;
    inner *= extent;
  }
  if (planes > 0) chunk[1] = std::min(chunk[1], static_cast<hsize_t>(planes));
  return chunk;
}

}  // namespace cayspin::inline v0_2::io
