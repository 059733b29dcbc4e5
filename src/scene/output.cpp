// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace cayspin::inline v0_1::io::detail {
namespace {

CheckpointPeriod checkpoint_period(Item const& item) {
  constexpr std::string_view accepted =
      "seconds of the run's own time >= 0, where 0 is never, or \"N steps\"";
  if (!item.node->is_string()) {
    double const seconds = number(item, accepted);
    if (seconds < 0) item.fail(fmt::format("{} is negative", seconds), accepted);
    return {seconds, 0};
  }
  auto const text = string(item, accepted);
  std::int64_t steps = 0;
  auto const [end, error] = std::from_chars(text.data(), text.data() + text.size(), steps);
  if (error != std::errc{} || std::string_view(end, text.data() + text.size()) != " steps" ||
      steps < 1)
    item.fail(fmt::format("\"{}\" is no number of steps", one_line(text)), accepted);
  return {0, steps};
}

}  // namespace

Output read_output(Table const& root, std::int64_t steps) {
  Output output;
  output.every = output.scalars_every = std::max<std::int64_t>(steps, 1);
  auto const found = root.find("output");
  if (!found) return output;
  Table const table(*found, root.scene());
  table.accept_only(with_flags<Output>(
      {"file", "every", "scalars_every", "compression", "chunk", "checkpoint_every"}));
  constexpr std::string_view accepted = "the name of an HDF5 file";
  constexpr std::string_view period = "a whole number of steps >= 1";
  if (auto const item = table.find("file")) {
    auto const file = string(*item, accepted);
    if (file.empty()) item->fail("the file name is empty", accepted);
    output.file = file;
  }
  if (auto const item = table.find("every")) {
    output.every = output.scalars_every = integer(*item, 1, period);
  }
  if (auto const item = table.find("scalars_every")) {
    output.scalars_every = integer(*item, 1, period);
  }
  if (auto const item = table.find("compression")) {
    constexpr std::string_view levels = "a level from 0 (none) to 9";
    auto const level = integer(*item, 0, levels);
    if (level > 9) item->fail(fmt::format("{} is too large", level), levels);
    output.compression = static_cast<int>(level);
  }
  if (auto const item = table.find("chunk")) {
    output.chunk = integer(*item, 1, "a whole number of planes along z >= 1");
  }
  if (auto const item = table.find("checkpoint_every"))
    output.checkpoint_every = checkpoint_period(*item);
  read_flags(table, output);
  return output;
}

}  // namespace cayspin::inline v0_1::io::detail
