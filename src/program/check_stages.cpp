// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "check_text.hpp"
#include "describe.hpp"
#include "io/notes.hpp"
#include "io/relax.hpp"
#include "simulation/scene_minimizer.hpp"
#include "simulation/single_terms.hpp"
#include "simulation/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace cayspin::program {
namespace {

using Lines = std::vector<std::pair<std::string, std::string>>;

std::vector<std::string> texts_of(Lines const& lines, std::string const& name) {
  std::vector<std::string> texts;
  for (auto const& line : lines)
    if (line.first == name) texts.push_back(line.second);
  return texts;
}

// Prints all lines of each name whose lines differ from those of the stage before.
void print_changes(Lines const& before, Lines const& lines) {
  for (auto const& [name, text] : lines)
    if (texts_of(lines, name) != texts_of(before, name)) print(name, text);
  for (auto line = before.begin(); line != before.end(); ++line) {
    auto const has_name = [&](auto const& other) { return other.first == line->first; };
    bool const is_first = std::find_if(before.begin(), line, has_name) == line;
    if (is_first && std::ranges::none_of(lines, has_name)) print(line->first, "none");
  }
}

}  // namespace

std::vector<CheckedStage> plan_stages(io::Scene const& scene, Precision precision) {
  std::vector<CheckedStage> stages;
  for (auto& stage : io::stages_of(scene)) {
    auto plan = stage.relax ? make_plan_to_relax(stage.scene, precision)
                            : make_plan(stage.scene, precision);
    require_same_terms(stages.empty() ? stage.scene : stages[0].stage.scene, stage.scene);
    stages.push_back({std::move(stage), std::move(plan)});
  }
  return stages;
}

void print_stages(std::vector<CheckedStage> const& stages) {
  Lines before;
  std::vector<std::string> noted;
  for (auto const& [stage, plan] : stages) {
    auto const& scene = stage.scene;
    print(io::stage_text(stage), fmt::format("from step {}, t = {}", scene.begin.step,
                                             time_text(scene.units, scene.begin.time, 9)));
    auto const lines = describe(scene);
    if (!before.empty()) print_changes(before, lines);
    before = lines;
    if (stage.relax)
      print("relax",
            fmt::format("to max |m x H| < {}{}, with at most {} evaluations", stage.relax->torque,
                        scene.units.si ? " T" : "", stage.relax->evaluations));
    else if (io::has_integrator(scene))
      print_steps(scene, plan);
    else
      print("start", "no steps");
    for (auto const& note : io::notes(scene)) {
      if (std::ranges::find(noted, note) != noted.end()) continue;
      noted.push_back(note);
      print("note", note);
    }
  }
}

Json stages_json(std::vector<CheckedStage> const& stages) {
  auto all = Json::array();
  for (auto const& [stage, plan] : stages) {
    auto const& scene = stage.scene;
    auto const& units = scene.units;
    Json one{{"name", stage.name},
             {"begin_step", scene.begin.step},
             {"begin_time", scene.begin.time * units.time},
             {"frames", plan.frames},
             {"file_bytes", bytes_json(plan.file_bytes)}};
    if (stage.relax) {
      one["relax"] = {{"torque", stage.relax->torque}, {"evaluations", stage.relax->evaluations}};
    } else if (io::has_integrator(scene)) {
      one["method"] = std::string(plan.variant.method->word);
      one["dt"] = plan.times.dt * units.time;
      one["steps"] = scene.integrator.steps;
      one["stable_dt"] = plan.stable_dt * units.time;
      one["order"] = order(scene, plan.variant);
    }
    all.push_back(std::move(one));
  }
  return all;
}

}  // namespace cayspin::program
