// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "quantity.hpp"

#include <cayspin/units.hpp>

namespace cayspin::inline v0_2::io::detail {
namespace {

constexpr Unit energies[] = {{"meV", 1e-3 * units::electronvolt},
                             {"eV", units::electronvolt},
                             {"mRy", 1e-3 * units::rydberg}};
constexpr Unit moments[] = {{"bohr_magnetons", units::bohr_magneton}};

InUnit in_unit(Item const& item, Scene& scene, std::span<Unit const> units,
               std::string_view accepted) {
  if (!item.node->is_table()) return {item};
  Table const table(item, scene);
  std::vector<std::string_view> names;
  for (auto const& unit : units) names.push_back(unit.name);
  table.accept_only(names);
  if (item.node->as_table()->size() == 1)
    for (auto const& unit : units)
      if (auto const typed = table.find(unit.name)) return {*typed, unit.in_si};
  item.fail("is not one number with its unit", accepted);
}

}  // namespace

InUnit in_joules(Item const& item, Scene& scene, std::string_view accepted) {
  return in_unit(item, scene, energies, accepted);
}

InUnit in_joules_per_tesla(Item const& item, Scene& scene, std::string_view accepted) {
  return in_unit(item, scene, moments, accepted);
}

double constant_of_sites(Item const& item, Scene& scene, SiteNumbers& numbers) {
  if (!scene.material || !scene.material->atomistic) return number_of_sites(item, scene, numbers);
  auto const accepted =
      fmt::format("{}, {}", accepted_energy, accepted_site_numbers(scene.lattice));
  if (are_numbers_of_sites(item) && read_site_numbers(item, scene, numbers)) return 1;
  auto const [value, unit] = in_joules(item, scene, accepted);
  return number(value, {accepted}) * unit;
}

InUnit in_joules_of_atoms(Item const& item, Scene& scene) {
  return scene.material && scene.material->atomistic ? in_joules(item, scene) : InUnit{item};
}

}  // namespace cayspin::inline v0_2::io::detail
