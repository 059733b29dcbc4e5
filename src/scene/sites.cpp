// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "io/scene.hpp"
#include "sections.hpp"
#include "site_expression.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <tuple>
#include <utility>

namespace cayspin::inline v0_2::io {
namespace {

// Returns 1 for sites whose number is not 0; empty if there are no numbers.
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
namespace {

// Reads the region of each site, which cannot itself be a number for each region.
void read_regions(Item const& item, Scene& scene) {
  auto const accepted = fmt::format(
      "an expression in {}, {{ file = \"NAME.h5\" }} or {{ image = \"NAME.png\", levels = [..] }}",
      fmt::join(site_variables(scene.lattice), ", "));
  auto const* const table = item.node->as_table();
  if (table != nullptr && table->contains("regions"))
    item.fail("says which region each site belongs to, and cannot depend on the region", accepted);
  if (!read_site_numbers(item, scene, scene.lattice.regions)) item.wrong_type(accepted);
}

}  // namespace

void read_occupied(Table const& root, Scene& scene) {
  auto const lattice = root.table("lattice", "a table [lattice]");
  if (auto const item = lattice.find("regions")) read_regions(*item, scene);
  for (auto const& [name, member] :
       {std::pair{"occupied", &Lattice::occupied}, {"frozen", &Lattice::frozen}})
    if (auto const item = lattice.find(name);
        item && !read_site_numbers(*item, scene, scene.lattice.*member))
      item->wrong_type(accepted_site_numbers(scene.lattice));
  for (auto const& [name, member] : {std::pair{"moments", &Lattice::moments_of_sites},
                                     {"gyromagnetic", &Lattice::gyromagnetic_of_sites}})
    if (auto const item = lattice.find(name); item && are_numbers_of_sites(*item))
      read_site_numbers(*item, scene, scene.lattice.*member);
}

void require_occupied(Scene const& scene) {
  auto const& shape = scene.lattice.shape;
  if (!has_vacancies(scene)) return;
  auto const at_once = planes_to_read(shape, sizeof(double));
  auto const& [occupied_sites, moments] =
      std::tie(scene.lattice.occupied, scene.lattice.moments_of_sites);
  bool has_occupied = !occupied_sites.there();
  for (std::int64_t plane = 0; plane < shape[2]; plane += at_once) {
    auto const planes = std::min(at_once, shape[2] - plane);
    SiteBox const box{{0, 0, plane}, {shape[0], shape[1], planes}};
    auto const there = occupied(scene, box);
    if (std::ranges::find(there, 1) != there.end()) return;
    auto const where = sites_where(scene, occupied_sites, "lattice.occupied", box);
    has_occupied = has_occupied || std::ranges::find(where, 1) != where.end();
  }
  refuse(scene, has_occupied ? moments.key_or("lattice.moments") : "lattice.occupied",
         "leaves no spin", "numbers that are not 0 somewhere");
}

}  // namespace detail

bool has_moments_of_sites(Scene const& scene) {
  auto const& [lattice, demag] = std::tie(scene.lattice, scene.field.demag);
  return lattice.moments_of_sites.there() || (demag && demag->dipoles && !lattice.moments.empty());
}

bool has_vacancies(Scene const& scene) {
  auto const& lattice = scene.lattice;
  auto const& of_sites = lattice.moments_of_sites;
  auto const has_zero = [](std::vector<double> const& numbers) {
    return std::ranges::find(numbers, 0) != numbers.end();
  };
  return lattice.occupied.there() || has_zero(lattice.moments) ||
         (of_sites.there() && (of_sites.per_region.empty() || has_zero(of_sites.per_region)));
}

std::vector<unsigned char> occupied(Scene const& scene, SiteBox const& box) {
  if (!has_vacancies(scene)) return {};
  auto where = sites_where(scene, scene.lattice.occupied, "lattice.occupied", box);
  auto const of_sites = moments_of_sites(scene, box);
  if (where.empty() && !of_sites.empty()) where.assign(of_sites.size(), 1);
  for (std::size_t site = 0; site < of_sites.size(); ++site)
    if (of_sites[site] == 0) where[site] = 0;
  auto const& moments = scene.lattice.moments;
  auto const in_plane = static_cast<std::size_t>(box.extent[0] * box.extent[1]);
  auto const first = static_cast<std::size_t>(box.begin[2]);
  if (where.empty()) where.assign(in_plane * static_cast<std::size_t>(box.extent[2]), 1);
  // Planes along z hold the sites of a cell in turn.
  for (std::size_t site = 0; site < where.size() && !moments.empty(); ++site)
    if (moments[(first + site / in_plane) % moments.size()] == 0) where[site] = 0;
  return where;
}
std::vector<unsigned char> frozen(Scene const& scene, SiteBox const& box) {
  return sites_where(scene, scene.lattice.frozen, "lattice.frozen", box);
}

std::vector<double> all_moments(Scene const& scene, SiteBox const& box) {
  auto const& of_cell = scene.lattice.moments;
  auto const there = occupied(scene, box);
  auto moments = moments_of_sites(scene, box);
  if (moments.empty() && of_cell.empty() && there.empty()) return {};
  auto const in_plane = static_cast<std::size_t>(box.extent[0] * box.extent[1]);
  auto const first = static_cast<std::size_t>(box.begin[2]);
  if (moments.empty()) {
    moments.resize(in_plane * static_cast<std::size_t>(box.extent[2]));
    for (std::size_t site = 0; site < moments.size(); ++site)
      moments[site] = of_cell_site(of_cell, (first + site / in_plane) % scene.lattice.basis.size());
  }
  for (std::size_t site = 0; site < there.size(); ++site)
    if (!there[site]) moments[site] = 0;
  return moments;
}

double of_cell_site(std::vector<double> const& numbers, std::size_t site) {
  return numbers.empty() ? 1 : numbers[site];
}

double over_moment(Lattice const& lattice, std::size_t site, double number) {
  double const moment = of_cell_site(lattice.moments, site);
  return moment > 0 ? number / moment : 0;
}

bool has_linear_field(Scene const& scene) {
  auto const& field = scene.field;
  return field.crystal_anisotropies.empty() && !has_torque(field) && field.couplings_file.empty() &&
         std::ranges::all_of(field.couplings,
                             [](auto const& bond) { return bond.biquadratic == 0; }) &&
         field.interlayers.empty() && std::ranges::all_of(field.anisotropies, [](auto const& term) {
           return term.constant2 == 0 && !term.factors2.there();
         });
}

bool needs_pass(Scene const& scene) {
  auto const& lattice = scene.lattice;
  auto const& field = scene.field;
  bool const has_sites = scene.system.dampings.there() || field.exchange_factors.there() ||
                         field.dmi_factors.there() ||
                         std::ranges::any_of(field.anisotropies, [](auto const& term) {
                           return term.site >= 0 || !term.is_plain();
                         });
  return lattice.basis.size() > 1 || !lattice.moments.empty() || !lattice.gyromagnetic.empty() ||
         lattice.moments_of_sites.there() || lattice.gyromagnetic_of_sites.there() ||
         lattice.occupied.there() || lattice.frozen.there() || !field.couplings.empty() ||
         !field.couplings_file.empty() || !field.crystal_anisotropies.empty() ||
         field.in_time.there() || has_sites || !field.sources.empty() ||
         !field.interlayers.empty() || field.torque.zhang_li || field.torque.slonczewski;
}

}  // namespace cayspin::inline v0_2::io
