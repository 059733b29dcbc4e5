// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "io/expression.hpp"
#include "sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <tuple>
#include <variant>

namespace cayspin::inline v0_2::io::detail {

namespace {

constexpr std::string_view accepted_temperature =
    "a number >= 0, an expression in t, values per site, or { profile = values per site, time = "
    "an expression in t }";

void read_temperature(Item const& item, Scene& scene, Thermal& thermal) {
  thermal.temperature = 1;
  auto const* const table = item.node->as_table();
  if (table != nullptr && (table->contains("profile") || table->contains("time"))) {
    Table const both(item, scene);
    both.accept_only({"profile", "time"});
    auto const profile = both.required("profile", accepted_site_numbers(scene.lattice));
    thermal.temperature = number_of_sites(profile, scene, thermal.of_sites);
    if (!(thermal.temperature >= 0)) profile.fail("is negative", "a number >= 0");
    auto const time = both.required("time", "an expression in t");
    thermal.in_time = component_in_time(time);
    if (auto* const factor = std::get_if<double>(&thermal.in_time)) {
      if (!(*factor >= 0)) time.fail("is negative", "a number >= 0");
      thermal.temperature *= *factor;
      *factor = 1;
    }
  } else if (item.node->is_string() && is_in_time(string(item, accepted_temperature))) {
    thermal.in_time = component_in_time(item);
  } else if (!read_site_numbers(item, scene, thermal.of_sites)) {
    thermal.temperature = number(item, {accepted_temperature, 0});
  }
}

}  // namespace

bool is_in_time(std::string const& text) {
  try {
    Expression(text, {"t"});
    return true;
  } catch (std::invalid_argument const&) {
    return false;
  }
}

std::optional<Thermal> read_thermal(Table const& root, SystemKind kind) {
  auto const table = table_of_spins(root, "thermal", kind);
  if (!table) return std::nullopt;
  table->accept_only(names_of_keys<Thermal>());
  Thermal thermal;
  read_keys(*table, thermal);
  read_temperature(table->required("temperature", accepted_temperature), root.scene(), thermal);
  return thermal;
}

void check_thermal(Scene const& scene) {
  if (!scene.thermal || scene.thermal->temperature == 0) return;
  auto const& [system, integrator] = std::tie(scene.system, scene.integrator);
  auto const& method = *integrator.method;
  if (!system.dampings.there() && !(system.damping > 0))
    refuse(scene, "thermal.temperature",
           "a temperature needs damping, by which spins exchange heat",
           "a damping > 0, or temperature = 0");
  if (!method.has_equal_steps() || !method.keeps_length)
    refuse(scene, "integrator.method",
           fmt::format("\"{}\" does not go with a temperature: it {}", method.word,
                       method.keeps_length ? "chooses its steps" : "does not keep |m| = 1"),
           "a method with steps of dt, such as \"heun\", \"rkmk4\", \"red_black2\"");
  if (integrator.compensated)
    refuse(scene, "integrator.compensated",
           "does not go with a temperature, whose noise is rounded, too", "no such key");
  if (integrator.until_torque)
    refuse(scene, "integrator.until_torque", "spins at a temperature do not come to rest",
           "no such key");
  bool const is_known =
      !has_noise_of_sites(scene) && std::holds_alternative<double>(scene.thermal->in_time);
  if (is_known)
    require_moderate_noise(scene,
                           largest_noise(scene) * system.damping * scene.thermal->temperature);
}

}  // namespace cayspin::inline v0_2::io::detail

namespace cayspin::inline v0_2::io {

std::vector<double> noise_of_cell_sites(Scene const& scene) {
  auto const& lattice = scene.lattice;
  std::vector<double> noise;
  for (std::size_t site = 0; site < lattice.basis.size(); ++site)
    noise.push_back(over_moment(lattice, site, of_cell_site(lattice.gyromagnetic, site)));
  return noise;
}

bool has_noise_of_sites(Scene const& scene) {
  return scene.system.dampings.there() || scene.lattice.moments_of_sites.there() ||
         scene.lattice.gyromagnetic_of_sites.there() ||
         (scene.thermal && scene.thermal->of_sites.there());
}

std::vector<double> noise_of_sites(Scene const& scene, SiteBox const& box) {
  auto const of_cell = noise_of_cell_sites(scene);
  auto const moments = moments_of_sites(scene, box);
  auto const there = occupied(scene, box), held = frozen(scene, box);
  auto const in_plane = static_cast<std::size_t>(box.extent[0] * box.extent[1]);
  std::vector<double> noise(in_plane * static_cast<std::size_t>(box.extent[2]));
  for (std::size_t site = 0; site < noise.size(); ++site) {
    auto const plane = static_cast<std::size_t>(box.begin[2]) + site / in_plane;
    bool const moves = (there.empty() || there[site]) && (held.empty() || !held[site]);
    noise[site] = moves ? of_cell[plane % of_cell.size()] : 0;
    if (moves && !moments.empty()) noise[site] /= moments[site];
  }
  auto const ratios = gyromagnetic_of_sites(scene, box);
  for (std::size_t site = 0; site < ratios.size(); ++site) noise[site] *= ratios[site];
  auto const multiply = [&](SiteNumbers const& numbers, std::string_view key) {
    if (!numbers.there()) return;
    auto const values = numbers_of_sites(scene, numbers, key, box);
    for (std::size_t site = 0; site < noise.size(); ++site) {
      if (!(values[site] >= 0))
        detail::refuse(scene, numbers.key_or(key), "is negative at a site", "numbers >= 0");
      noise[site] *= values[site];
    }
  };
  multiply(scene.system.dampings, "system.damping");
  multiply(scene.thermal->of_sites, "thermal.temperature");
  if (!scene.system.gilbert_of_sites) return noise;
  // In Gilbert's form, noise and torques are divided by the same factor.
  auto const dampings = numbers_of_sites(scene, scene.system.dampings, "system.damping", box);
  for (std::size_t site = 0; site < noise.size(); ++site)
    noise[site] /= 1 + dampings[site] * dampings[site];
  return noise;
}

double largest_noise(Scene const& scene) {
  if (!has_noise_of_sites(scene)) return std::ranges::max(noise_of_cell_sites(scene));
  double largest = 0;
  for_each_box_of_planes(scene.lattice.shape, sizeof(double), [&](SiteBox const& box) {
    largest = std::max(largest, std::ranges::max(noise_of_sites(scene, box)));
  });
  return largest;
}

void require_moderate_noise(Scene const& scene, double heat) {
  auto const& [lattice, integrator] = std::tie(scene.lattice, scene.integrator);
  double const half = heat * integrator.dt;
  if (half <= 1) return;
  bool const has_factors = !lattice.moments.empty() || lattice.moments_of_sites.there() ||
                           !lattice.gyromagnetic.empty() || lattice.gyromagnetic_of_sites.there();
  detail::refuse(
      scene, "integrator.dt",
      fmt::format("damping times temperature times dt{} is {:.3g}: the noise of one step would "
                  "erase all memory of a spin's direction",
                  has_factors ? ", times gyromagnetic ratio over moment," : "", half),
      fmt::format("a dt up to {:.6g}{}, better a tenth of it",
                  integrator.dt / half * scene.units.time, scene.units.si ? " s" : ""));
}

}  // namespace cayspin::inline v0_2::io
