// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "initial_state.hpp"

#include <cayspin/crystal.hpp>

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace cayspin::inline v0_2::io::detail {
namespace {

constexpr double cells_of_core = 3, cells_of_wall = 3;
constexpr double smallest_angle = 1e-6;  // as a sine; smaller angles count as 0

// Refuses unknown keys, and keys of other states or of other kinds of start.
void accept_only_keys_of(std::string_view state, Table const& table,
                         std::vector<std::string_view> keys) {
  keys.insert(keys.begin(), "state");
  for (auto const* const key :
       {"uniform", "expression", "random", "file", "circulation", "polarity", "radius", "center",
        "width", "chirality", "axis", "directions", "wall", "position", "period", "direction",
        "normal", "phase"}) {
    if (std::ranges::find(keys, key) != keys.end()) continue;
    if (auto const item = table.find(key))
      item->fail(fmt::format("does not go with state = \"{}\"", state),
                 fmt::format("{}", fmt::join(keys, ", ")));
  }
  table.accept_only(keys);
}

void read_sign(Table const& table, std::string_view key, std::int64_t& sign) {
  constexpr std::string_view accepted = "1 or -1";
  auto const item = table.find(key);
  if (!item) return;
  sign = integer(*item, {accepted});
  if (sign != 1 && sign != -1) item->fail(fmt::format("is {}", sign), accepted);
}

void read_length(Table const& table, std::string_view key, double& length) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (auto const item = table.find(key))
    length = number(*item, {"a length > 0", 0, infinity, true});
}

double fraction(Item const& item) {
  constexpr std::string_view accepted = "a number from 0 to 1";
  double const value = number(item, {accepted});
  if (value < 0 || value > 1) item.fail(fmt::format("{} is outside the lattice", value), accepted);
  return value;
}

void read_center(Table const& table, std::array<double, 2>& center) {
  auto const item = table.find("center");
  if (!item) return;
  auto const each = entries(*item, 2, 2, "two numbers from 0 to 1");
  center = {fraction(each[0]), fraction(each[1])};
}

InitialState read_vortex(Table const& table) {
  accept_only_keys_of("vortex", table, {"circulation", "polarity", "radius", "center"});
  auto const& spacing = table.scene().lattice.spacing;
  VortexState vortex{.radius = cells_of_core * std::max(spacing[0], spacing[1])};
  read_sign(table, "circulation", vortex.circulation);
  read_sign(table, "polarity", vortex.polarity);
  read_length(table, "radius", vortex.radius);
  read_center(table, vortex.center);
  return vortex;
}

// Returns the length of the lattice along x or y, whichever is shorter.
double shorter_edge(Lattice const& lattice) {
  std::array<double, 2> edges{};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    for (std::size_t c = 0; c < 3; ++c)
      edges[axis] += std::pow(lattice.cell[axis][c] * lattice.spacing[c], 2);
    edges[axis] = static_cast<double>(lattice.shape[axis]) * std::sqrt(edges[axis]);
  }
  return std::min(edges[0], edges[1]);
}

template <bool bloch>
InitialState read_skyrmion(Table const& table) {
  accept_only_keys_of(bloch ? "bloch_skyrmion" : "neel_skyrmion", table,
                      {"polarity", "chirality", "radius", "width", "center"});
  SkyrmionState skyrmion{.bloch = bloch, .radius = shorter_edge(table.scene().lattice) / 4};
  read_sign(table, "polarity", skyrmion.polarity);
  read_sign(table, "chirality", skyrmion.chirality);
  read_length(table, "radius", skyrmion.radius);
  skyrmion.width = skyrmion.radius / 2;
  read_length(table, "width", skyrmion.width);
  read_center(table, skyrmion.center);
  return skyrmion;
}

double sine_of_angle(Triple const& a, Triple const& b) {
  auto const product = cayspin::detail::vector_product(a, b);
  return std::sqrt(cayspin::detail::scalar_product(product, product));
}

void read_wall(Table const& table, TwoDomainsState& domains) {
  auto const& [a, b] = domains.directions;
  bool const are_parallel = sine_of_angle(a, b) < smallest_angle;
  constexpr std::string_view accepted = "a direction across those of the domains";
  if (auto const item = table.find("wall")) {
    domains.wall = direction(*item);
    if (are_parallel && sine_of_angle(a, domains.wall) < smallest_angle)
      item->fail("is along both domains", accepted);
  } else if (are_parallel && cayspin::detail::scalar_product(a, b) < 0) {
    detail::fail(table.item().place, "initial.wall",
                 "is missing: between opposite directions spins may turn any way", accepted);
  } else {
    domains.wall = *normalise({a[0] + b[0], a[1] + b[1], a[2] + b[2]});
  }
}

InitialState read_two_domains(Table const& table) {
  accept_only_keys_of("two_domains", table, {"axis", "directions", "wall", "position", "width"});
  constexpr Word<std::size_t> axes[] = {{"x", 0}, {"y", 1}, {"z", 2}};
  TwoDomainsState domains;
  if (auto const item = table.find("axis")) domains.axis = word_among<std::size_t>(axes, *item);
  constexpr std::string_view accepted = "two vectors";
  auto const each = entries(table.required("directions", accepted), 2, 2, accepted);
  domains.directions = {direction(each[0]), direction(each[1])};
  read_wall(table, domains);
  if (auto const item = table.find("position")) domains.position = fraction(*item);
  domains.width = cells_of_wall * table.scene().lattice.spacing[domains.axis];
  read_length(table, "width", domains.width);
  return domains;
}

InitialState read_helix(Table const& table) {
  accept_only_keys_of("helix", table, {"period", "direction", "normal", "phase"});
  HelixState helix;
  table.required("period", "a length > 0");
  read_length(table, "period", helix.period);
  if (auto const item = table.find("direction")) helix.direction = direction(*item);
  helix.normal = helix.direction;
  if (auto const item = table.find("normal")) helix.normal = direction(*item);
  if (auto const item = table.find("phase")) helix.phase = number(*item, {"a number of radians"});
  return helix;
}

}  // namespace

InitialState read_initial_state(Table const& table, Item const& state) {
  using Read = InitialState (*)(Table const&);
  constexpr Word<Read> states[] = {{"vortex", read_vortex},
                                   {"neel_skyrmion", read_skyrmion<false>},
                                   {"bloch_skyrmion", read_skyrmion<true>},
                                   {"two_domains", read_two_domains},
                                   {"helix", read_helix}};
  return word_among<Read>(states, state)(table);
}

}  // namespace cayspin::inline v0_2::io::detail
