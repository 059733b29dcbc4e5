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
  if (!item.node->is_string()) return {number(item, {accepted, 0}), 0};
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
  table.accept_only(names_of_keys<Output>());
  read_keys(table, output);
  if (!table.contains("scalars_every")) output.scalars_every = output.every;
  if (auto const item = table.find("file")) {
    constexpr std::string_view accepted = "the name of an HDF5 file";
    output.file = string(*item, accepted);
    if (output.file->empty()) item->fail("the file name is empty", accepted);
  }
  if (auto const item = table.find("checkpoint_every"))
    output.checkpoint_every = checkpoint_period(*item);
  return output;
}

}  // namespace cayspin::inline v0_1::io::detail
