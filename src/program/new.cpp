// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "command.hpp"
#include "files/file_beside.hpp"
#include "io/toml_string.hpp"
#include "new_scenes.hpp"
#include "simulation/failure.hpp"
#include "simulation/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

namespace cayspin::program {
namespace {

struct NewOptions {
  std::string kind;
  std::optional<std::filesystem::path> output;
  bool overwrite = false;
};

std::string replaced(std::string text, std::string_view what, std::string const& by) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size())
    text.replace(at, what.size(), by);
  return text;
}

// Replaces the name of the file of results, which is a string of TOML or a word of a command.
std::string with_results(std::string text, std::string const& old, std::string const& name) {
  bool const is_plain = name.find_first_of("\"\\") == name.npos;
  auto const quoted = is_plain ? '"' + name + '"' : io::toml_string(name);
  for (std::size_t at = 0; (at = text.find(old, at)) != std::string::npos;) {
    bool const is_string = at > 0 && text[at - 1] == '"';
    auto const by = is_string ? quoted : simulation::shell_word(name);
    at -= is_string ? 1 : 0;
    text.replace(at, old.size() + (is_string ? 2 : 0), by);
    at += by.size();
  }
  return text;
}

std::string names_of_new_scenes() {
  std::vector<std::string_view> names;
  for (auto const& scene : new_scenes) names.push_back(scene.kind);
  return fmt::format("{}", fmt::join(names, ", "));
}

int write_new(NewOptions const& options) {
  auto const scene = std::ranges::find(new_scenes, options.kind, &NewScene::kind);
  if (scene == new_scenes.end())
    throw UsageError(fmt::format("new {}: accepted: {}", options.kind, names_of_new_scenes()));
  auto const path = options.output.value_or(options.kind + ".toml");
  require_name(path);
  io::FileBeside file(path, options.overwrite);
  // Replaces the names of the shipped scene and of its results by the new names.
  auto const results = [](std::filesystem::path name) {
    return name.filename().replace_extension(".h5").string();
  };
  auto const text =
      replaced(std::string(scene->text), scene->path, simulation::shell_word(path.string()));
  file.stream() << with_results(text, results(scene->path), results(path));
  file.commit();
  fmt::print("{0}: try `cayspin check {1}`, then `cayspin run {1}`\n", path.string(),
             simulation::shell_word(path.string()));
  return Status::done;
}

}  // namespace

Command add_new(CLI::App& program) {
  auto const options = std::make_shared<NewOptions>();
  auto* const command = program.add_subcommand("new", "Write a commented scene to begin with");
  command->add_option("KIND", options->kind, names_of_new_scenes())->required();
  command->add_option("-o,--output", options->output, "The file to write (default: KIND.toml)");
  command->add_flag("--overwrite", options->overwrite, "Replace a file that exists");
  return {command, [options](Ranks&) { return write_new(*options); }};
}

}  // namespace cayspin::program
