// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "reader.hpp"

#include <span>
#include <string_view>

namespace cayspin::inline v0_2::io::detail {

/// A unit that a table may name: { meV = number }.
struct Unit {
  std::string_view name;
  double in_si;
};

/// A typed value, and the SI value of its unit.
struct InUnit {
  Item value;
  double unit = 1;
};

constexpr std::string_view accepted_energy =
    "a number in J, { meV = number }, { eV = number } or { mRy = number }";
constexpr std::string_view accepted_moment = "a number in J/T, or { bohr_magnetons = number }";

/// Returns the value and the unit of a table such as { meV = number }; otherwise the item itself,
/// with the unit 1. `accepted`: for messages.
InUnit in_joules(Item const& item, Scene& scene, std::string_view accepted = accepted_energy);
InUnit in_joules_per_tesla(Item const& item, Scene& scene,
                           std::string_view accepted = accepted_moment);

/// Reads a number and returns it; or reads site-dependent numbers and returns 1. If the material
/// has mu_s, a number is an energy, which may have a unit.
double constant_of_sites(Item const& item, Scene& scene, SiteNumbers& numbers);

/// Returns in_joules(item) if the material has mu_s, otherwise the item itself.
InUnit in_joules_of_atoms(Item const& item, Scene& scene);

}  // namespace cayspin::inline v0_2::io::detail
