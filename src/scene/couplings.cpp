// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "bond_key.hpp"
#include "io/counted.hpp"
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
#include <utility>

namespace cayspin::inline v0_2::io::detail {
namespace {

constexpr auto any = std::numeric_limits<std::size_t>::max();
constexpr std::string_view accepted_couplings =
    "an array of tables { between, offset, J, D, tensor, biquadratic }, { shells = [J, ..], pairs = "
    "[those tables], both_directions = true or false } or { file = \"NAME.ucf\" }";

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

// Refuses a coupling whose bonds leave the lattice from every cell. (If they leave it only from
// some cells, these cells have no such bond.)
void refuse_beyond(Item const& item, Lattice const& lattice, std::array<int, 3> const& offset) {
  auto cells = lattice.shape;
  cells[2] /= static_cast<std::int64_t>(lattice.basis.size());
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (lattice.boundary[axis] == BoundaryKind::open && std::abs(offset[axis]) >= cells[axis])
      item.fail(fmt::format("leaves the lattice from every cell: the offset along {0} is {1}, and "
                            "the lattice has {2} along {0}",
                            "xyz"[axis], offset[axis], counted(cells[axis], "cell")),
                "a shorter offset, a larger shape, or boundary \"periodic\"");
}

Coupling read_coupling(Item const& item, Scene& scene) {
  Table const table(item, scene);
  table.accept_only({"between", "offset", "J", "D", "tensor", "biquadratic"});
  auto const sites = scene.lattice.basis.size();
  std::array<int, 2> between{};
  std::array<int, 3> offset{};
  if (auto const two = table.find("between")) {
    auto const accepted = sites == 1 ? "[0, 0], as the cell has one site"
                                     : fmt::format("two sites of the cell, 0 to {}", sites - 1);
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
      if (other) other->fail("stands beside a tensor, which already contains it", "no such key");
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

BondKey key_of(Coupling const& bond) { return {bond.between, bond.offset}; }

Coupling reversed_bond(Coupling const& bond) {
  Coupling back = bond;
  std::tie(back.between, back.offset) = reversed(key_of(bond));
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) back.tensor[3 * i + j] = bond.tensor[3 * j + i];
  return back;
}

void refuse_twice(std::vector<Item> const& items, std::vector<Coupling> const& couplings) {
  std::map<BondKey, std::size_t> seen;
  for (std::size_t i = 0; i < couplings.size(); ++i) {
    auto const refuse = [&](auto const& other, std::string_view how) {
      if (other != seen.end())
        items[i].fail(fmt::format("is the same bond as {}{}", items[other->second].key, how),
                      "each bond once, or from both ends with { pairs = [..], both_directions = "
                      "true }");
    };
    refuse(seen.find(key_of(couplings[i])), "");
    refuse(seen.find(reversed(key_of(couplings[i]))), ", from its other end");
    seen.emplace(key_of(couplings[i]), i);
  }
}

bool are_close(Coupling const& a, Coupling const& b) {
  double largest = std::max(std::abs(a.biquadratic), std::abs(b.biquadratic));
  double difference = std::abs(a.biquadratic - b.biquadratic);
  for (std::size_t i = 0; i < 9; ++i) {
    largest = std::max({largest, std::abs(a.tensor[i]), std::abs(b.tensor[i])});
    difference = std::max(difference, std::abs(a.tensor[i] - b.tensor[i]));
  }
  return difference <= 1e-6 * largest;
}

// Returns each bond once. Refuses bonds that are not written from both ends with values that agree.
std::vector<Coupling> one_direction(std::vector<Item> const& items,
                                    std::vector<Coupling> const& couplings) {
  constexpr std::string_view accepted = "each bond from both ends, with J, and with -D there";
  std::map<BondKey, std::size_t> seen;
  for (std::size_t i = 0; i < couplings.size(); ++i)
    if (auto const [at, is_new] = seen.emplace(key_of(couplings[i]), i); !is_new)
      items[i].fail(fmt::format("is the same bond as {}", items[at->second].key), accepted);
  std::vector<Coupling> once;
  for (std::size_t i = 0; i < couplings.size(); ++i) {
    auto const back = seen.find(reversed(key_of(couplings[i])));
    if (back == seen.end()) items[i].fail("is not written from its other end", accepted);
    if (!are_close(reversed_bond(couplings[i]), couplings[back->second]))
      items[i].fail(fmt::format("differs from {}, its other end", items[back->second].key),
                    accepted);
    if (i < back->second) once.push_back(couplings[i]);
  }
  return once;
}

std::vector<Coupling> read_pairs(Item const& item, Scene& scene, bool both_directions) {
  auto const all = entries(item, 1, any, accepted_couplings);
  std::vector<Coupling> bonds;
  for (auto const& entry : all) bonds.push_back(read_coupling(entry, scene));
  if (both_directions) return one_direction(all, bonds);
  refuse_twice(all, bonds);
  return bonds;
}

// Adds the bonds of `more` to `bonds`. If a bond is in both, its values are summed.
void add_bonds(std::vector<Coupling> const& more, std::vector<Coupling>& bonds) {
  std::map<BondKey, std::size_t> seen;
  for (std::size_t i = 0; i < bonds.size(); ++i) seen.emplace(key_of(bonds[i]), i);
  for (auto const& one : more) {
    auto at = seen.find(key_of(one));
    auto const back = at == seen.end() ? seen.find(reversed(key_of(one))) : at;
    if (back == seen.end()) {
      bonds.push_back(one);
      continue;
    }
    auto const added = at == seen.end() ? reversed_bond(one) : one;
    auto& bond = bonds[back->second];
    for (std::size_t i = 0; i < 9; ++i) bond.tensor[i] += added.tensor[i];
    bond.biquadratic += added.biquadratic;
  }
}

// Returns the crystal with its vectors as lengths, in the unit of the spacing. In Lattice::cell
// they are multiples of the spacing.
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
  // Along an axis with one cell, there are no neighbours.
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
    field.couplings = read_pairs(item, scene, false);
    return;
  }
  if (!item.node->is_table()) item.wrong_type(accepted_couplings);
  Table const table(item, scene);
  table.accept_only({"shells", "pairs", "both_directions", "file", "scale"});
  auto const shells = table.find("shells"), pairs = table.find("pairs"),
             both = table.find("both_directions"), scale = table.find("scale");
  bool const has_file = table.contains("file");
  if ((shells || pairs) && has_file) item.fail("has a file and other bonds", accepted_couplings);
  if (!shells && !pairs && !has_file) item.fail("has no bonds", accepted_couplings);
  if (both && !pairs) both->fail("belongs to pairs", "no such key");
  if (scale && !has_file) scale->fail("belongs to a file", "no such key");
  if (scale) field.couplings_scale = number(*scale), field.has_couplings_scale = true;
  if (has_file) field.couplings_file = input_file(table, "file", accepted_unit_cell_file);
  if (shells) field.couplings = read_shells(*shells, scene);
  if (pairs) add_bonds(read_pairs(*pairs, scene, both && boolean(*both)), field.couplings);
}

}  // namespace cayspin::inline v0_2::io::detail

namespace cayspin::inline v0_2::io {

std::vector<Coupling> couplings(Scene const& scene) {
  auto const& field = scene.field;
  if (field.couplings_file.empty()) return field.couplings;
  return detail::for_key(scene, "field.couplings.file", [&] {
    return detail::read_unit_cell_couplings(field.couplings_file, crystal(scene.lattice),
                                            field.couplings_scale, field.has_couplings_scale);
  });
}

}  // namespace cayspin::inline v0_2::io
