// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/sweep.hpp"
#include "program/command.hpp"

#include <string>
#include <vector>

namespace cayspin::program::sweep {

struct SweepOptions : SceneOptions {
  std::vector<std::string> over;  // key.path=VALUE,VALUE,...
  std::filesystem::path output;
  Precision precision = Precision::double_precision;
  std::optional<std::string> space;
  std::optional<int> jobs, threads;  // concurrent runs; threads of each
  bool overwrite = false, quiet = false;
};

/// A sweep whose scenes have all been checked.
struct Grid {
  io::SweepHeader header;
  std::vector<std::string> texts;  // text of each run's scene
  std::vector<double> costs;       // steps * sites of each run
  std::int64_t largest = 0;        // memory of the largest run, in bytes
};

/// Reads and checks the scene of every run. Throws UsageError for wrong options. Throws
/// io::SceneError for a wrong scene; if there are several runs, the message names its combination
/// of values.
Grid make_grid(SweepOptions const& options);

/// Returns, for example, "system.damping=0.1 integrator.dt=0.02".
std::string values_text(io::SweepHeader const& header, std::int64_t run);

}  // namespace cayspin::program::sweep
