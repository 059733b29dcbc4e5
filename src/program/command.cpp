// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "command.hpp"

#include "io/checkpoint.hpp"
#include "simulation/threads_of_rank.hpp"

#include <fmt/format.h>

#include <string_view>
#include <system_error>
#include <vector>

namespace cayspin::program {
namespace {

namespace fs = std::filesystem;

void require_none_is(fs::path const& file, std::vector<fs::path> const& written,
                     std::string_view accepted = another_output) {
  std::error_code ignored;
  for (auto const& other : written)
    if (fs::equivalent(file, other, ignored))
      throw UsageError(fmt::format("{}: the command reads it, and would replace it; accepted: {}",
                                   file.string(), accepted));
}

}  // namespace

Precision precision_named(std::string const& name) {
  for (auto const known : {Precision::double_precision, Precision::single_precision})
    if (to_string(known) == name) return known;
  throw UsageError(fmt::format("--precision {}: accepted: double, single", name));
}

void add_device_options(CLI::App& command, DeviceOptions& options) {
  add_scene_options(command, options);
  command.add_option("-o,--output", options.output, "The file to write; wins over output.file");
  command.add_flag("--overwrite", options.overwrite, "Replace a file that exists");
  add_space_options(command, options);
  command.add_option("--device", options.device, "Number of the device")
      ->check(CLI::Range(0, 65536));
}

void add_ranks_option(CLI::App& command, std::optional<std::string>& ranks, char const* what) {
  command.add_option("--ranks", ranks, what)->type_name("Y,Z");
}

void require_divisible(io::Scene const& scene, std::optional<std::string> const& ranks) {
  if (ranks && scene.ensemble.there())
    throw UsageError(
        "--ranks takes no ensemble, whose lattices are not divided: each rank runs "
        "some of the replicas; accepted: no --ranks");
}

void require_alike(io::Scene const& scene, DeviceOptions const& options, std::string const& more,
                   Ranks& ranks) {
  auto given = scene.text;
  for (auto const& option :
       {std::string(to_string(options.precision)), options.output.value_or("").string(),
        options.space.value_or(""), more})
    given += '\n' + option;
  bool const alike = ranks.same(given);
  ranks.together([&] {
    if (!alike && ranks.is_first())
      throw UsageError("the ranks were given different scenes or options; accepted: the same");
  });
}

std::optional<int> threads_for(DeviceOptions const& options, std::string const& space,
                               Ranks const& ranks) {
  if (options.threads || !ranks.many()) return options.threads;
  return threads_of_rank(space, cores_for_threads(), ranks.on_these_cores());
}

void require_name(fs::path const& output) {
  if (output.empty())
    throw UsageError("--output: the file name is empty; accepted: the name of a file");
}

void require_not_written(fs::path const& file, fs::path const& output, std::string_view accepted) {
  require_none_is(file, {output, output.string() + ".partial", io::checkpoint_beside(output)},
                  accepted);
}

fs::path output_file(io::Scene const& scene, std::optional<fs::path> const& output) {
  if (!output && !scene.output.file)
    throw io::scene_error(scene, "output.file",
                          "no file to write to; accepted: this key, or --output FILE.h5");
  auto const path = output ? *output : *scene.output.file;
  require_name(path);
  std::vector read{scene.path};
  read.insert(read.end(), scene.files.begin(), scene.files.end());
  for (auto const& stage : scene.stages)
    read.insert(read.end(), stage.scene.files.begin(), stage.scene.files.end());
  std::vector<fs::path> beside;
  if (scene.output.xdmf) beside.push_back(fs::path(path).replace_extension(".xdmf"));
  if (scene.output.table) beside.push_back(fs::path(path).replace_extension(".txt"));
  for (auto const& file : read) {
    require_not_written(file, path);
    require_none_is(file, beside);
  }
  return path;
}

}  // namespace cayspin::program
