// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "command.hpp"
#include "launch/launched_ranks.hpp"
#include "simulation/command_line.hpp"

#include <cayspin/version.hpp>

namespace cayspin::program {
namespace {

Precision precision(std::string const& name) {
  for (auto const known : {Precision::double_precision, Precision::single_precision})
    if (to_string(known) == name) return known;
  throw UsageError(fmt::format("--precision {}: accepted: double, single", name));
}

io::OvfFormat ovf_format(std::string const& name) {
  if (auto const* const known = io::find_word<io::OvfFormat>(name)) return known->value;
  throw UsageError(fmt::format("--format {}: accepted: text, binary4, binary8", name));
}

template <class Options>
void add_scene_options(CLI::App& command, Options& options, char const* precisions) {
  command.add_option("SCENE", options.scene, "Scene file (TOML)")->required();
  command.add_option("--set", options.overrides, "Override a key: key.path=VALUE, a TOML value")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
  command
      .add_option_function<std::string>(
          "--precision", [&](std::string const& name) { options.precision = precision(name); },
          precisions)
      ->type_name("NAME");
}

void add_space_options(CLI::App& command, auto& options) {
  command.add_option("--space", options.space, "Kokkos execution space");
  command.add_option("--threads", options.threads, "Threads of a host space")
      ->check(CLI::Range(1, 65536));
}

// CLI11 would only say that there is none.
void require_command(CLI::App const& app, int argc, char** argv) {
  std::string_view const first = argc > 1 ? argv[1] : "";
  if (first.starts_with('-')) return;
  std::string names;
  for (auto const* command : app.get_subcommands({})) {
    if (command->get_name() == first) return;
    names += (names.empty() ? "" : ", ") + command->get_name();
  }
  throw UsageError(fmt::format(
      "{}: accepted: {} (see cayspin --help)",
      first.empty() ? std::string("no command") : fmt::format("unknown command {}", first), names));
}

int perform(int argc, char** argv) {
  CLI::App app("Lie-group time integration of spin fields", "cayspin");
  app.set_version_flag("--version", CAYSPIN_VERSION_STRING);
  app.require_subcommand(1);

  RunOptions run_options;
  auto* run_command = app.add_subcommand("run", "Run a scene and write its trajectory (HDF5)");
  add_scene_options(*run_command, run_options, "double (default) or single");
  run_command->add_option("--output", run_options.output, "Trajectory file; wins over output.file");
  run_command->add_flag("--overwrite", run_options.overwrite, "Replace a file that exists");
  add_space_options(*run_command, run_options);
  run_command->add_option("--device", run_options.device, "Number of the device")
      ->check(CLI::Range(0, 65536));
  run_command
      ->add_option("--ranks", run_options.ranks,
                   "Parts of the lattice along y and z, on ranks of MPI")
      ->type_name("Y,Z");
  run_command->add_option("--restart", run_options.restart,
                          "Go on from the last frame of a trajectory file");
  run_command->add_flag_callback(
      "--quiet", [&] { run_options.listener = Listener::nobody; }, "No progress");
  run_command
      ->add_flag_callback("--report-progress", [&] { run_options.listener = Listener::program; })
      ->group("");  // what `sweep` starts its runs with

  RelaxOptions relax_options;
  auto* relax_command = app.add_subcommand(
      "relax", "Find the state of rest of a scene, or one for each of its fields (HDF5)");
  add_scene_options(*relax_command, relax_options, "double (default) or single");
  relax_command->add_option("--output", relax_options.output, "The file; wins over output.file");
  relax_command->add_option("--torque", relax_options.torque, "Largest |m x H| (default: 1e-6)")
      ->check(CLI::PositiveNumber);
  relax_command
      ->add_option("--evaluations", relax_options.evaluations,
                   "Most evaluations of a field (default: 100000)")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1} << 53U));
  relax_command->add_flag("--overwrite", relax_options.overwrite, "Replace a file that exists");
  add_space_options(*relax_command, relax_options);
  relax_command->add_option("--device", relax_options.device, "Number of the device")
      ->check(CLI::Range(0, 65536));
  relax_command->add_flag("--quiet", relax_options.quiet, "No progress");

  SweepOptions sweep_options;
  auto* sweep_command = app.add_subcommand(
      "sweep", "Run a scene with all combinations of some keys' values, into one file (HDF5)");
  add_scene_options(*sweep_command, sweep_options, "double (default) or single");
  sweep_command
      ->add_option("--over", sweep_options.over,
                   "A key and its values: key.path=VALUE,VALUE,..., TOML values")
      ->required()
      ->allow_extra_args(false)
      ->type_name("KEY=VALUES");
  sweep_command->add_option("--output", sweep_options.output, "The file of all runs")->required();
  sweep_command->add_option("--jobs", sweep_options.jobs, "Runs at a time")
      ->check(CLI::Range(1, 65536));
  add_space_options(*sweep_command, sweep_options);
  sweep_command->add_flag("--overwrite", sweep_options.overwrite,
                          "Start again where the file has a sweep, or replace another file");
  sweep_command->add_flag("--quiet", sweep_options.quiet, "No progress and no table");

  WatchOptions watch_options;
  auto* watch_command = app.add_subcommand("watch", "Follow a run by its trajectory file");
  watch_command->add_option("FILE", watch_options.file, "Trajectory file (HDF5)")->required();
  watch_command->add_flag("--once", watch_options.once, "Say how far it is, and end");

  CheckOptions check_options;
  auto* check_command = app.add_subcommand(
      "check", "Validate a scene and say what it models, the stable dt, memory and cost");
  add_scene_options(*check_command, check_options, "double (default) or single");
  check_command->add_flag("--json", check_options.json, "The numbers as JSON");
  check_command
      ->add_option("--ranks", check_options.ranks,
                   "Say what a run with so many parts along y and z repeats")
      ->type_name("Y,Z");

  TradeOptions trade_options;
  auto* trade_command = app.add_subcommand(
      "trade", "Measure error against time and evaluations for every method on a scene");
  add_scene_options(*trade_command, trade_options, "double or single alone (default: both)");
  add_space_options(*trade_command, trade_options);
  trade_command->add_flag("--quiet", trade_options.quiet, "No progress");
  trade_command->add_option("--seconds", trade_options.seconds, "Longest run (default: 10)")
      ->check(CLI::PositiveNumber);
  auto* json = trade_command->add_flag("--json", trade_options.json, "The numbers as JSON");
  trade_command
      ->add_flag("--advice", trade_options.advice, "Also judge what `advise` says of the scene")
      ->excludes(json);

  AdviseOptions advise_options;
  auto* advise_command =
      app.add_subcommand("advise", "Name the cheapest method and its dt or tolerance for an error");
  add_scene_options(*advise_command, advise_options, "double or single alone (default: both)");
  advise_command->add_option("--error", advise_options.error, "Largest distance of any spin")
      ->required()
      ->check(CLI::Range(1e-13, 1.0));
  advise_command->add_option("--budget", advise_options.budget, "Time that the run may take")
      ->transform(
          CLI::AsNumberWithUnit(std::map<std::string, double>{{"s", 1}, {"min", 60}, {"h", 3600}},
                                CLI::AsNumberWithUnit::CASE_SENSITIVE, "TIME"))
      ->type_name("TIME");
  advise_command->add_flag("--json", advise_options.json, "The answer as JSON");
  add_space_options(*advise_command, advise_options);
  advise_command->add_flag("--quiet", advise_options.quiet, "No progress");

  auto* methods_command = app.add_subcommand("methods", "List the integrators and their options");

  std::filesystem::path info_file;
  auto* info_command = app.add_subcommand("info", "Say what a trajectory file holds");
  info_command->add_option("FILE", info_file, "Trajectory file (HDF5)")->required();

  ExportOptions export_options;
  auto* export_command =
      app.add_subcommand("export", "Write frames of a trajectory file for other programs");
  export_command->add_option("FILE", export_options.file, "Trajectory file (HDF5)")->required();
  export_command
      ->add_option("--ovf", export_options.folder, "Folder for OVF 2.0 files, one per frame")
      ->required()
      ->type_name("DIR");
  export_command
      ->add_option_function<std::string>(
          "--format", [&](std::string const& name) { export_options.format = ovf_format(name); },
          "text, binary4 or binary8 (default: the binary one that keeps the bits)")
      ->type_name("NAME");
  export_command->add_option("--frames", export_options.frames, "last (default), all or a number");
  export_command->add_flag("--overwrite", export_options.overwrite, "Replace files that exist");

  // Programs of their own, which read their own options.
  app.add_subcommand("reproduce",
                     "The tables, figures and errata of Lewis and Nigam 2002, beside the paper's");
  app.add_subcommand("extremes", "Behaviour of every method at extreme inputs");

  auto const ranks = launched_ranks();
  ranks->together([&] {
    require_command(app, argc, argv);
    bool const is_run = argc > 1 && std::string_view(argv[1]) == "run";
    if (ranks->many() && !is_run && ranks->is_first())
      throw UsageError(fmt::format("{} runs on one rank; accepted: run", argc > 1 ? argv[1] : ""));
  });
  start_others_alone();
  for (std::string const command : {"reproduce", "extremes"})
    if (argc > 1 && argv[1] == command) become_sibling("cayspin-" + command, argv);
  if (auto const status = ranks->together([&] { return parse(app, argc, argv); })) return *status;
  if (*run_command) return run(run_options, *ranks);
  if (*relax_command) return relax(relax_options);
  if (*sweep_command) return sweep_over(sweep_options);
  if (*watch_command) return watch(watch_options);
  if (*check_command) return check(check_options);
  if (*trade_command) return trade_off(trade_options);
  if (*advise_command) return advise_on(advise_options);
  if (*methods_command) return methods();
  if (*export_command) return export_ovf(export_options);
  return info(info_file);
}

}  // namespace
}  // namespace cayspin::program

int main(int argc, char** argv) {
  return cayspin::simulation::perform_and_report(cayspin::program::perform, argc, argv);
}
