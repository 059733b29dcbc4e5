// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "command.hpp"
#include "hdf5/reading_trial.hpp"
#include "io/words_of_others.hpp"
#include "launch/launched_ranks.hpp"
#include "read_in_child.hpp"
#include "simulation/command_line.hpp"
#include "sweep/worker.hpp"

#include <cayspin/version.hpp>

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

namespace cayspin::program {
namespace {

std::filesystem::path self(char** argv) {
  std::error_code unknown;
  auto const path = std::filesystem::read_symlink("/proc/self/exe", unknown);
  return unknown ? std::filesystem::path(argv[0]) : path;
}

// Replaces this process by the program of this name in the same folder, passing the arguments after
// the command.
[[noreturn]] void become_sibling(std::string const& name, char** argv) {
  auto const path = self(argv).parent_path() / name;
  argv[1] = argv[0];  // the name of this program, in place of the command
  ::execv(path.c_str(), argv + 1);
  throw UsageError(fmt::format("{}: cannot be started: {} (the build puts it beside cayspin)",
                               path.string(), std::strerror(errno)));
}

// Replaces this process by a Python script in ../share/cayspin/python, relative to the folder of
// this program.
[[noreturn]] void become_script(std::string const& name, char** argv) {
  auto const program = self(argv);
  auto path = (program.parent_path().parent_path() / "share/cayspin/python" / name).string();
  if (::access(path.c_str(), R_OK) != 0)
    throw UsageError(fmt::format("{}: {} (the build and the installation put it there)", path,
                                 std::strerror(errno)));
  char const* const chosen = std::getenv("CAYSPIN_PYTHON");
  ::setenv("CAYSPIN_PROGRAM", program.c_str(), 0);  // for scripts that start runs
  std::string python = chosen && *chosen != '\0' ? chosen : CAYSPIN_PYTHON;
  argv[0] = python.data();
  argv[1] = path.data();
  ::execvp(python.c_str(), argv);
  throw UsageError(
      fmt::format("{}: cannot be started: {}; accepted: a Python with h5py and matplotlib in "
                  "CAYSPIN_PYTHON",
                  python, std::strerror(errno)));
}

/// A command that is a separate program with its own options.
struct OtherProgram {
  std::string command, sentence;
  void (*become)(std::string const& name, char** argv);
  std::string name;
};

std::vector<OtherProgram> other_programs() {
  return {
      {"reproduce",
       "Recompute the tables and figures of Lewis and Nigam 2002, beside the paper's values, and "
       "list its errata",
       become_sibling, "cayspin-reproduce"},
      {"plot", "Draw the spins of a trajectory file, one frame or a movie", become_script,
       "plot_texture.py"},
      {"view", "Look at a trajectory file in the browser, also while a run writes it",
       become_script, "view_texture.py"}};
}

// Returns the heading of --help under which a command stands.
std::string group_of(std::string_view command) {
  constexpr std::array of_scenes{"run", "relax", "modes", "path", "sweep"};
  constexpr std::array before{"new", "check", "advise", "trade", "methods"};
  constexpr std::array of_files{"info", "plot", "view", "export"};
  auto const is_in = [&](auto const& names) {
    return std::ranges::find(names, command) != names.end();
  };
  if (is_in(of_scenes)) return "Compute";
  if (is_in(before)) return "Prepare";
  return is_in(of_files) ? "Files" : "Paper";
}

// Throws UsageError if the command is missing, or with its name if it is unknown. CLI11 would only
// say that a command is missing.
void require_command(CLI::App const& app, std::string_view first) {
  if (first.starts_with('-')) return;
  std::string names;
  for (auto const* command : app.get_subcommands({})) {
    if (command->get_name() == first) return;
    names += (names.empty() ? "" : ", ") + command->get_name();
  }
  throw UsageError(fmt::format("{}: accepted: {} (see cayspin --help)",
                               first.empty() ? std::string("no command")
                                             : fmt::format("unknown command {}{}", first,
                                                           io::hint_for_word_of_others(first)),
                               names));
}

// Replaces `help` by `--help`, and `help COMMAND` by `COMMAND --help`.
std::vector<char*> with_help_as_option(std::span<char* const> arguments) {
  static char help[] = "--help";
  std::vector<char*> plain(arguments.begin(), arguments.end());
  if (plain.size() < 2 || std::string_view(plain[1]) != "help") return plain;
  if (plain.size() > 3)
    throw UsageError(fmt::format("help {} {}: accepted: help, help COMMAND", plain[2], plain[3]));
  if (std::string_view(plain.back()) == "help") plain.resize(2);
  plain.erase(plain.begin() + 1);
  plain.push_back(help);
  return plain;
}

int perform(int count, char** given) {
  auto arguments = with_help_as_option({given, static_cast<std::size_t>(count)});
  auto const argc = static_cast<int>(arguments.size());
  arguments.push_back(nullptr);
  char** const argv = arguments.data();
  io::set_trial(try_in_child);
  CLI::App app("Lie-group time integration of spin fields", "cayspin");
  app.set_version_flag("--version", CAYSPIN_VERSION_STRING);
  app.require_subcommand(1);
  std::vector<Command> commands;
  for (auto* const add : all_commands) commands.push_back(add(app));
  auto const others = other_programs();
  for (auto const& other : others) app.add_subcommand(other.command, other.sentence);
  for (auto* command : app.get_subcommands({})) command->group(group_of(command->get_name()));

  std::string_view const first = argc > 1 ? argv[1] : "";
  auto const ranks = launched_ranks();
  try {
    ranks->together([&] {
      require_command(app, first);
      // relax() accepts several ranks for an ensemble.
      if (ranks->many() && first != "run" && first != "relax" && ranks->is_first())
        throw UsageError(
            fmt::format("{} runs on one rank; accepted: run, or relax of an ensemble", first));
    });
    start_others_alone();
    for (auto const& other : others)
      if (first == other.command) other.become(other.name, argv);
    if (auto const status = ranks->together([&] { return parse(app, argc, argv); })) return *status;
    for (auto const& command : commands)
      if (*command.parser) return command.perform(*ranks);
    return Status::done;
  } catch (...) {
    if (!ranks->many()) throw;
    // Reports before this rank ends, because launchers stop all other ranks as soon as one has
    // failed.
    int const status = report(std::current_exception());
    if (!ranks->agreed()) ranks->leave_by(status);
    return status;
  }
}

// Performs the command `run` in a worker. The other commands are left out, because describing them
// all takes a good part of the time of a short run.
int perform_run(int argc, char** argv) {
  CLI::App app("", "cayspin");
  auto const run = add_run(app);
  auto const ranks = launched_ranks();
  if (auto const status = parse(app, argc, argv)) return *status;
  return run.perform(*ranks);
}

int work(int, char** argv) {
  io::set_trial(try_in_child);
  return sweep::work(argv[2], argv[3], perform_run);
}

}  // namespace
}  // namespace cayspin::program

int main(int argc, char** argv) {
  using namespace cayspin::program;
  bool const is_worker = argc == 4 && std::string_view(argv[1]) == sweep::worker_word;
  return perform_and_report(is_worker ? work : perform, argc, argv);
}
