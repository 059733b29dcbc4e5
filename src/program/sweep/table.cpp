// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "table.hpp"

#include "simulation/failure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace cayspin::program::sweep {
namespace {

using Row = std::vector<std::string>;

std::string status_text(io::SweptRun const& run) {
  switch (run.status) {
    case simulation::Status::done:
      return "done";
    case simulation::Status::numbers_failed:
      return "failed";
    case io::SweptRun::not_run:
      return "open";
    default:
      return fmt::format("status {}", run.status);
  }
}

// Some baseline methods do not keep spins on the unit sphere. Their components may become so large
// that six digits after the point are too many.
std::string component_text(double m) {
  return std::abs(m) < 10 ? fmt::format("{:.6f}", m) : fmt::format("{:.3g}", m);
}

Row row_of(io::SweepInfo const& sweep, std::int64_t number) {
  auto const& header = sweep.header;
  auto const& run = sweep.runs[static_cast<std::size_t>(number)];
  Row row{io::swept_run_name(number)};
  auto const chosen = header.indices(number);
  for (std::size_t key = 0; key < chosen.size(); ++key)
    row.push_back(header.keys[key].values[chosen[key]]);
  row.push_back(status_text(run));
  if (!run.has_file) return row;
  auto const& [energy, norm_defect, m] = run.scalars;
  for (auto const& text :
       {fmt::format("{}", run.step), fmt::format("{:.9g}", run.time), fmt::format("{:.9g}", energy),
        component_text(m[0]), component_text(m[1]), component_text(m[2]),
        fmt::format("{:.3g}", norm_defect), fmt::format("{:.3g}", run.cost.wall_seconds)})
    row.push_back(text);
  return row;
}

}  // namespace

void print_table(io::SweepInfo const& sweep) {
  Row head{"run"};
  for (auto const& key : sweep.header.keys) head.push_back(key.key);
  for (char const* name :
       {"status", "step", "time", "energy", "mx", "my", "mz", "norm_defect", "seconds"})
    head.emplace_back(name);
  std::vector<Row> rows{head};
  for (std::int64_t run = 0; run < sweep.header.runs(); ++run) rows.push_back(row_of(sweep, run));
  std::vector<std::size_t> widths(head.size());
  for (auto const& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  for (auto const& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i)
      line += fmt::format("{}{:<{}}", i == 0 ? "" : "  ", row[i], widths[i]);
    line.erase(line.find_last_not_of(' ') + 1);
    fmt::print("{}\n", line);
  }
}

}  // namespace cayspin::program::sweep
