// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace cayspin::inline v0_2::io::detail {
namespace {

CheckpointPeriod checkpoint_period(Item const& item) {
  constexpr std::string_view accepted =
      "seconds of wall-clock time >= 0, where 0 means never, or \"N steps\" with N >= 1";
  if (!item.node->is_string()) return {number(item, {accepted, 0}), 0};
  auto const text = string(item, accepted);
  std::int64_t steps = 0;
  auto const [end, error] = std::from_chars(text.data(), text.data() + text.size(), steps);
  if (error != std::errc{} || std::string_view(end, text.data() + text.size()) != " steps" ||
      steps < 1)
    item.fail(fmt::format("\"{}\" is no number of steps", one_line(text)), accepted);
  return {0, steps};
}

// Reads the interval between frames or samples, and returns it in steps. Without [integrator] there
// are no steps, and any time counts as one step.
std::int64_t period(Item const& item, Table const& root, Integrator const& integrator) {
  constexpr std::string_view accepted =
      "a whole number of steps >= 1, or { time = TIME }, a multiple of dt";
  if (!item.node->is_table()) return integer(item, {accepted, 1});
  Table const table(item, root.scene());
  table.accept_only({"time"});
  auto const time = table.required("time", "a time > 0");
  if (!(integrator.dt > 0)) time.fail("needs integrator.dt", "a whole number of steps");
  constexpr Limits not_negative{"a time > 0", 0};
  auto const steps = root.contains("integrator") ? whole_steps(time, integrator.dt)
                                                 : std::int64_t{number(time, not_negative) > 0};
  if (steps < 1) time.fail("is 0", "a time > 0");
  return steps;
}

}  // namespace

Output read_output(Table const& root, Integrator const& integrator) {
  Output output;
  output.every = output.scalars_every = std::max<std::int64_t>(integrator.steps, 1);
  auto const found = root.find("output");
  if (!found) return output;
  Table const table(*found, root.scene());
  table.accept_only(names_of_keys<Output>());
  read_keys(table, output);
  if (auto const item = table.find("every")) output.every = period(*item, root, integrator);
  auto const item = table.find("scalars_every");
  output.scalars_every = item ? period(*item, root, integrator) : output.every;
  if (auto const item = table.find("file")) {
    constexpr std::string_view accepted = "the name of an HDF5 file";
    output.file = string(*item, accepted);
    if (output.file->empty()) item->fail("the file name is empty", accepted);
  }
  if (output.regions && !root.scene().lattice.regions.there())
    table.find("regions")->fail(
        "stands without lattice.regions, which says the region of each site",
        "lattice.regions beside it");
  if (auto const item = table.find("checkpoint_every"))
    output.checkpoint_every = checkpoint_period(*item);
  return output;
}

}  // namespace cayspin::inline v0_2::io::detail
