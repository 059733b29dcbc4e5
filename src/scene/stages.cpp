// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "io/stages.hpp"

#include "io/relax.hpp"
#include "sections.hpp"
#include "stage_tables.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>
#include <utility>

namespace cayspin::inline v0_2::io {
namespace detail {
namespace {

// Tables whose keys a stage may change, except `fixed`. In [output], it may change only
// `of_output`.
constexpr std::string_view changeable[] = {"material", "system",     "field", "torque",
                                           "thermal",  "integrator", "output"};
constexpr std::string_view fixed[] = {"system.kind", "system.inertia", "material.Ms",
                                      "material.mu_s"};
constexpr std::string_view of_output[] = {"output.every", "output.scalars_every"};

constexpr std::string_view accepted_relax =
    "true, or a table { torque, evaluations, keep_saddles }";

bool is_among(std::string_view key, std::span<std::string_view const> keys) {
  return std::ranges::find(keys, key) != keys.end();
}

/// Refuses a key that must be constant during a run. `key`: "table" or "table.key" of the scene.
void require_changeable(std::string const& key, std::string const& place,
                        std::string const& prefix = {}) {
  auto const table = std::string_view(key).substr(0, key.find('.'));
  bool const is_of_output = table == "output" && key != table;
  if (is_among(table, changeable) && !is_among(key, fixed) &&
      (!is_of_output || is_among(key, of_output)))
    return;
  constexpr std::string_view known[] = {"units", "lattice", "initial"};
  bool const is_known = is_among(table, known) || is_among(table, changeable);
  fail(place, prefix + key,
       is_known ? std::string("cannot change during a run") : std::string("unknown key"),
       is_of_output     ? fmt::format("{}", fmt::join(of_output, ", "))
       : prefix.empty() ? fmt::format("keys of {}", fmt::join(changeable, ", "))
                        : fmt::format("name, relax, and keys of {}", fmt::join(changeable, ", ")));
}

void put(toml::table& table, std::string_view key, toml::node&& value) {
  std::move(value).visit([&](auto&& typed) { table.insert_or_assign(key, std::move(typed)); });
}

// Sets the keys of `from` in `to`. A value or an inline table replaces the previous one; any other
// table, such as one made by dotted keys, is merged into it.
void merge(toml::table& to, toml::table&& from) {
  for (auto&& [key, value] : from) {
    auto* const before = to.get_as<toml::table>(key.str());
    auto* const now = value.as_table();
    if (before != nullptr && now != nullptr && !now->is_inline())
      merge(*before, std::move(*now));
    else
      put(to, key.str(), std::move(value));
  }
}

// If the stage has a key `method`, no previous key is kept; and `end` and `steps` replace each
// other.
void merge_integrator(toml::table& to, toml::table&& from) {
  if (from.contains("method")) to.clear();
  if (from.contains("end")) to.erase("steps");
  if (from.contains("steps")) to.erase("end");
  merge(to, std::move(from));
}

}  // namespace

void apply_stage(toml::table& document, toml::table& stage, std::string const& prefix,
                 std::string const& path) {
  std::vector<std::string> applied;
  for (auto&& [name, value] : stage) {
    std::string const key(name.str());
    bool const is_of_stages = key == "name" || key == "relax";
    if (is_of_stages && !prefix.empty()) continue;
    auto const place = place_of(value.source(), path);
    require_changeable(key, place, prefix);
    auto* const table = value.as_table();
    if (table == nullptr) fail(place, prefix + key, "is no table", "a table of the scene's keys");
    for (auto const& [inner, one] : *table)
      require_changeable(fmt::format("{}.{}", key, inner.str()), place_of(one.source(), place),
                         prefix);
    auto* const before = document.get_as<toml::table>(key);
    if (before == nullptr)
      put(document, key, std::move(value));
    else if (key == "integrator")
      merge_integrator(*before, std::move(*table));
    else
      merge(*before, std::move(*table));
    document.get_as<toml::table>(key)->is_inline(false);
    applied.push_back(key);
  }
  for (auto const& key : applied) stage.erase(key);
}

std::size_t count_stages(toml::table const& document, std::string const& path) {
  auto const* const node = document.get("stage");
  if (node == nullptr) return 0;
  auto const* const array = node->as_array();
  bool const are_tables =
      array != nullptr && std::ranges::all_of(*array, [](auto& one) { return one.is_table(); });
  if (!are_tables)
    fail(place_of(node->source(), path), "stage", "is no list of tables", "[[stage]]");
  return array->size();
}

toml::table apply_stages(toml::table& document, std::size_t count, std::string const& path) {
  auto* const node = document.get("stage");
  if (node == nullptr) return {};
  auto stages = std::move(*node->as_array());
  document.erase("stage");
  toml::table last;
  for (std::size_t n = 0; n < count; ++n) {
    auto& stage = *stages[n].as_table();
    auto const prefix = fmt::format("stage[{}].", n);
    auto const place = place_of(stage.source(), path);
    if (stage.contains("relax") && stage.contains("integrator"))
      fail(place_of(stage.get("integrator")->source(), place), prefix + "integrator",
           "stands in a stage that relaxes, which takes no steps", "a stage of its own");
    apply_stage(document, stage, prefix, place);
    if (n + 1 == count) last = std::move(stage);
  }
  return last;
}

void read_stage(Table const& table, Stage& stage) {
  if (auto const item = table.find("name")) stage.name = one_line(string(*item, "a string"));
  auto const relax = table.find("relax");
  if (!relax) return;
  if (relax->node->is_table()) {
    Table const settings(*relax, table.scene());
    settings.accept_only(names_of_keys<StageRelax>());
    read_keys(settings, stage.relax.emplace());
    return;
  }
  if (!relax->node->is_boolean()) relax->wrong_type(accepted_relax);
  if (!boolean(*relax)) relax->fail("is false", accepted_relax);
  stage.relax.emplace();
}

void check_stage(Scene const& own, Scene const& stage) {
  if (!stage.field.applied_in_turn.empty())
    refuse(stage, "field.applied", "a list of fields is for cayspin relax",
           "three numbers or expressions in t");
  if (stage.integrator.method->automatic)
    refuse(stage, "integrator.method", "\"auto\" does not go with stages",
           "the method and dt or tolerance that `cayspin advise` names for a stage");
  auto const &a = own.lattice, &b = stage.lattice;
  if (a.shape != b.shape || a.cell != b.cell || a.basis != b.basis)
    refuse(stage, "field.couplings", "its file has a different cell from that of the stage before",
           "a file with the same cell");
}

}  // namespace detail

std::vector<Stage> stages_of(Scene const& scene) {
  std::vector<Stage> stages(1);
  stages[0].scene = scene;
  stages[0].scene.stages.clear();
  if (!has_integrator(scene)) stages[0].scene.thermal.reset();  // without motion there is no noise
  stages.insert(stages.end(), scene.stages.begin(), scene.stages.end());
  put_begins(stages, 0);
  return stages;
}

StageBegin begin_after(Scene const& stage, std::int64_t step, Scene const& next) {
  auto const& begin = stage.begin;
  double time = begin.time + static_cast<double>(step - begin.step) * stage.integrator.dt;
  // Units of time depend on the damping, which a stage may change.
  if (stage.units.time != next.units.time) time *= stage.units.time / next.units.time;
  return {begin.stage + 1, step, time};
}

std::int64_t end_of(Stage const& stage) {
  return stage.scene.begin.step + (stage.relax ? 0 : stage.scene.integrator.steps);
}

void put_begins(std::vector<Stage>& stages, std::size_t first) {
  for (std::size_t n = first + 1; n < stages.size(); ++n)
    stages[n].scene.begin =
        begin_after(stages[n - 1].scene, end_of(stages[n - 1]), stages[n].scene);
}

std::string stage_text(Stage const& stage) {
  auto const number = fmt::format("stage {}", stage.scene.begin.stage);
  return stage.name.empty() ? number : fmt::format("{} ({})", number, stage.name);
}

void require_no_stages(Scene const& scene, std::string_view who) {
  if (!scene.stages.empty())
    detail::refuse(scene, "stage", fmt::format("{} takes no run in stages", who),
                   "a scene without [[stage]]");
}

}  // namespace cayspin::inline v0_2::io
