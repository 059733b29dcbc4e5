// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "files.hpp"

#include "trajectory/stored_spins.hpp"

#include <cayspin/io/scene.hpp>

#include <fmt/format.h>

#include <stdexcept>

namespace cayspin::io {

RealDataset detail::open_inertia(std::filesystem::path const& path, std::int64_t count) {
  RealDataset inertia(path, "/inertia");
  if (inertia.extents() != Extents{static_cast<hsize_t>(count), 3, 3})
    inertia.refuse_extents(fmt::format("({}, 3, 3)", count));
  return inertia;
}

void check_files(Scene const& scene) {
  if (auto const* const start = std::get_if<FileStart>(&scene.initial)) {
    try {
      StoredSpins(start->path, scene.lattice.shape);
    } catch (std::runtime_error const& error) {
      throw scene_error(scene, "initial.file", error.what());
    }
  }
  auto const* const file = std::get_if<InertiaFile>(&scene.system.inertia);
  if (scene.system.kind == SystemKind::rigid_body && file != nullptr) {
    try {
      detail::open_inertia(file->path, sites(scene));
    } catch (std::runtime_error const& error) {
      throw scene_error(scene, "system.inertia.file", error.what());
    }
  }
}

}  // namespace cayspin::io
