// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "simulation/command_line.hpp"
#include "simulation/kokkos_settings.hpp"
#include "table.hpp"

namespace cayspin::extremes {
namespace {

// Those that the many steps can be had of in minutes.
std::vector<Integrator> simplest(std::vector<Integrator> const& all) {
  std::vector<Integrator> few;
  for (auto const& one : all)
    if (one.name() == "rkmk4" && one.generator == io::Generator::standard) few.push_back(one);
  return few;
}

// Whose scenes are not refused.
std::vector<Integrator> those_that_take(std::vector<Integrator> const& all,
                                        Setting const& setting) {
  Situation const situation{"", setting, setting};
  std::vector<Integrator> some;
  for (auto const& one : all)
    if (try_out(one, situation, Precision::double_precision).fate != Fate::refused)
      some.push_back(one);
  return some;
}

int perform(int argc, char** argv) {
  bool json = false, longest = false;
  CLI::App app("Behaviour of every method at extreme inputs", "cayspin extremes");
  app.add_flag("--json", json, "One JSON object for each run");
  app.add_flag("--long", longest, "Runs of 1e8 steps, in minutes");
  if (auto const status = parse(app, argc, argv)) return *status;

  KokkosSession const kokkos(space_name<Kokkos::DefaultHostExecutionSpace>(), 1, {});
  auto const integrators = with_equal_steps();
  bool kept = true;
  auto const show = [&](Section const& section, std::vector<Integrator> const& tried) {
    Table const table(section, tried);
    json ? table.print_json() : table.print_markdown();
    kept = kept && table.is_kept();
  };
  if (longest) {
    show(longest_runs(), simplest(integrators));
  } else {
    if (!json) print_head();
    for (auto const& section : sections()) show(section, integrators);
    show(adaptive_steps(), with_adaptive_steps());
    show(temperatures(), those_that_take(integrators, {.damping = 0.1, .temperature = 1}));
    show(dear_fields(), those_that_take(integrators, {.damping = 0.1, .dear = 0.5}));
    show(states_of_rest(), {relaxation()});
  }
  if (!kept) throw NumbersFailed("cayspin: a promise of the tables is broken");
  return Status::done;
}

}  // namespace
}  // namespace cayspin::extremes

int main(int argc, char** argv) {
  return cayspin::simulation::perform_and_report(cayspin::extremes::perform, argc, argv);
}
