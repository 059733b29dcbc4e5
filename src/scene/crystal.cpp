// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception

#include "io/counted.hpp"
#include "sections.hpp"
#include "unit_cell_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>

namespace cayspin::inline v0_2::io::detail {
namespace {

constexpr Word<Crystal (*)()> crystals[] = {
    {"bcc", Crystal::bcc},       {"fcc", Crystal::fcc},
    {"hcp", Crystal::hcp},       {"honeycomb", Crystal::honeycomb},
    {"kagome", Crystal::kagome}, {"pyrochlore", Crystal::pyrochlore}};

// Returns the cell of the scene's unit-cell file; nothing if the scene names no such file.
std::optional<Crystal> crystal_of_couplings(Table const& root) {
  auto const field = root.find("field");
  if (!field || !field->node->is_table()) return std::nullopt;
  auto const couplings = Table(*field, root.scene()).find("couplings");
  if (!couplings || !couplings->node->is_table()) return std::nullopt;
  Table const table(*couplings, root.scene());
  auto const file = table.find("file");
  if (!file) return std::nullopt;
  auto const path = input_file(table, "file", accepted_unit_cell_file);
  try {
    return read_unit_cell(path);
  } catch (std::runtime_error const& error) {
    file->fail(error.what());
  }
}

void read_cell(Item const& item, Lattice& lattice) {
  constexpr std::string_view accepted = "three vectors of three numbers that span a volume";
  lattice.cell = three(item, accepted, triple);
  if (!(crystal(lattice).fullness() > 1e-12)) item.fail("the vectors span no volume", accepted);
}

void read_basis(Item const& item, Lattice& lattice) {
  constexpr std::string_view accepted =
      "an array of sites, three fractions of the cell's vectors each";
  lattice.basis.clear();
  auto const sites = entries(item, 1, most_sites, accepted);
  for (auto const& entry : sites) lattice.basis.push_back(triple(entry));
  if (auto const two = crystal(lattice).sites_at_one_place())
    sites[(*two)[1]].fail(fmt::format("is at the same place as site {}", (*two)[0]),
                          "sites at places of their own");
}

std::vector<double> read_numbers_of_sites(Item const& item, std::size_t sites,
                                          Limits const& limits) {
  if (!item.node->is_array()) return std::vector<double>(sites, number(item, limits));
  std::vector<double> numbers;
  constexpr std::string_view one = "a number";
  auto const accepted = fmt::format("{}{}, one for each site of the cell",
                                    counted(static_cast<std::int64_t>(sites), "number"),
                                    limits.accepted.substr(one.size()));
  for (auto const& entry : entries(item, sites, sites, accepted))
    numbers.push_back(number(entry, limits));
  return numbers;
}

}  // namespace

void read_crystal(Table const& root, Table const& table, Lattice& lattice) {
  auto const use = [&](Crystal const& crystal) {
    lattice.cell = crystal.cell;
    lattice.basis = crystal.basis;
  };
  if (auto const item = table.find("crystal")) {
    for (auto const* const name : {"cell", "basis"})
      if (auto const other = table.find(name))
        other->fail("stands beside lattice.crystal, which already sets it", "no such key");
    use(word_among<Crystal (*)()>(crystals, *item)());
  }
  if (!table.contains("crystal") && !table.contains("cell") && !table.contains("basis"))
    if (auto const found = crystal_of_couplings(root)) use(*found);
  if (auto const item = table.find("cell")) read_cell(*item, lattice);
  if (auto const item = table.find("basis")) read_basis(*item, lattice);
  auto const sites = lattice.basis.size();
  if (auto const item = table.find("moments"); item && !are_numbers_of_sites(*item))
    lattice.moments = read_numbers_of_sites(*item, sites, not_negative);
  if (auto const item = table.find("gyromagnetic"); item && !are_numbers_of_sites(*item))
    lattice.gyromagnetic = read_numbers_of_sites(*item, sites, positive);
}

bool is_crystal(Lattice const& lattice) {
  return lattice.basis.size() > 1 || lattice.cell != Lattice{}.cell;
}

void check_crystal(Scene const& scene) {
  auto const& lattice = scene.lattice;
  auto const& field = scene.field;
  if (!is_crystal(lattice)) return;
  auto const refuse_if = [&](bool there, std::string_view key, std::string_view accepted) {
    if (!there) return;
    auto const needs =
        lattice.basis.size() > 1
            ? "needs one site in a cell"
            : "needs a cell with edges along x, y and z of the lengths lattice.spacing";
    detail::refuse(scene, key, needs, accepted);
  };
  bool const si = scene.units.si;
  refuse_if(field.exchange.has_value(), si ? "material.J" : "field.exchange",
            "field.couplings with J");
  refuse_if(!field.interlayers.empty(), "field.interlayer", "field.couplings");
  refuse_if(field.has_dmi(),
            !si              ? "field.dmi"
            : field.dmi      ? "material.D"
            : field.bulk_dmi ? "material.D_bulk"
                             : "material.D2d",
            "field.couplings with D");
  refuse_if(field.torque.zhang_li.has_value(), "torque.zhang_li", "slonczewski, or no such key");
}

}  // namespace cayspin::inline v0_2::io::detail

namespace cayspin::inline v0_2::io {

Crystal crystal(Lattice const& lattice) { return {lattice.cell, lattice.basis}; }

}  // namespace cayspin::inline v0_2::io
