// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "failure.hpp"
#include "message.hpp"
#include "text.hpp"

#include <CLI/CLI.hpp>
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>

// Code that the main functions of the programs share.
namespace cayspin::simulation {

/// Parses the command line. Returns an exit status if it only asked for help or the version. Throws
/// UsageError for an invalid command line.
inline std::optional<int> parse(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
  } catch (CLI::ParseError const& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    auto help = app.get_name() + " --help";
    for (auto const* command : app.get_subcommands({}))
      if (argc > 1 && command->get_name() == argv[1])
        help = app.get_name() + " help " + command->get_name();
    throw UsageError(fmt::format("{} (see {})", error.what(), help));
  }
  return std::nullopt;
}

/// Prints an error as one line on standard error, unless another rank reports it. The line starts
/// with "cayspin" for a UsageError and for a lack of memory. Returns the exit status.
inline int report(std::exception_ptr const& thrown) {
  auto const say = [](std::string const& message) {
    std::fflush(stdout);
    print_message("{}\n", one_line(message));
  };
  try {
    std::rethrow_exception(thrown);
  } catch (OtherRankFailed const&) {  // the other rank reports it
  } catch (UsageError const& error) {
    say(fmt::format("cayspin: {}", error.what()));
  } catch (std::bad_alloc const&) {
    say("cayspin: not enough memory");
  } catch (std::exception const& error) {
    say(error.what());
  }
  return status_of(thrown);
}

/// Throws std::runtime_error if not all of standard output could be written.
inline void require_output_written() {
  errno = 0;
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return;
  throw std::runtime_error(fmt::format("standard output: cannot write: {}",
                                       errno == 0 ? "some of it was lost" : std::strerror(errno)));
}

/// Opens /dev/null in place of each standard stream that is closed. Otherwise a file that is opened
/// later gets the number of the stream, and messages are written into the file. Reading and writing
/// still fail, and programs that are started find the stream closed.
inline void occupy_closed_streams() {
  for (int const stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(stream, F_GETFD) < 0 && errno == EBADF)
      ::open("/dev/null", (stream == STDIN_FILENO ? O_WRONLY : O_RDONLY) | O_CLOEXEC);
}

/// Calls perform(argc, argv) and returns the exit status. Reports the error if `perform` throws, or
/// if it returns 0 but standard output cannot be written.
inline int perform_and_report(int (*perform)(int, char**), int argc, char** argv) {
  occupy_closed_streams();
  try {
    int const status = perform(argc, argv);
    if (status == 0) require_output_written();
    return status;
  } catch (...) {
    return report(std::current_exception());
  }
}

}  // namespace cayspin::simulation
