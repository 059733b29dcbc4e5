// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "failure.hpp"
#include "text.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cstdio>
#include <optional>

// What the mains of the programs share.
namespace cayspin::simulation {

/// An exit status when the command line asked for no more than help. Throws UsageError.
inline std::optional<int> parse(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
  } catch (CLI::ParseError const& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    throw UsageError(fmt::format("{} (see cayspin --help)", error.what()));
  }
  return std::nullopt;
}

/// The exit status of perform(argc, argv). What it throws becomes one line on standard error:
/// messages about a file begin with its name, those about the command line with the program's.
inline int perform_and_report(int (*perform)(int, char**), int argc, char** argv) {
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

}  // namespace cayspin::simulation
