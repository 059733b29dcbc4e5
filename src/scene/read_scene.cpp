// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "free_boundary.hpp"
#include "io/relax.hpp"
#include "sections.hpp"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <fstream>
#include <sstream>
#include <system_error>
#include <tuple>
#include <utility>

namespace cayspin::inline v0_1::io {
namespace {

std::string read_text(std::filesystem::path const& path) {
  constexpr std::string_view accepted = "a readable TOML file";
  constexpr std::size_t largest = std::size_t{16} << 20U;
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    detail::fail(path.string(), "", "is a folder", accepted);
  }
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  std::string text;
  for (std::array<char, 4096> piece; text.size() <= largest && stream;) {
    stream.read(piece.data(), piece.size());
    text.append(piece.data(), static_cast<std::size_t>(stream.gcount()));
  }
  if (!stream.is_open() || stream.bad()) {
    auto const reason = errno == 0 ? std::string("cannot be read")
                                   : "cannot be read: " + std::generic_category().message(errno);
    detail::fail(path.string(), "", reason, accepted);
  }
  if (text.size() > largest) detail::fail(path.string(), "", "is larger than 16 MiB", accepted);
  return text;
}

toml::table parse(std::string const& text, std::filesystem::path const& path) {
  try {
    return toml::parse(text, path.string());
  } catch (toml::parse_error const& error) {
    auto const place = fmt::format("{}:{}", path.string(), error.source().begin.line);
    detail::fail(place, "", fmt::format("not TOML: {}", error.description()), "TOML 1.0");
  }
}

enum class Purpose { run, relax, any };

// For a scene to relax, [integrator] is read where it is there.
Integrator read_integrator_for(Purpose purpose, detail::Table const& root, SystemKind kind) {
  bool const is_for_bodies = purpose == Purpose::any && kind != SystemKind::llg;
  if (purpose == Purpose::run || is_for_bodies || root.contains("integrator"))
    return detail::read_integrator(root, kind);
  Integrator none;
  none.method = methods().front();
  none.dt = 1;
  return none;
}

void check_purpose(Purpose purpose, Scene const& scene) {
  if (purpose == Purpose::any) purpose = is_to_relax(scene) ? Purpose::relax : Purpose::run;
  if (purpose == Purpose::run) {
    if (!scene.field.applied_in_turn.empty())
      detail::refuse(scene, "field.applied", "a list of fields is for cayspin relax",
                     "three numbers or expressions in t");
    return;
  }
  if (scene.system.kind != SystemKind::llg)
    detail::refuse(scene, "system.kind", "rigid bodies have no state of rest", "\"llg\"");
  if (has_torque(scene.field))
    detail::refuse(scene, "torque",
                   "moves spins for ever, and a state of rest needs an energy that falls",
                   "no such table");
  if (depends_on_time(scene.field))
    detail::refuse(scene, "field.applied", "depends on t, and a state of rest does not", "numbers");
}

// Where the cell is that of a unit-cell file, its sites go into the text: who reads that again need
// not have the file.
bool write_cell(toml::table& document, Scene const& scene) {
  auto const& [lattice, places] = std::tie(scene.lattice, scene.places);
  if (scene.field.couplings_file.empty() || places.contains("lattice.crystal") ||
      places.contains("lattice.cell") || places.contains("lattice.basis"))
    return false;
  auto const array_of = [](auto const& vectors) {
    toml::array all;
    for (auto const& [x, y, z] : vectors) all.push_back(toml::array{x, y, z});
    return all;
  };
  auto& table = *document["lattice"].as_table();
  table.insert("cell", array_of(lattice.cell));
  table.insert("basis", array_of(lattice.basis));
  return true;
}

Scene parse_scene_for(Purpose purpose, std::string text, std::filesystem::path const& path,
                      std::vector<std::string> const& overrides, Given given) {
  Scene scene;
  scene.path = path;
  scene.given = std::move(given);
  scene.text = std::move(text);
  auto document = parse(scene.text, path);
  for (auto const& assignment : overrides) detail::apply_override(document, assignment);

  detail::Table const root({&document, "", fmt::format("{}:1", path.string())}, scene);
  root.accept_only({"units", "material", "system", "lattice", "field", "torque", "initial",
                    "integrator", "thermal", "output"});
  scene.units.si = detail::read_is_si(root);
  scene.system = detail::read_system(root);
  scene.lattice = detail::read_lattice(root, scene.system.kind);
  detail::read_occupied(root, scene);
  if (scene.units.si) detail::read_material(root, scene);
  detail::read_dampings(root, scene);
  scene.field = detail::read_field(root, scene.system.kind);
  scene.field.torque = detail::read_torque(root, scene.system.kind);
  scene.initial = detail::read_initial(root);
  scene.integrator = read_integrator_for(purpose, root, scene.system.kind);
  scene.thermal = detail::read_thermal(root, scene.system.kind);
  scene.output = detail::read_output(root, scene.integrator.steps);
  if (scene.units.si) {
    detail::check_si(scene);
    detail::convert_to_reduced(scene);
  }
  if (detail::has_free_boundary(root)) detail::add_free_boundaries(scene);
  if (write_cell(document, scene) || !overrides.empty()) {
    std::ostringstream stream;
    stream << document << '\n';
    scene.text = stream.str();
  }
  detail::check_crystal(scene);
  if (purpose == Purpose::run || has_integrator(scene)) check_combination(scene);
  check_purpose(purpose, scene);
  return scene;
}

}  // namespace

Scene parse_scene(std::string text, std::filesystem::path const& path,
                  std::vector<std::string> const& overrides, Given given) {
  return parse_scene_for(Purpose::run, std::move(text), path, overrides, std::move(given));
}

Scene read_scene_to_relax(std::filesystem::path const& path,
                          std::vector<std::string> const& overrides) {
  return parse_scene_for(Purpose::relax, read_text(path), path, overrides, {});
}

Scene parse_scene_to_run_or_relax(std::string text, std::filesystem::path const& name,
                                  std::vector<std::string> const& overrides, Given given) {
  return parse_scene_for(Purpose::any, std::move(text), name, overrides, std::move(given));
}

Scene read_scene_to_run_or_relax(std::filesystem::path const& path,
                                 std::vector<std::string> const& overrides, Given given) {
  return parse_scene_to_run_or_relax(read_text(path), path, overrides, std::move(given));
}

bool has_integrator(Scene const& scene) { return scene.places.contains("integrator"); }

bool is_to_relax(Scene const& scene) {
  return !has_integrator(scene) || !scene.field.applied_in_turn.empty();
}

std::vector<Field> fields_in_turn(Scene const& scene) {
  if (scene.field.applied_in_turn.empty()) return {scene.field};
  std::vector<Field> fields;
  for (auto const& [x, y, z] : scene.field.applied_in_turn) {
    fields.push_back(scene.field);
    fields.back().applied = {x, y, z};
  }
  return fields;
}

Scene read_scene(std::filesystem::path const& path, std::vector<std::string> const& overrides,
                 Given given) {
  return parse_scene(read_text(path), path, overrides, std::move(given));
}

Scene with_overrides(Scene const& scene, std::vector<std::string> const& overrides) {
  auto changed = parse_scene(scene.text, scene.path, overrides, scene.given);
  changed.places = scene.places;
  changed.field.own = scene.field.own;
  return changed;
}

std::string as_override(std::string const& scene_text, std::string const& name) {
  auto const document = parse(scene_text, "a scene");
  std::ostringstream stream;
  stream << name << '=';
  if (auto const* const table = document[name].as_table()) {
    auto in_line = *table;
    in_line.is_inline(true);
    stream << in_line;
  } else {
    stream << "{}";
  }
  return stream.str();
}

SceneError scene_error(Scene const& scene, std::string_view key, std::string_view message) {
  for (auto known = key;; known = known.substr(0, known.find_last_of(".["))) {
    auto const found = scene.places.find(known);
    if (found != scene.places.end()) {
      return SceneError(detail::one_line(fmt::format("{}: {}: {}", found->second, key, message)));
    }
    if (known.find_last_of(".[") == known.npos) break;
  }
  return SceneError(
      detail::one_line(fmt::format("{}:1: {}: {}", scene.path.string(), key, message)));
}

void detail::refuse(Scene const& scene, std::string_view key, std::string_view wrong,
                    std::string_view accepted) {
  throw scene_error(scene, key, fmt::format("{}; accepted: {}", wrong, accepted));
}

std::int64_t sites(Scene const& scene) {
  auto const& shape = scene.lattice.shape;
  return shape[0] * shape[1] * shape[2];
}

}  // namespace cayspin::inline v0_1::io
