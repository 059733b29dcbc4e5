// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "quantity.hpp"
#include "sections.hpp"
#include "unit_cell_file.hpp"

#include <cayspin/shells.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <map>
#include <stdexcept>
#include <tuple>

namespace cayspin::inline v0_1::io::detail {
namespace {

constexpr auto any = std::numeric_limits<std::size_t>::max();
constexpr std::string_view accepted_couplings =
    "an array of tables { between, offset, J, D, tensor, biquadratic }, { shells = [J, ..] } or "
    "{ file = \"NAME.ucf\" }";

int small_integer(Item const& item, double least, std::string_view accepted) {
  auto const value = integer(item, {accepted, least});
  if (value < -1'000'000 || value > 1'000'000)
    item.fail(fmt::format("{} is too large", value), accepted);
  return static_cast<int>(value);
}

double read_strength(Item const& item, Scene& scene) {
  auto const [value, unit] = in_joules_of_atoms(item, scene);
  return number(value) * unit;
}

Triple read_vector(Item const& item, Scene& scene) {
  auto const [value, unit] = in_joules_of_atoms(item, scene);
  auto vector = triple(value);
  for (double& component : vector) component *= unit;
  return vector;
}

std::array<double, 9> read_tensor(Item const& item, Scene& scene) {
  constexpr std::string_view accepted = "three rows of three numbers";
  auto const [value, unit] = in_joules_of_atoms(item, scene);
  auto const row = [&](Item const& each) {
    return three(each, accepted, [](Item const& entry) { return number(entry); });
  };
  std::array<double, 9> tensor;
  auto at = tensor.begin();
  for (auto const& numbers : three(value, accepted, row))
    for (double const entry : numbers) *at++ = entry * unit;
  return tensor;
}

// Bonds past an open end are none: here all of them.
void refuse_beyond(Item const& item, Lattice const& lattice, std::array<int, 3> const& offset) {
  auto cells = lattice.shape;
  cells[2] /= static_cast<std::int64_t>(lattice.basis.size());
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (lattice.boundary[axis] == BoundaryKind::open && std::abs(offset[axis]) >= cells[axis])
      item.fail(fmt::format("leaves the lattice from every cell: the offset along {} is {}, and "
                            "there are {} cells",
                            "xyz"[axis], offset[axis], cells[axis]),
                "a shorter offset, a larger shape, or boundary \"periodic\"");
}

Coupling read_coupling(Item const& item, Scene& scene) {
  Table const table(item, scene);
  table.accept_only({"between", "offset", "J", "D", "tensor", "biquadratic"});
  auto const sites = scene.lattice.basis.size();
  std::array<int, 2> between{};
  std::array<int, 3> offset{};
  if (auto const two = table.find("between")) {
    auto const accepted = fmt::format("two sites of the cell, 0 to {}", sites - 1);
    auto const both = entries(*two, 2, 2, accepted);
    for (std::size_t end = 0; end < 2; ++end) {
      between[end] = small_integer(both[end], 0, accepted);
      if (static_cast<std::size_t>(between[end]) >= sites)
        both[end].fail(fmt::format("the cell has no site {}", between[end]), accepted);
    }
  }
  if (auto const cells = table.find("offset")) {
    constexpr std::string_view accepted = "three whole numbers of cells";
    offset = three(*cells, accepted,
                   [&](Item const& each) { return small_integer(each, Limits().least, accepted); });
  }
  if (between[0] == between[1] && offset == std::array<int, 3>{})
    item.fail("couples a site to itself", "another site, or an offset");
  refuse_beyond(item, scene.lattice, offset);
  Coupling made{between, offset};
  auto const tensor = table.find("tensor"), J = table.find("J"), D = table.find("D"),
             biquadratic = table.find("biquadratic");
  if (tensor) {
    for (auto const& other : {J, D})
      if (other) other->fail("stands beside a tensor, which says it", "no such key");
    made.tensor = read_tensor(*tensor, scene);
  } else if (J || D) {
    made = Coupling::of(between, offset, J ? read_strength(*J, scene) : 0,
                        D ? read_vector(*D, scene) : Triple{});
  } else if (!biquadratic) {
    item.fail("has no strength", "J, D, tensor or biquadratic");
  }
  if (biquadratic) made.biquadratic = read_strength(*biquadratic, scene);
  return made;
}

void refuse_twice(std::vector<Item> const& items, std::vector<Coupling> const& couplings) {
  std::map<std::tuple<std::array<int, 2>, std::array<int, 3>>, std::size_t> seen;
  for (std::size_t i = 0; i < couplings.size(); ++i) {
    auto const& [between, offset, tensor, biquadratic] = couplings[i];
    std::array<int, 3> const back{-offset[0], -offset[1], -offset[2]};
    auto const refuse = [&](auto const& other, std::string_view how) {
      if (other != seen.end())
        items[i].fail(fmt::format("is the bond of field.couplings[{}]{}", other->second, how),
                      "each bond once");
    };
    refuse(seen.find({between, offset}), "");
    refuse(seen.find({{between[1], between[0]}, back}), ", reversed");
    seen.emplace(std::tuple(between, offset), i);
  }
}

// The cell's vectors are in units of the spacing.
Crystal with_spacing(Lattice const& lattice) {
  auto made = crystal(lattice);
  for (auto& vector : made.cell)
    for (std::size_t axis = 0; axis < 3; ++axis) vector[axis] *= lattice.spacing[axis];
  return made;
}

std::vector<Coupling> read_shells(Item const& item, Scene& scene) {
  constexpr std::string_view accepted = "the J of pairs at the first, second, .. distance";
  auto const& lattice = scene.lattice;
  auto const [value, unit] = in_joules_of_atoms(item, scene);
  std::vector<double> exchange;
  for (auto const& entry : entries(value, 1, 100, accepted))
    exchange.push_back(number(entry) * unit);
  auto const sites = static_cast<std::int64_t>(lattice.basis.size());
  // An axis of one cell has no neighbours.
  std::array const repeats{lattice.shape[0] > 1, lattice.shape[1] > 1, lattice.shape[2] > sites};
  try {
    return couplings_of_shells(with_spacing(lattice), exchange, repeats);
  } catch (std::invalid_argument const& error) {
    item.fail(error.what(), accepted);
  }
}

}  // namespace

void read_couplings(Item const& item, Scene& scene, Field& field) {
  if (item.node->is_array()) {
    auto const all = entries(item, 1, any, accepted_couplings);
    for (auto const& entry : all) field.couplings.push_back(read_coupling(entry, scene));
    refuse_twice(all, field.couplings);
    return;
  }
  if (!item.node->is_table()) item.wrong_type(accepted_couplings);
  Table const table(item, scene);
  table.accept_only({"shells", "file", "scale"});
  auto const shells = table.find("shells");
  if (shells.has_value() == table.contains("file"))
    item.fail(shells ? "has shells and a file" : "has no bonds", accepted_couplings);
  if (auto const scale = table.find("scale")) {
    if (shells) scale->fail("belongs to a file", "no such key");
    field.couplings_scale = number(*scale);
  }
  if (shells)
    field.couplings = read_shells(*shells, scene);
  else
    field.couplings_file = input_file(table, "file", accepted_unit_cell_file);
}

}  // namespace cayspin::inline v0_1::io::detail

namespace cayspin::inline v0_1::io {

std::vector<Coupling> couplings(Scene const& scene) {
  auto const& field = scene.field;
  if (field.couplings_file.empty()) return field.couplings;
  return detail::for_key(scene, "field.couplings.file", [&] {
    return detail::read_unit_cell_couplings(field.couplings_file, crystal(scene.lattice),
                                            field.couplings_scale);
  });
}

}  // namespace cayspin::inline v0_1::io
