// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "io/scene.hpp"
#include "sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace cayspin::inline v0_1::io {
namespace {

// 1 where numbers are not 0; nothing without them.
std::vector<unsigned char> sites_where(Scene const& scene, SiteNumbers const& numbers,
                                       std::string_view key, SiteBox const& box) {
  if (!numbers.there()) return {};
  auto const values = numbers_of_sites(scene, numbers, key, box);
  std::vector<unsigned char> where(values.size());
  std::ranges::transform(values, where.begin(), [](double value) { return value != 0 ? 1 : 0; });
  return where;
}

}  // namespace

namespace detail {

void read_occupied(Table const& root, Scene& scene) {
  auto const lattice = root.table("lattice", "a table [lattice]");
  for (auto const& [name, member] :
       {std::pair{"occupied", &Lattice::occupied}, {"frozen", &Lattice::frozen}})
    if (auto const item = lattice.find(name);
        item && !read_site_numbers(*item, scene, scene.lattice.*member))
      item->wrong_type(accepted_site_numbers(scene.lattice));
}

void require_occupied(Scene const& scene) {
  auto const& shape = scene.lattice.shape;
  if (!has_vacancies(scene)) return;
  auto const at_once = scene.lattice.occupied.expression.empty() ? shape[2] : 1;
  for (std::int64_t plane = 0; plane < shape[2]; plane += at_once) {
    auto const there = occupied(scene, {{0, 0, plane}, {shape[0], shape[1], at_once}});
    if (std::ranges::find(there, 1) != there.end()) return;
  }
  refuse(scene, scene.lattice.occupied.there() ? "lattice.occupied" : "lattice.moments",
         "leaves no spin", "numbers that are not 0 somewhere");
}

}  // namespace detail

bool has_vacancies(Scene const& scene) {
  auto const& lattice = scene.lattice;
  return lattice.occupied.there() || std::ranges::find(lattice.moments, 0) != lattice.moments.end();
}

std::vector<unsigned char> occupied(Scene const& scene, SiteBox const& box) {
  if (!has_vacancies(scene)) return {};
  auto where = sites_where(scene, scene.lattice.occupied, "lattice.occupied", box);
  auto const& moments = scene.lattice.moments;
  auto const in_plane = static_cast<std::size_t>(box.extent[0] * box.extent[1]);
  auto const first = static_cast<std::size_t>(box.begin[2]);
  if (where.empty()) where.assign(in_plane * static_cast<std::size_t>(box.extent[2]), 1);
  // The planes of a box are the sites of a cell in turn.
  for (std::size_t site = 0; site < where.size() && !moments.empty(); ++site)
    if (moments[(first + site / in_plane) % moments.size()] == 0) where[site] = 0;
  return where;
}
std::vector<unsigned char> frozen(Scene const& scene, SiteBox const& box) {
  return sites_where(scene, scene.lattice.frozen, "lattice.frozen", box);
}

double of_cell_site(std::vector<double> const& numbers, std::size_t site) {
  return numbers.empty() ? 1 : numbers[site];
}

double over_moment(Lattice const& lattice, std::size_t site, double number) {
  double const moment = of_cell_site(lattice.moments, site);
  return moment > 0 ? number / moment : 0;
}

std::vector<double> noise_of_sites(Scene const& scene) {
  auto const& lattice = scene.lattice;
  std::vector<double> noise;
  for (std::size_t site = 0; site < lattice.basis.size(); ++site)
    noise.push_back(over_moment(lattice, site, of_cell_site(lattice.gyromagnetic, site)));
  return noise;
}
double largest_noise(Scene const& scene) { return std::ranges::max(noise_of_sites(scene)); }

bool has_linear_field(Scene const& scene) {
  auto const& field = scene.field;
  return field.cubic_anisotropies.empty() && !has_torque(field) && field.couplings_file.empty() &&
         std::ranges::all_of(field.couplings,
                             [](auto const& bond) { return bond.biquadratic == 0; });
}

bool needs_pass(Scene const& scene) {
  auto const& lattice = scene.lattice;
  auto const& field = scene.field;
  bool const has_sites = scene.system.dampings.there() || field.exchange_factors.there() ||
                         field.dmi_factors.there() ||
                         std::ranges::any_of(field.anisotropies, [](auto const& term) {
                           return term.site >= 0 || term.factors.there();
                         });
  return lattice.basis.size() > 1 || !lattice.moments.empty() || !lattice.gyromagnetic.empty() ||
         lattice.occupied.there() || lattice.frozen.there() || !field.couplings.empty() ||
         !field.couplings_file.empty() || !field.cubic_anisotropies.empty() || has_sites ||
         field.torque.zhang_li || field.torque.slonczewski;
}

}  // namespace cayspin::inline v0_1::io
