// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/scene.hpp"
#include "simulation/failure.hpp"
#include "simulation/precision.hpp"
#include "simulation/ranks.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace cayspin::program {

using namespace simulation;

/// A command of the program: the parser of its options, and its action. `perform` returns the exit
/// status, or throws.
struct Command {
  CLI::App* parser;
  std::function<int(Ranks&)> perform;
};

/// Each of these functions adds to the program the command that it is named after, with description
/// and options. It is defined in the source file of the same name (add_advise: trade.cpp).
using AddCommand = Command(CLI::App& program);
AddCommand add_run, add_relax, add_modes, add_path, add_sweep, add_check, add_new, add_trade,
    add_advise, add_methods, add_info, add_export;

/// All commands that this program performs itself, in the order of --help.
inline constexpr std::array all_commands{add_run,    add_relax,   add_modes, add_path,
                                         add_sweep,  add_check,   add_new,   add_trade,
                                         add_advise, add_methods, add_info,  add_export};

/// Options of a command that reads a scene.
struct SceneOptions {
  std::filesystem::path scene;
  std::vector<std::string> overrides;
};

/// Options of a command that computes on one device and writes a file.
struct DeviceOptions : SceneOptions {
  Precision precision = Precision::double_precision;
  std::optional<std::filesystem::path> output;
  std::optional<std::string> space;
  std::optional<int> threads, device;
  bool overwrite = false;
};

/// Returns the precision with this name, "double" or "single". Throws UsageError for any other
/// name.
Precision precision_named(std::string const& name);

/// Adds SCENE, --set and --precision.
template <class Options>
void add_scene_options(CLI::App& command, Options& options,
                       char const* precisions = "double (default) or single") {
  command.add_option("SCENE", options.scene, "Scene file (TOML)")->required();
  command.add_option("--set", options.overrides, "Override a key: key.path=VALUE, a TOML value")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
  command
      .add_option_function<std::string>(
          "--precision",
          [&](std::string const& name) { options.precision = precision_named(name); }, precisions)
      ->type_name("NAME");
}

/// Adds an option that may be repeated only with the same value. If it is given two different
/// values, parsing the command line throws UsageError.
template <class Value>
CLI::Option* add_one_value(CLI::App& command, std::string const& name, std::optional<Value>& value,
                           char const* description) {
  return command
      .add_option_function<std::vector<Value>>(
          name,
          [name, &value](std::vector<Value> const& given) {
            for (auto const& other : given)
              if (other != given.front())
                throw UsageError(fmt::format("{}: given as {} and as {}; accepted: one of them",
                                             name, given.front(), other));
            value = given.front();
          },
          description)
      ->expected(1)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

/// Adds --space and --threads.
template <class Options>
void add_space_options(CLI::App& command, Options& options) {
  add_one_value(command, "--space", options.space, "Kokkos execution space");
  add_one_value(command, "--threads", options.threads, "Threads of a host space")
      ->check(CLI::Range(1, 65536));
}

void add_device_options(CLI::App& command, DeviceOptions& options);

/// Adds --ranks, whose value has the form "Y,Z". `what`: its description in --help.
void add_ranks_option(CLI::App& command, std::optional<std::string>& ranks, char const* what);
/// Throws UsageError if --ranks is given for an ensemble.
void require_divisible(io::Scene const& scene, std::optional<std::string> const& ranks);

/// Throws UsageError on all ranks if they were given different scenes, different values of
/// --precision, --output or --space, or different `more`: the text of a command's own options.
void require_alike(io::Scene const& scene, DeviceOptions const& options, std::string const& more,
                   Ranks& ranks);

/// Returns the value of --threads. If it is not given, returns the number of threads of one of
/// several ranks, or nothing if Kokkos decides.
std::optional<int> threads_for(DeviceOptions const& options, std::string const& space,
                               Ranks const& ranks);

/// Throws UsageError if the name of the output file is empty.
void require_name(std::filesystem::path const& output);

inline constexpr std::string_view another_output = "another file for --output";

/// Throws UsageError if `file`, which a command reads, is one of the files that the command writes:
/// `output`, its .partial file, or the checkpoint beside it. `accepted`: what the message proposes.
void require_not_written(std::filesystem::path const& file, std::filesystem::path const& output,
                         std::string_view accepted = another_output);

/// Returns the file that a command writes: `output` if it is given, otherwise the scene's
/// output.file. Throws io::SceneError if there is neither. Throws UsageError if the name is empty,
/// or if writing would replace a file that the scene reads.
std::filesystem::path output_file(io::Scene const& scene,
                                  std::optional<std::filesystem::path> const& output);

}  // namespace cayspin::program
