// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "sections.hpp"

#include <cayspin/units.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

namespace cayspin::inline v0_1::io::detail {
namespace {

constexpr std::string_view three_components = "three numbers or expressions in t";

AppliedComponent times(AppliedComponent const& component, double factor) {
  if (auto const* const number = std::get_if<double>(&component))
    return factor * *number + 0.0;  // no -0
  return fmt::format("({})*({})", factor, std::get<std::string>(component));
}

// A current in A/m^2 in place of the torque itself: of a material with Ms.
std::optional<Item> find_current(Table const& table, std::string_view torque,
                                 std::vector<std::string_view> const& with) {
  auto const current = table.find("current_density");
  auto const& material = table.scene().material;
  if (!current) {
    for (auto const name : with)
      if (auto const item = table.find(name))
        item->fail("stands without current_density", "both or neither");
    return std::nullopt;
  }
  if (auto const item = table.find(torque))
    current->fail(fmt::format("stands beside {}", torque), "one of the two");
  if (!material) current->fail("is in A/m^2", fmt::format("{}, or units = \"SI\"", torque));
  if (material->atomistic)
    current->fail("needs the magnetization of a continuum",
                  fmt::format("{}, or material.Ms", torque));
  return current;
}

// Velocities in m/s in a scene in SI.
ZhangLi read_zhang_li(Item const& item, Scene& scene) {
  Table const table(item, scene);
  table.accept_only(names_of_keys<ZhangLi>());
  ZhangLi read;
  read_keys(table, read);
  if (auto const current = find_current(table, "velocity", {"polarization"})) {
    auto const& [Ms, gamma] = std::tie(scene.material->moment, scene.material->gamma);
    auto const polarization = number(table.required("polarization", "a number"));
    read.velocity = three(*current, three_components, component_in_time);
    double const of_unit_current = units::drift_velocity(
        {.density = 1, .polarization = polarization, .Ms = Ms, .gamma = gamma});
    for (auto& component : read.velocity) component = times(component, of_unit_current);
  } else {
    auto const velocity = table.required("velocity", three_components);
    read.velocity = three(velocity, three_components, component_in_time);
  }
  return read;
}

// Strengths in T in a scene in SI.
Slonczewski read_slonczewski(Item const& item, Scene& scene) {
  Table const table(item, scene);
  table.accept_only(names_of_keys<Slonczewski>());
  auto const current = find_current(table, "damping_like", {"efficiency", "thickness"});
  if (!table.contains("damping_like") && !table.contains("field_like") && !current)
    item.fail("has no strength", "damping_like, field_like");
  Slonczewski read;
  read_keys(table, read);
  if (current) {
    auto const efficiency = number(table.required("efficiency", "a number"));
    auto const thickness = positive_number(table.required("thickness", "a number > 0, in m"));
    double const of_unit_current = units::spin_torque({.density = 1,
                                                       .efficiency = efficiency,
                                                       .Ms = scene.material->moment,
                                                       .thickness = thickness});
    read.damping_like = times(component_in_time(*current), of_unit_current);
  }
  return read;
}

}  // namespace

Torque read_torque(Table const& root, SystemKind kind) {
  Torque torque;
  auto const table = table_of_spins(root, "torque", kind);
  if (!table) return torque;
  table->accept_only({"zhang_li", "slonczewski"});
  auto const zhang_li = table->find("zhang_li"), slonczewski = table->find("slonczewski");
  if (!zhang_li && !slonczewski) table->item().fail("is empty", "zhang_li, slonczewski");
  if (zhang_li) torque.zhang_li = read_zhang_li(*zhang_li, root.scene());
  if (slonczewski) torque.slonczewski = read_slonczewski(*slonczewski, root.scene());
  return torque;
}

}  // namespace cayspin::inline v0_1::io::detail
