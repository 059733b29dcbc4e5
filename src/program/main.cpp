// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "command.hpp"
#include "failure.hpp"
#include "text.hpp"

#include <cayspin/version.hpp>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cstdio>

namespace cayspin::program {
namespace {

Precision precision(std::string const& name) {
  for (auto const known : {Precision::double_precision, Precision::single_precision})
    if (to_string(known) == name) return known;
  throw UsageError(fmt::format("--precision {}: accepted: double, single", name));
}

void add_scene_options(CLI::App& command, SceneOptions& options) {
  command.add_option("SCENE", options.scene, "Scene file (TOML)")->required();
  command.add_option("--set", options.overrides, "Override a key: key.path=VALUE, a TOML value")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
  command
      .add_option_function<std::string>(
          "--precision", [&](std::string const& name) { options.precision = precision(name); },
          "double (default) or single")
      ->type_name("NAME");
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

void add_reproduce_options(CLI::App& command, ReproduceOptions& options) {
  command.add_option("PART", options.parts, "What to reproduce (default: all)")
      ->check(CLI::IsMember(reproducible_parts()));
  command.add_option("--bodies", options.bodies, "Random bodies per table (default: 1000)")
      ->check(CLI::Range(1, 10'000'000));
  command.add_option("--seed", options.seed, "Seed of the random bodies (default: 1)");
  command.add_option("--output", options.output, "Folder for the numbers, as CSV files")
      ->type_name("DIR");
  command.add_option("--threads", options.threads, "Threads (default: 1, the systems are small)")
      ->check(CLI::Range(1, 65536));
}

int perform(int argc, char** argv) {
  CLI::App app("Lie-group time integration of spin fields", "cayspin");
  app.set_version_flag("--version", CAYSPIN_VERSION_STRING);
  app.require_subcommand(1);

  RunOptions run_options;
  auto* run_command = app.add_subcommand("run", "Run a scene and write its trajectory (HDF5)");
  add_scene_options(*run_command, run_options);
  run_command->add_option("--output", run_options.output, "Trajectory file; wins over output.file");
  run_command->add_flag("--overwrite", run_options.overwrite, "Replace a file that exists");
  run_command->add_option("--space", run_options.space, "Kokkos execution space");
  run_command->add_option("--threads", run_options.threads, "Threads of a host space")
      ->check(CLI::Range(1, 65536));
  run_command->add_option("--device", run_options.device, "Number of the device")
      ->check(CLI::Range(0, 65536));
  run_command->add_option("--restart", run_options.restart,
                          "Go on from the last frame of a trajectory file");
  run_command->add_flag("--quiet", run_options.quiet, "No progress");

  CheckOptions check_options;
  auto* check_command = app.add_subcommand(
      "check", "Validate a scene and say what it models, the stable dt, memory and cost");
  add_scene_options(*check_command, check_options);
  check_command->add_flag("--json", check_options.json, "The numbers as JSON");

  TradeOptions trade_options;
  auto* trade_command = app.add_subcommand(
      "trade", "Measure error against time and evaluations for every method on a scene");
  add_scene_options(*trade_command, trade_options);
  trade_command->add_option("--space", trade_options.space, "Kokkos execution space");
  trade_command->add_option("--threads", trade_options.threads, "Threads of a host space")
      ->check(CLI::Range(1, 65536));
  trade_command->add_option("--seconds", trade_options.seconds, "Longest run (default: 10)")
      ->check(CLI::PositiveNumber);
  auto* json = trade_command->add_flag("--json", trade_options.json, "The numbers as JSON");
  trade_command
      ->add_flag("--advice", trade_options.advice, "Also judge what `advise` says of the scene")
      ->excludes(json);

  AdviseOptions advise_options;
  auto* advise_command =
      app.add_subcommand("advise", "Name the cheapest method and its dt or tolerance for an error");
  add_scene_options(*advise_command, advise_options);
  advise_command->add_option("--error", advise_options.error, "Largest distance of any spin")
      ->required()
      ->check(CLI::Range(1e-13, 1.0));
  advise_command->add_option("--budget", advise_options.budget, "Time that the run may take")
      ->transform(
          CLI::AsNumberWithUnit(std::map<std::string, double>{{"s", 1}, {"min", 60}, {"h", 3600}},
                                CLI::AsNumberWithUnit::CASE_SENSITIVE, "TIME"))
      ->type_name("TIME");
  advise_command->add_option("--space", advise_options.space, "Kokkos execution space");
  advise_command->add_option("--threads", advise_options.threads, "Threads of a host space")
      ->check(CLI::Range(1, 65536));

  auto* methods_command = app.add_subcommand("methods", "List the integrators and their options");

  std::filesystem::path info_file;
  auto* info_command = app.add_subcommand("info", "Say what a trajectory file holds");
  info_command->add_option("FILE", info_file, "Trajectory file (HDF5)")->required();

  ReproduceOptions reproduce_options;
  auto* reproduce_command = app.add_subcommand(
      "reproduce", "The tables, figures and errata of Lewis and Nigam 2002, beside the paper's");
  add_reproduce_options(*reproduce_command, reproduce_options);

  ExtremesOptions extremes_options;
  auto* extremes_command =
      app.add_subcommand("extremes", "What every method does where numbers end");
  extremes_command->add_flag("--json", extremes_options.json, "One JSON object for each run");
  extremes_command->add_flag("--long", extremes_options.longest, "Runs of 1e8 steps, in minutes");

  require_command(app, argc, argv);
  try {
    app.parse(argc, argv);
  } catch (CLI::ParseError const& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    throw UsageError(fmt::format("{} (see cayspin --help)", error.what()));
  }
  if (*run_command) return run(run_options);
  if (*check_command) return check(check_options);
  if (*trade_command) return trade_off(trade_options);
  if (*advise_command) return advise_on(advise_options);
  if (*methods_command) return methods();
  if (*reproduce_command) return reproduce(reproduce_options);
  if (*extremes_command) return extremes(extremes_options);
  return info(info_file);
}

// Messages about a file begin with its name, those about the command line with the program's.
int perform_and_report(int argc, char** argv) {
  auto const report = [](std::string const& message, int status) {
    std::fflush(stdout);
    fmt::print(stderr, "{}\n", one_line(message));
    return status;
  };
  try {
    return perform(argc, argv);
  } catch (NumbersFailed const& error) {
    return report(error.what(), Status::numbers_failed);
  } catch (UsageError const& error) {
    return report(fmt::format("cayspin: {}", error.what()), Status::wrong_usage);
  } catch (std::bad_alloc const&) {
    return report("cayspin: not enough memory", Status::wrong_usage);
  } catch (std::exception const& error) {
    return report(error.what(), Status::wrong_usage);
  }
}

}  // namespace
}  // namespace cayspin::program

int main(int argc, char** argv) { return cayspin::program::perform_and_report(argc, argv); }
