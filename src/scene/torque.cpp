// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "sections.hpp"

#include <cayspin/units.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

namespace cayspin::inline v0_2::io::detail {
namespace {

constexpr std::string_view three_components = "three numbers or expressions in t";

AppliedComponent times(AppliedComponent const& component, double factor) {
  if (auto const* const number = std::get_if<double>(&component))
    return factor * *number + 0.0;  // avoids -0
  return fmt::format("({})*({})", factor, std::get<std::string>(component));
}

// Reads a number, an expression in t, site-dependent numbers, or the product { profile, time } of
// numbers and an expression. Site-dependent numbers go to `of_sites`.
AppliedComponent strength(Item const& item, Scene& scene, SiteNumbers& of_sites) {
  of_sites.key = item.key;
  auto const* const table = item.node->as_table();
  if (table != nullptr && (table->contains("profile") || table->contains("time"))) {
    Table const both(item, scene);
    both.accept_only({"profile", "time"});
    auto const accepted = accepted_site_numbers(scene.lattice);
    double const constant = number_of_sites(both.required("profile", accepted), scene, of_sites);
    return times(component_in_time(both.required("time", "an expression in t")), constant);
  }
  auto const* const text = item.node->as_string();
  bool const is_of_sites = table != nullptr || (text != nullptr && !is_in_time(text->get()));
  if (!is_of_sites) return component_in_time(item);
  read_site_numbers(item, scene, of_sites);
  return 1.0;
}

// Multiplies a component by `factor`; if it has site-dependent numbers, multiplies these instead.
void scale(AppliedComponent& component, SiteNumbers& of_sites, double factor) {
  if (of_sites.there())
    of_sites.unit *= factor;
  else
    component = times(component, factor);
}

// Returns the key current_density, in A/m^2, if it is typed in place of the key `torque`. It needs
// a material of a continuum, with one gamma. The keys in `with` are refused without it.
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
  if (material->gamma_factors.there())
    current->fail("needs one gamma for all sites", fmt::format("{}, or one gamma", torque));
  return current;
}

// If the scene is in SI, velocities are in m/s.
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
    read.per_moment = scene.material->moment_factors.there();
  } else {
    auto const velocity = table.required("velocity", three_components);
    read.velocity = three(velocity, three_components, component_in_time);
  }
  return read;
}

// Sets damping_like and, if epsilon_prime is typed, field_like:
//   damping_like = efficiency * hbar * j / (2 * e * Ms * thickness),
//   field_like = epsilon_prime * hbar * j / (e * Ms * thickness).
void read_current(Item const& current, Table const& table, Slonczewski& read) {
  auto& scene = table.scene();
  auto const efficiency = number(table.required("efficiency", "a number"));
  auto const thickness = positive_number(table.required("thickness", "a number > 0, in m"));
  auto const of_unit_current = [&](double of_efficiency) {
    return units::spin_torque({.density = 1,
                               .efficiency = of_efficiency,
                               .Ms = scene.material->moment,
                               .thickness = thickness});
  };
  auto const density = strength(current, scene, read.damping_like_of_sites);
  auto const profile = read.damping_like_of_sites;
  read.damping_like = density;
  scale(read.damping_like, read.damping_like_of_sites, of_unit_current(efficiency));
  read.damping_like_per_moment = scene.material->moment_factors.there();
  auto const second = table.find("epsilon_prime");
  if (!second) return;
  if (auto const other = table.find("field_like"))
    other->fail("stands beside epsilon_prime", "one of the two");
  read.field_like = density;
  read.field_like_of_sites = profile;
  read.field_like_per_moment = read.damping_like_per_moment;
  scale(read.field_like, read.field_like_of_sites, of_unit_current(2 * number(*second)));
}

// If the scene is in SI, strengths are in T.
Slonczewski read_slonczewski(Item const& item, Scene& scene) {
  Table const table(item, scene);
  table.accept_only(names_of_keys<Slonczewski>());
  auto const current =
      find_current(table, "damping_like", {"efficiency", "thickness", "epsilon_prime"});
  if (!table.contains("damping_like") && !table.contains("field_like") && !current)
    item.fail("has no strength", "damping_like, field_like");
  Slonczewski read;
  read_keys(table, read);
  read.polarization =
      axis_of_sites(table.required("polarization", "three numbers"), scene, read.polarizations);
  if (auto const a = table.find("damping_like"))
    read.damping_like = strength(*a, scene, read.damping_like_of_sites);
  if (auto const b = table.find("field_like"))
    read.field_like = strength(*b, scene, read.field_like_of_sites);
  if (current) read_current(*current, table, read);
  return read;
}

bool is_zero(AppliedComponent const& component) {
  auto const* const number = std::get_if<double>(&component);
  return number != nullptr && *number == 0;
}

// A torque of zeros counts as none: the energy falls, and `cayspin relax` accepts the scene.
void drop_zeros(Torque& torque) {
  if (torque.zhang_li && std::ranges::all_of(torque.zhang_li->velocity, is_zero))
    torque.zhang_li.reset();
  if (auto const& of = torque.slonczewski;
      of && is_zero(of->damping_like) && is_zero(of->field_like))
    torque.slonczewski.reset();
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
  auto const& material = root.scene().material;
  if (zhang_li && slonczewski && material && material->gamma_factors.there())
    slonczewski->fail("does not go with zhang_li where gamma differs from site to site",
                      "one of the two, or one gamma");
  if (slonczewski) torque.slonczewski = read_slonczewski(*slonczewski, root.scene());
  drop_zeros(torque);
  return torque;
}

}  // namespace cayspin::inline v0_2::io::detail
