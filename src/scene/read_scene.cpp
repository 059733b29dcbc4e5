// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "free_boundary.hpp"
#include "io/relax.hpp"
#include "io/stages.hpp"
#include "sections.hpp"
#include "stage_tables.hpp"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <fstream>
#include <sstream>
#include <system_error>
#include <tuple>
#include <utility>

namespace cayspin::inline v0_2::io {
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

// The purpose for which tables are read:
// - any: to run or to relax, whichever the scene is for;
// - start: the scene's own tables, if stages follow and [integrator] is missing;
// - rest: a stage that relaxes.
enum class Purpose { run, relax, any, start, rest };

// Reads [integrator]. It may be missing unless the purpose is `run`, or `any` for rigid bodies.
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
    detail::refuse(scene, "system.kind", "rigid bodies have no equilibrium", "\"llg\"");
  if (purpose == Purpose::start) return;  // this stage neither takes steps nor relaxes
  // `cayspin modes` accepts torques. relax and path, which read scenes for the same purpose, refuse
  // torques later.
  if (has_torque(scene.field) && purpose != Purpose::relax)
    detail::refuse(scene, "torque",
                   "moves spins for ever, and an equilibrium needs an energy that falls",
                   "no such table");
  if (depends_on_time(scene.field) && purpose != Purpose::rest)
    detail::refuse(scene, key_in_time(scene.field), "depends on t, and an equilibrium does not",
                   "numbers");
}

// Writes the cell of a unit-cell file into the document, so that the scene's text gives the lattice
// without that file. Returns true if it did.
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

std::string text_of(toml::table const& document) {
  std::ostringstream stream;
  stream << document << '\n';
  return stream.str();
}

// Returns the comments in a text that say which keys are functions of the program; the one about
// field.applied only if `with_applied`.
std::string notes_of_functions(std::string const& text, bool with_applied) {
  std::istringstream lines(text);
  std::string notes;
  for (std::string line; std::getline(lines, line);) {
    bool const is_note =
        line.starts_with("# field.") && line.ends_with(": a function of the program");
    if (is_note && (with_applied || !line.starts_with("# field.applied:"))) notes += line + '\n';
  }
  return notes;
}

// Reads the tables of a document without stages. `place`: for messages about missing tables.
void read_tables(Purpose purpose, toml::table& document, std::string const& place, Scene& scene) {
  detail::Table const root({&document, "", place}, scene);
  root.accept_only({"units", "material", "system", "lattice", "field", "torque", "initial",
                    "integrator", "thermal", "output", "stage", "ensemble"});
  scene.units.si = detail::read_is_si(root);
  scene.system = detail::read_system(root);
  scene.lattice = detail::read_lattice(root, scene.system.kind);
  detail::read_occupied(root, scene);
  detail::read_follow(root, scene);
  if (scene.units.si) detail::read_material(root, scene);
  detail::read_dampings(root, scene);
  scene.field = detail::read_field(root, scene.system.kind);
  scene.field.torque = detail::read_torque(root, scene.system.kind);
  scene.initial = detail::read_initial(root);
  scene.integrator = read_integrator_for(purpose, root, scene.system.kind);
  scene.thermal = detail::read_thermal(root, scene.system.kind);
  scene.output = detail::read_output(root, scene.integrator);
  scene.ensemble = detail::read_ensemble(root);
  if (scene.units.si) {
    detail::check_si(scene);
    detail::convert_to_reduced(scene);
  }
  detail::use_numbers_of_sites(scene);
  detail::check_in_time(root);
  if (detail::has_free_boundary(root)) detail::add_free_boundaries(scene);
  detail::check_crystal(scene);
  if (purpose == Purpose::run || has_integrator(scene)) check_combination(scene);
  check_purpose(purpose, scene);
}

Scene parse_scene_for(Purpose purpose, std::string text, std::filesystem::path const& path,
                      std::vector<std::string> const& overrides, Given given) {
  auto const parsed = [&] {
    auto document = parse(text, path);
    for (auto const& assignment : overrides) detail::apply_override(document, assignment);
    auto const* const ensemble = document.get_as<toml::table>("ensemble");
    if (ensemble && ensemble->empty()) document.erase("ensemble");
    return document;
  };
  auto const first_line = fmt::format("{}:1", path.string());
  Scene scene;
  scene.path = path;
  scene.given = given;
  auto document = parsed();
  auto const count = detail::count_stages(document, first_line);
  if (count > 0)
    scene.places["stage"] = detail::place_of(document.get("stage")->source(), first_line);
  auto typed = count > 0 ? document : toml::table();
  detail::apply_stages(document, 0, first_line);
  bool const is_start = count > 0 && !document.contains("integrator");
  read_tables(is_start ? Purpose::start : purpose, document, first_line, scene);
  bool const has_cell = write_cell(document, scene);
  if (count > 0) write_cell(typed, scene);
  scene.text = has_cell || !overrides.empty() ? text_of(count > 0 ? typed : document) : text;
  for (std::size_t n = 1; n <= count; ++n) {
    Stage stage;
    stage.scene.path = path;
    stage.scene.given = given;
    auto with_stages = parsed();
    auto own = detail::apply_stages(with_stages, n, first_line);
    auto const place = detail::place_of(own.source(), first_line);
    detail::read_stage({{&own, fmt::format("stage[{}]", n - 1), place}, scene}, stage);
    read_tables(stage.relax ? Purpose::rest : Purpose::run, with_stages, place, stage.scene);
    if (stage.relax) stage.scene.integrator.steps = 0;
    write_cell(with_stages, stage.scene);
    stage.scene.text = text_of(with_stages);
    detail::check_stage(scene, stage.scene);
    scene.stages.push_back(std::move(stage));
  }
  if (count > 0) detail::check_stage(scene, scene);
  if (purpose == Purpose::relax) require_no_stages(scene, "cayspin relax, modes or path");
  if (scene.ensemble.there()) {
    detail::check_ensemble(scene, !has_integrator(scene));
    document.erase("ensemble");
    scene.ensemble.text_of_replicas = text_of(document);
  }
  return scene;
}

}  // namespace

Scene parse_scene(std::string text, std::filesystem::path const& path,
                  std::vector<std::string> const& overrides, Given given) {
  return parse_scene_for(Purpose::run, std::move(text), path, overrides, std::move(given));
}

Scene read_scene_to_relax(std::filesystem::path const& path,
                          std::vector<std::string> const& overrides) {
  return parse_scene_to_relax(read_text(path), path, overrides);
}

Scene parse_scene_to_relax(std::string text, std::filesystem::path const& name,
                           std::vector<std::string> const& overrides, Given given) {
  return parse_scene_for(Purpose::relax, std::move(text), name, overrides, std::move(given));
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
  return scene.stages.empty() && (!has_integrator(scene) || !scene.field.applied_in_turn.empty());
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

Scene changed_on_the_way(Scene const& scene, std::vector<std::string> const& overrides,
                         Given const& given) {
  toml::table changes;
  for (auto const& assignment : overrides) detail::apply_override(changes, assignment);
  auto document = parse(scene.text, scene.path);
  auto const first_line = fmt::format("{}:1", scene.path.string());
  detail::apply_stage(document, changes, {}, first_line);
  Scene changed;
  changed.path = scene.path;
  changed.given = scene.given;
  for (auto const& [key, numbers] : given.numbers) changed.given.numbers[key] = numbers;
  read_tables(Purpose::any, document, first_line, changed);
  write_cell(document, changed);
  changed.text = text_of(document) + notes_of_functions(scene.text, !changed.field.applied);
  detail::check_stage(scene, changed);
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

}  // namespace cayspin::inline v0_2::io
