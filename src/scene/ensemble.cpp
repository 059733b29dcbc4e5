// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "io/ensemble.hpp"

#include "io/key_path.hpp"
#include "io/relax.hpp"
#include "sections.hpp"

#include <cayspin/units.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <set>
#include <type_traits>
#include <utility>
#include <variant>

namespace cayspin::inline v0_2::io {
namespace detail {
namespace {

constexpr std::int64_t most_replicas = 1'000'000;
constexpr std::string_view accepted_values =
    "as many numbers as replicas, or { from = number, to = number }";

// Prefixes of the keys that may differ between replicas.
constexpr std::array varied_tables{"field.", "torque.", "material.", "thermal.temperature",
                                   "system.damping"};
// Exceptions: the moments, because units and the lattice depend on them, and the form of damping.
constexpr std::array fixed_keys{"material.Ms", "material.mu_s", "material.damping_form"};

bool may_vary(std::string_view key) {
  auto const begins = [&](std::string_view table) { return key.starts_with(table); };
  return std::ranges::any_of(varied_tables, begins) && std::ranges::none_of(fixed_keys, begins);
}

// Returns true for a path that lacks its quotes, as in vary.field.applied.2 = [..]: TOML makes
// tables of it.
bool is_table_of_keys(toml::node const& node) {
  auto const* const table = node.as_table();
  return table != nullptr && std::ranges::any_of(*table, [](auto const& entry) {
           return entry.second.is_table() || entry.second.is_array();
         });
}

std::vector<double> read_values(Item const& item, Scene& scene, std::int64_t replicas) {
  std::vector<double> values;
  if (item.node->is_table()) {
    Table const table(item, scene);
    table.accept_only({"from", "to"});
    double const from = number(table.required("from", "a number")),
                 to = number(table.required("to", "a number"));
    for (std::int64_t replica = 0; replica < replicas; ++replica) {
      double const share =
          replicas > 1 ? static_cast<double>(replica) / static_cast<double>(replicas - 1) : 0;
      values.push_back((1 - share) * from + share * to);
    }
    return values;
  }
  auto const count = static_cast<std::size_t>(replicas);
  for (auto const& entry : entries(item, count, count, accepted_values))
    values.push_back(number(entry));
  return values;
}

std::vector<std::string> overrides_of(Scene const& scene, std::int64_t replica) {
  std::vector<std::string> overrides{"ensemble={}"};
  for (auto const& [key, values] : scene.ensemble.vary)
    overrides.push_back(fmt::format("{}={}", key, values[static_cast<std::size_t>(replica)]));
  bool const adds_noise = std::ranges::any_of(
      scene.ensemble.vary, [](auto const& entry) { return entry.key.starts_with("thermal."); });
  if (scene.thermal || adds_noise) {
    auto const seed = scene.thermal ? scene.thermal->seed : 0;
    overrides.push_back(fmt::format("thermal.seed={}", seed + replica));
  }
  if (auto const* const random = std::get_if<RandomStart>(&scene.initial))
    overrides.push_back(fmt::format("initial.random.seed={}", random->seed + replica));
  return overrides;
}

// Returns the scene of a replica. `parse`: parse_scene or parse_scene_to_relax. Errors are reported
// for the key ensemble.vary, because the scene has no errors without the varied values.
template <class Parse>
Scene parsed_replica(Scene const& scene, std::int64_t replica, Parse const& parse) {
  auto const& text = scene.ensemble.text_of_replicas;
  try {
    auto parsed = parse(text.empty() ? scene.text : text, scene.path, overrides_of(scene, replica),
                        scene.given);
    parsed.places = scene.places;
    parsed.field.own = scene.field.own;
    return parsed;
  } catch (SceneError const& error) {
    std::string_view const what = error.what();
    throw scene_error(scene, "ensemble.vary",
                      fmt::format("in replica {}: {}", replica, what.substr(what.find(": ") + 2)));
  }
}

// Refuses keys that do not go with an ensemble, most of them because the file of an ensemble has no
// place for their results.
void refuse_options(Scene const& scene) {
  constexpr std::string_view what = "does not go with an ensemble", accepted = "no such key";
  if (!scene.stages.empty()) refuse(scene, "stage", what, accepted);
  if (has_integrator(scene) && scene.integrator.method->automatic)
    refuse(scene, "integrator.method", "\"auto\" does not go with an ensemble",
           "the method and dt or tolerance that `cayspin advise` names for a replica");
  if (!scene.field.applied_in_turn.empty())
    refuse(scene, "field.applied", "a list of fields does not go with an ensemble",
           "three numbers or expressions in t");
  if (scene.lattice.follow) refuse(scene, "lattice.follow", what, accepted);
  auto const& output = scene.output;
  for (auto const& [key, is_set] : {std::pair{"output.regions", output.regions},
                                    {"output.terms", output.terms},
                                    {"output.xdmf", output.xdmf},
                                    {"output.table", output.table},
                                    {"output.sync", output.sync},
                                    {"output.chunk", output.chunk > 0}})
    if (is_set) refuse(scene, key, what, accepted);
}

// Returns the first and the last replica, and those with the least and the largest value of each
// varied key. Most limits of a key are bounds, so other values are then in order, too.
std::set<std::int64_t> replicas_to_check(Ensemble const& ensemble) {
  std::set<std::int64_t> replicas{0, ensemble.replicas - 1};
  for (auto const& [key, values] : ensemble.vary) {
    auto const [least, largest] = std::ranges::minmax_element(values);
    replicas.insert({least - values.begin(), largest - values.begin()});
  }
  return replicas;
}

// Returns the component of field.applied that a key names, if it names one.
std::optional<std::size_t> component_of_applied(std::string_view key) {
  constexpr std::array keys{"field.applied.0", "field.applied.1", "field.applied.2"};
  auto const found = std::ranges::find(keys, key);
  if (found == keys.end()) return std::nullopt;
  return static_cast<std::size_t>(found - keys.begin());
}

// Returns which uniaxial anisotropy has its constant from a key, if one has.
std::optional<std::size_t> term_of_constant(std::string_view key, Scene const& one) {
  auto const& terms = one.field.anisotropies;
  if (!one.field.crystal_anisotropies.empty()) return std::nullopt;
  if (one.units.si) {
    auto const& material = *one.material;
    if (!material.anisotropy || key != (material.atomistic ? "material.K" : "material.Ku"))
      return std::nullopt;
    // Without such a J, K may be the unit of energy.
    bool const has_unit = material.exchange.value_or(0) != 0 && !material.exchange_factors.there();
    return !material.atomistic || has_unit ? std::optional<std::size_t>(0) : std::nullopt;
  }
  if (key == "field.anisotropy.constant" && terms.size() == 1) return 0;
  for (std::size_t term = 0; term < terms.size(); ++term)
    if (key == fmt::format("field.anisotropy.{}.constant", term)) return term;
  return std::nullopt;
}

// Returns the constant of the anisotropy of [material] in reduced units.
double reduced_anisotropy(Scene const& one, double typed) {
  auto const& material = *one.material;
  if (material.atomistic) return 2 * typed / one.units.energy;
  return units::Micromagnetic({.Ms = material.moment, .cell = {1, 1, 1}}).anisotropy(typed);
}

// Puts the values of a varied key into `columns`, with the arithmetic of read_scene. Returns false
// for a key without a place there.
bool put_values(VariedKey const& varied, Scene const& one, std::int64_t first, Columns& columns) {
  auto const value = [&](std::size_t column) {
    // A replica's text has -0 as a whole number, which is 0.
    return varied.values[static_cast<std::size_t>(first) + column] + 0.0;
  };
  auto const& units = one.units;
  auto const component = component_of_applied(varied.key);
  auto const term = term_of_constant(varied.key, one);
  for (std::size_t column = 0; column < columns.applied.size(); ++column) {
    if (varied.key == "thermal.temperature")
      columns.temperatures[column] =
          units.si ? units::boltzmann * value(column) / units.energy : value(column);
    else if (component)
      columns.applied[column][*component] = value(column) / units.field;
    else if (term)
      columns.constants[column][*term] =
          units.si ? reduced_anisotropy(one, value(column)) : value(column);
    else if (varied.key == (units.si ? "material.alpha" : "system.damping"))
      columns.dampings[column] = value(column);
    else
      return false;
  }
  return true;
}

// The seeds of replicas count up from the scene's seed, and must not overflow.
void require_seeds(Scene const& scene) {
  auto const most = std::numeric_limits<std::int64_t>::max() - (scene.ensemble.replicas - 1);
  auto const require = [&](std::string_view key, std::int64_t seed) {
    if (seed > most)
      refuse(scene, key,
             fmt::format("{} is too large for {} replicas", seed, scene.ensemble.replicas),
             fmt::format("a whole number from 0 to {}", most));
  };
  if (scene.thermal) require("thermal.seed", scene.thermal->seed);
  if (auto const* const random = std::get_if<RandomStart>(&scene.initial))
    require("initial.random.seed", random->seed);
}

}  // namespace

Ensemble read_ensemble(Table const& root) {
  Ensemble ensemble;
  auto const found = root.find("ensemble");
  if (!found) return ensemble;
  Table const table(*found, root.scene());
  if (found->node->as_table()->empty()) return ensemble;
  table.accept_only({"replicas", "vary"});
  Limits const limits{"a whole number from 1 to 1000000", 1, static_cast<double>(most_replicas)};
  ensemble.replicas = integer(table.required("replicas", limits.accepted), limits);
  auto const vary = table.find("vary");
  if (!vary) return ensemble;
  if (!vary->node->is_table()) vary->wrong_type("a table of \"key.path\" = values");
  Table const keys(*vary, root.scene());
  for (auto const& [name, node] : *vary->node->as_table()) {
    std::string const key(name.str());
    auto const item = *keys.find(key);
    if (is_table_of_keys(node))
      item.fail("is a table of other keys",
                "the whole path of a key in quotes, as in vary.\"field.applied.2\" = [..]");
    auto const path = plain_path(key);
    if (!may_vary(path))
      item.fail("must be the same in all replicas",
                "a number of [field], [torque] or [material], thermal.temperature, "
                "system.damping");
    if (std::ranges::any_of(ensemble.vary, [&](auto const& one) { return one.key == path; }))
      item.fail(fmt::format("is the key {}, which varies already", path), "each key once");
    ensemble.vary.push_back({path, read_values(item, root.scene(), ensemble.replicas)});
  }
  return ensemble;
}

void check_ensemble(Scene const& scene, bool relaxes) {
  refuse_options(scene);
  require_seeds(scene);
  for (auto const replica : replicas_to_check(scene.ensemble))
    relaxes ? replica_to_relax(scene, replica) : replica_of(scene, replica);
}

}  // namespace detail

Scene replica_of(Scene const& scene, std::int64_t replica) {
  return detail::parsed_replica(scene, replica, parse_scene);
}

Scene replica_to_relax(Scene const& scene, std::int64_t replica) {
  return detail::parsed_replica(scene, replica, parse_scene_to_relax);
}

std::optional<Columns> values_of_replicas(Scene const& scene, Scene const& one, std::int64_t first,
                                          std::int64_t count) {
  auto const size = static_cast<std::size_t>(count);
  auto const varies = [&](auto const& is_key) {
    return std::ranges::any_of(scene.ensemble.vary,
                               [&](VariedKey const& varied) { return is_key(varied.key); });
  };
  bool const temperatures = varies([](auto const& key) { return key == "thermal.temperature"; });
  bool const applied =
      varies([](auto const& key) { return detail::component_of_applied(key).has_value(); });
  bool const constants =
      varies([&](auto const& key) { return detail::term_of_constant(key, one).has_value(); });
  bool const dampings =
      varies([](auto const& key) { return key == "system.damping" || key == "material.alpha"; });
  bool const varies_heat = temperatures || (dampings && one.thermal);
  // In Gilbert's form, the unit of time depends on the damping.
  if (dampings && one.material && one.material->gilbert) return std::nullopt;
  // The noise multiplies by such a factor between temperature and damping.
  if (dampings && one.thermal && std::holds_alternative<std::string>(one.thermal->in_time))
    return std::nullopt;
  Triple field{};
  for (std::size_t c = 0; applied && c < 3; ++c) {
    if (!one.field.applied) return std::nullopt;
    auto const* const number = std::get_if<double>(&(*one.field.applied)[c]);
    if (number == nullptr) return std::nullopt;
    field[c] = *number;
  }
  std::vector<double> of_one;
  for (auto const& term : one.field.anisotropies) of_one.push_back(term.constant);
  Columns columns{std::vector(size, one.thermal ? one.thermal->temperature : 0),
                  std::vector(size, one.system.damping), std::vector(size, field),
                  std::vector(constants ? size : 0, of_one)};
  for (auto const& varied : scene.ensemble.vary)
    if (!detail::put_values(varied, one, first, columns)) return std::nullopt;
  for (std::size_t column = 0; column < size; ++column) {
    auto const& [x, y, z] = columns.applied[column];
    double const temperature = columns.temperatures[column], damping = columns.dampings[column];
    if (!std::isfinite(x + y + z) || !(damping >= 0) || !std::isfinite(damping) ||
        !(temperature >= 0) || !std::isfinite(temperature) || (temperature > 0 && damping == 0))
      return std::nullopt;
    // As in require_moderate_noise.
    if (varies_heat && damping * temperature * one.integrator.dt > 1) return std::nullopt;
  }
  auto const are_finite = [](auto const& numbers) {
    return std::ranges::all_of(numbers, [](double number) { return std::isfinite(number); });
  };
  if (!std::ranges::all_of(columns.constants, are_finite)) return std::nullopt;
  if (!varies_heat) columns.temperatures.clear();
  if (!dampings) columns.dampings.clear();
  if (!applied) columns.applied.clear();
  return columns;
}

Columns Columns::part(std::int64_t first, std::int64_t count) const {
  auto const part_of = [&](auto const& all) {
    if (all.empty()) return all;
    auto const begin = all.begin() + first;
    return std::remove_cvref_t<decltype(all)>(begin, begin + count);
  };
  return {part_of(temperatures), part_of(dampings), part_of(applied), part_of(constants)};
}

void Columns::put_constants(std::size_t column, Field& field) const {
  for (std::size_t term = 0; term < field.anisotropies.size(); ++term)
    field.anisotropies[term].constant = constants[column][term];
}

void Columns::put(std::size_t column, Scene& scene) const {
  if (!temperatures.empty()) scene.thermal->temperature = temperatures[column];
  if (!dampings.empty()) scene.system.damping = dampings[column];
  for (std::size_t c = 0; c < 3 && !applied.empty(); ++c)
    (*scene.field.applied)[c] = applied[column][c];
  if (!constants.empty()) put_constants(column, scene.field);
}

std::vector<double> Columns::heats() const {
  auto heats = temperatures;
  if (!dampings.empty())
    std::ranges::transform(dampings, heats, heats.begin(), std::multiplies<>());
  return heats;
}

void require_no_ensemble(Scene const& scene, std::string_view who) {
  if (scene.ensemble.there())
    detail::refuse(
        scene, "ensemble", fmt::format("{} takes no ensemble", who),
        "a scene without [ensemble], or cayspin run, cayspin relax or Python's EnsembleSimulation");
}

}  // namespace cayspin::inline v0_2::io
