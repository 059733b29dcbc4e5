// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Treats the zero vectors of a file as sites without a spin.
#include "io/notes.hpp"
#include "io/ovf.hpp"
#include "sections.hpp"
#include "start_file.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <cstdint>
#include <sstream>

namespace cayspin::inline v0_2::io {
namespace {

/// Returns the number of sites that have a zero vector in the file.
std::int64_t count_zeros(FileStart const& start, Lattice const& lattice) {
  auto const& [nx, ny, nz] = lattice.shape;
  constexpr std::int64_t sites_at_once = 4'000'000;
  auto const at_once =
      is_ovf(start.path) ? nz : std::clamp(sites_at_once / (nx * ny), std::int64_t{1}, nz);
  std::int64_t zeros = 0;
  for (std::int64_t plane = 0; plane < nz; plane += at_once) {
    SiteBox const box{{0, 0, plane}, {nx, ny, std::min(at_once, nz - plane)}};
    auto const there = detail::sites_with_spins(start.path, lattice, box);
    zeros += std::ranges::count(there, 0.0);
  }
  return zeros;
}

}  // namespace

Scene with_shape_of_start(Scene scene) {
  auto const* const start = std::get_if<FileStart>(&scene.initial);
  if (start == nullptr || scene.lattice.occupied.there() || scene.system.kind != SystemKind::llg)
    return scene;
  auto const zeros =
      detail::for_key(scene, "initial.file", [&] { return count_zeros(*start, scene.lattice); });
  if (zeros == 0 || zeros == sites(scene)) return scene;
  // The text must have the key, too, because trajectory files store the text.
  auto document = toml::parse(scene.text, scene.path.string());
  auto const typed = document["initial"]["file"].value_or(std::string());
  document["lattice"].as_table()->insert("occupied", toml::table{{"file", typed}});
  std::ostringstream stream;
  stream << document << '\n';
  scene.text = stream.str();
  scene.lattice.occupied.file = start->path;
  scene.places["lattice.occupied"] = scene.places["initial.file"];
  if (scene.places.contains("integrator")) check_combination(scene);
  for (auto& stage : scene.stages) stage.scene = with_shape_of_start(std::move(stage.scene));
  return scene;
}

}  // namespace cayspin::inline v0_2::io
