// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "command.hpp"

#include <fmt/format.h>

namespace cayspin::program {

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

std::filesystem::path output_file(io::Scene const& scene,
                                  std::optional<std::filesystem::path> const& output) {
  if (output) return *output;
  if (scene.output.file) return *scene.output.file;
  throw io::scene_error(scene, "output.file",
                        "no file to write to; accepted: this key, or --output FILE.h5");
}

}  // namespace cayspin::program
