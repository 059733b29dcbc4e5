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

// Of what runs on one device: where it computes and what it writes.
void add_run_options(CLI::App& command, auto& options) {
  add_scene_options(command, options, "double (default) or single");
  command.add_option("--output", options.output, "The file to write; wins over output.file");
  command.add_flag("--overwrite", options.overwrite, "Replace a file that exists");
  add_space_options(command, options);
  command.add_option("--device", options.device, "Number of the device")
      ->check(CLI::Range(0, 65536));
}

void add_ranks_option(CLI::App& command, auto& options, char const* what) {
  command.add_option("--ranks", options.ranks, what)->type_name("Y,Z");
}

void add_quiet_flag(CLI::App& command, auto& options, char const* what = "No progress") {
  command.add_flag("--quiet", options.quiet, what);
}

CLI::App* add_run(CLI::App& app, RunOptions& options) {
  auto* command = app.add_subcommand("run", "Run a scene and write its trajectory (HDF5)");
  add_run_options(*command, options);
  add_ranks_option(*command, options, "Parts of the lattice along y and z, on ranks of MPI");
  command->add_option("--restart", options.restart,
                      "Go on from the last frame of a trajectory file");
  command->add_flag_callback(
      "--quiet", [&] { options.listener = Listener::nobody; }, "No progress");
  command->add_flag_callback("--report-progress", [&] { options.listener = Listener::program; })
      ->group("");  // what `sweep` starts its runs with
  return command;
}

CLI::App* add_relax(CLI::App& app, RelaxOptions& options) {
  auto* command = app.add_subcommand(
      "relax", "Find the state of rest of a scene, or one for each of its fields (HDF5)");
  add_run_options(*command, options);
  command->add_option("--torque", options.torque, "Largest |m x H| (default: 1e-6)");
  command
      ->add_option("--evaluations", options.evaluations,
                   "Most evaluations of a field (default: 100000)")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1} << 53U));
  command->add_flag("--keep-saddles", options.keep_saddles,
                    "End at a state without torque, also where the energy falls from there");
  add_quiet_flag(*command, options);
  return command;
}

CLI::App* add_sweep(CLI::App& app, SweepOptions& options) {
  auto* command = app.add_subcommand(
      "sweep", "Run a scene with all combinations of some keys' values, into one file (HDF5)");
  add_scene_options(*command, options, "double (default) or single");
  command
      ->add_option("--over", options.over,
                   "A key and its values: key.path=VALUE,VALUE,..., TOML values")
      ->required()
      ->allow_extra_args(false)
      ->type_name("KEY=VALUES");
  command->add_option("--output", options.output, "The file of all runs")->required();
  command->add_option("--jobs", options.jobs, "Runs at a time")->check(CLI::Range(1, 65536));
  add_space_options(*command, options);
  command->add_flag("--overwrite", options.overwrite,
                    "Start again where the file has a sweep, or replace another file");
  add_quiet_flag(*command, options, "No progress and no table");
  return command;
}

CLI::App* add_watch(CLI::App& app, WatchOptions& options) {
  auto* command = app.add_subcommand("watch", "Follow a run by its trajectory file");
  command->add_option("FILE", options.file, "Trajectory file (HDF5)")->required();
  command->add_flag("--once", options.once, "Say how far it is, and end");
  return command;
}

CLI::App* add_check(CLI::App& app, CheckOptions& options) {
  auto* command = app.add_subcommand(
      "check", "Validate a scene and say what it models, the stable dt, memory and cost");
  add_scene_options(*command, options, "double (default) or single");
  command->add_flag("--json", options.json, "The numbers as JSON");
  add_ranks_option(*command, options, "Say what a run with so many parts along y and z repeats");
  return command;
}

// Of commands that try methods.
void add_try_options(CLI::App& command, TryOptions& options) {
  add_scene_options(command, options, "double or single alone (default: both)");
  add_space_options(command, options);
  add_quiet_flag(command, options);
}

CLI::App* add_new(CLI::App& app, NewOptions& options) {
  auto* command = app.add_subcommand("new", "Write a commented scene to begin with");
  command->add_option("KIND", options.kind, names_of_new_scenes())->required();
  command->add_option("--output", options.output, "The file to write (default: KIND.toml)");
  command->add_flag("--overwrite", options.overwrite, "Replace a file that exists");
  return command;
}

CLI::App* add_trade(CLI::App& app, TradeOptions& options) {
  auto* command = app.add_subcommand(
      "trade", "Measure error against time and evaluations for every method on a scene");
  add_try_options(*command, options);
  command->add_option("--seconds", options.seconds, "Longest run (default: 10)");
  auto* json = command->add_flag("--json", options.json, "The numbers as JSON");
  command->add_flag("--advice", options.advice, "Also judge what `advise` says of the scene")
      ->excludes(json);
  return command;
}

CLI::App* add_advise(CLI::App& app, AdviseOptions& options) {
  auto* command = app.add_subcommand(
      "advise",
      "Name the cheapest method and its dt or tolerance for an error. Takes at most a tenth of the "
      "run's time, or 2 s");
  add_try_options(*command, options);
  command->add_option("--error", options.error, "Largest distance of any spin")->required();
  command->add_option("--budget", options.budget, "Time that the run may take")
      ->transform(
          CLI::AsNumberWithUnit(std::map<std::string, double>{{"s", 1}, {"min", 60}, {"h", 3600}},
                                CLI::AsNumberWithUnit::CASE_SENSITIVE, "TIME"))
      ->type_name("TIME");
  command->add_flag("--json", options.json, "The answer as JSON");
  return command;
}

CLI::App* add_info(CLI::App& app, std::filesystem::path& file) {
  auto* command = app.add_subcommand("info", "Say what a trajectory file holds");
  command->add_option("FILE", file, "Trajectory file (HDF5)")->required();
  return command;
}

CLI::App* add_export(CLI::App& app, ExportOptions& options) {
  auto* command =
      app.add_subcommand("export", "Write frames of a trajectory file for other programs");
  command->add_option("FILE", options.file, "Trajectory file (HDF5)")->required();
  command->add_option("--ovf", options.folder, "Folder for OVF 2.0 files, one per frame")
      ->required()
      ->type_name("DIR");
  command
      ->add_option_function<std::string>(
          "--format", [&](std::string const& name) { options.format = ovf_format(name); },
          "text, binary4 or binary8 (default: the binary one that keeps the bits)")
      ->type_name("NAME");
  command->add_option("--frames", options.frames, "last (default), all or a number");
  command->add_flag("--overwrite", options.overwrite, "Replace files that exist");
  return command;
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
  RelaxOptions relax_options;
  SweepOptions sweep_options;
  WatchOptions watch_options;
  CheckOptions check_options;
  NewOptions new_options;
  TradeOptions trade_options;
  AdviseOptions advise_options;
  std::filesystem::path info_file;
  ExportOptions export_options;
  auto* const run_command = add_run(app, run_options);
  auto* const relax_command = add_relax(app, relax_options);
  auto* const sweep_command = add_sweep(app, sweep_options);
  auto* const watch_command = add_watch(app, watch_options);
  auto* const check_command = add_check(app, check_options);
  auto* const new_command = add_new(app, new_options);
  auto* const trade_command = add_trade(app, trade_options);
  auto* const advise_command = add_advise(app, advise_options);
  auto* const methods_command =
      app.add_subcommand("methods", "List the integrators and their options");
  add_info(app, info_file);
  auto* const export_command = add_export(app, export_options);

  // Programs of their own, which read their own options.
  app.add_subcommand("reproduce",
                     "The tables, figures and errata of Lewis and Nigam 2002, beside the paper's");
  app.add_subcommand("extremes", "Behaviour of every method at extreme inputs");
  app.add_subcommand("plot", "Draw the spins of a trajectory file, one frame or a movie");
  app.add_subcommand("view",
                     "Look at a trajectory file in the browser, also while a run writes it");

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
  for (std::string const command : {"plot", "view"})
    if (argc > 1 && argv[1] == command) become_script(command + "_texture.py", argv);
  if (auto const status = ranks->together([&] { return parse(app, argc, argv); })) return *status;
  if (*run_command) return run(run_options, *ranks);
  if (*relax_command) return relax(relax_options);
  if (*sweep_command) return sweep_over(sweep_options);
  if (*watch_command) return watch(watch_options);
  if (*check_command) return check(check_options);
  if (*new_command) return write_new(new_options);
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
