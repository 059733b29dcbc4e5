// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "sections.hpp"
#include "site_expression.hpp"
#include "start.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace cayspin::inline v0_1::io::detail {
namespace {

ExpressionStart read_expressions(Item const& item, Lattice const& lattice) {
  constexpr std::string_view accepted = "three strings, each an expression in x, y, z, i, j, k";
  ExpressionStart start;
  auto const three = entries(item, 3, 3, accepted);
  for (std::size_t component = 0; component < 3; ++component) {
    auto text = string(three[component], accepted);
    try {
      site_expression(text, lattice);
    } catch (std::invalid_argument const& error) {
      three[component].fail(error.what());
    }
    start.components[component] = std::move(text);
  }
  return start;
}

RandomStart read_random(Item const& item, Scene& scene) {
  constexpr std::string_view accepted = "a whole number >= 0";
  Table const table(item, scene);
  table.accept_only({"seed"});
  return {integer(table.required("seed", accepted), {accepted, 0})};
}

GivenStart read_given(Item const& item, Scene const& scene) {
  constexpr std::string_view accepted =
      "uniform, expression, random or file; a run of such a scene has its start in its file";
  if (!boolean(item)) item.fail("false has no meaning", "true, or another key");
  if (!scene.given.spins)
    item.fail("stands for spins that a program gives, and none did", accepted);
  return {scene.given.spins};
}

}  // namespace

Initial read_initial(Table const& root) {
  constexpr std::string_view accepted = "exactly one of uniform, expression, random, file";
  auto const table = root.table("initial", "a table [initial]");
  table.accept_only({"uniform", "expression", "random", "file", "given"});
  if (auto const count = table.item().node->as_table()->size(); count != 1) {
    table.item().fail(fmt::format("has {} keys", count), accepted);
  }
  if (auto const item = table.find("uniform")) return UniformStart{direction(*item)};
  if (auto const item = table.find("expression"))
    return read_expressions(*item, root.scene().lattice);
  if (auto const item = table.find("random")) return read_random(*item, root.scene());
  if (auto const item = table.find("given")) return read_given(*item, root.scene());
  return FileStart{input_file(table, "file", "the name of an HDF5 or OVF 2.0 file")};
}

}  // namespace cayspin::inline v0_1::io::detail
