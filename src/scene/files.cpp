// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "files.hpp"

#include <cayspin/io/scene.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace cayspin::io {
namespace detail {

void check_spins(Hdf5Dataset const& spins, std::array<std::int64_t, 3> const& shape) {
  std::vector<hsize_t> const frame = {static_cast<hsize_t>(shape[2]),
                                      static_cast<hsize_t>(shape[1]),
                                      static_cast<hsize_t>(shape[0]), 3};
  auto const& extents = spins.extents();
  bool const framed = extents.size() == 5;
  bool const fits =
      (framed || extents.size() == 4) && std::equal(frame.begin(), frame.end(), extents.end() - 4);
  if (!fits) {
    auto const inner = fmt::format("{}, {}, {}, 3)", shape[2], shape[1], shape[0]);
    throw std::runtime_error(
        fmt::format("dataset /spins has the shape {}; accepted: ({} or (frame, {}", spins.shape(),
                    inner, inner));
  }
  if (framed && extents[0] == 0) throw std::runtime_error("dataset /spins has no frame");
}

void check_inertia(Hdf5Dataset const& inertia, std::int64_t count) {
  std::vector<hsize_t> const expected = {static_cast<hsize_t>(count), 3, 3};
  if (inertia.extents() == expected) return;
  throw std::runtime_error(fmt::format("dataset /inertia has the shape {}; accepted: ({}, 3, 3)",
                                       inertia.shape(), count));
}

}  // namespace detail

void check_files(Scene const& scene) {
  if (auto const* const start = std::get_if<FileStart>(&scene.initial)) {
    try {
      detail::check_spins(detail::Hdf5Dataset(start->path, "/spins"), scene.lattice.shape);
    } catch (std::runtime_error const& error) {
      throw scene_error(scene, "initial.file", error.what());
    }
  }
  auto const* const file = std::get_if<InertiaFile>(&scene.system.inertia);
  if (scene.system.kind == SystemKind::rigid_body && file != nullptr) {
    try {
      detail::check_inertia(detail::Hdf5Dataset(file->path, "/inertia"), sites(scene));
    } catch (std::runtime_error const& error) {
      throw scene_error(scene, "system.inertia.file", error.what());
    }
  }
}

}  // namespace cayspin::io
