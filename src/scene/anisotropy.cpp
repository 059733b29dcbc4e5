// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "quantity.hpp"
#include "sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace cayspin::inline v0_2::io::detail {
namespace {

constexpr std::string_view accepted_axes = "two vectors at right angles, to 1e-4";
constexpr double most_skew = 1e-4;  // limit of cayspin::CubicAnisotropy

// Returns -1 for all sites of the cell, or the index of one.
int read_site(Table const& table) {
  auto const item = table.find("site");
  if (!item) return -1;
  auto const sites = table.scene().lattice.basis.size();
  auto const accepted = sites == 1 ? "0, the only site of the cell"
                                   : fmt::format("a site of the cell, 0 to {}", sites - 1);
  auto const site = integer(*item, {accepted, 0});
  if (site >= static_cast<std::int64_t>(sites))
    item->fail(fmt::format("the cell has no site {}", site), accepted);
  return static_cast<int>(site);
}

void refuse_keys(Table const& table, std::vector<std::string_view> const& keys,
                 std::string_view why) {
  for (auto const key : keys)
    if (auto const item = table.find(key)) item->fail(why, "no such key");
}

std::string skew_text(Triple const& a, Triple const& b) {
  double const skew = std::abs(cayspin::detail::scalar_product(a, b));
  return skew <= most_skew ? std::string()
                           : fmt::format("the axes are not at right angles, by {:.3g}", skew);
}

// Site-dependent axes are checked where they are used, in crystal_axes().
void read_axes(Item const& of_both, std::array<Item, 2> const& each, Scene& scene,
               CrystalAnisotropy& term) {
  for (std::size_t i = 0; i < 2; ++i)
    term.axes[i] = axis_of_sites(each[i], scene, term.axes_of_sites[i]);
  if (term.axes_of_sites[0].there() || term.axes_of_sites[1].there()) return;
  if (auto const skew = skew_text(term.axes[0], term.axes[1]); !skew.empty())
    of_both.fail(skew, accepted_axes);
}

CrystalAnisotropy read_cubic(Table const& table) {
  CrystalAnisotropy term;
  auto& scene = table.scene();
  refuse_keys(table, {"constant", "axis"}, "belongs to a uniaxial anisotropy");
  refuse_keys(table, {"hexagonal", "in_plane"}, "belongs to a hexagonal anisotropy");
  term.constant =
      constant_of_sites(table.required("cubic", "a finite number"), scene, term.factors);
  if (auto const second = table.find("constant2"))
    term.constant2 = constant_of_sites(*second, scene, term.factors2);
  auto const axes = table.required("axes", accepted_axes);
  auto const each = entries(axes, 2, 2, accepted_axes);
  read_axes(axes, {each[0], each[1]}, scene, term);
  term.site = read_site(table);
  return term;
}

CrystalAnisotropy read_hexagonal(Table const& table) {
  CrystalAnisotropy term{.hexagonal = true};
  auto& scene = table.scene();
  refuse_keys(table, {"constant", "constant2"}, "belongs to a uniaxial anisotropy");
  refuse_keys(table, {"axes"}, "belongs to a cubic anisotropy");
  term.constant =
      constant_of_sites(table.required("hexagonal", "a finite number"), scene, term.factors);
  auto const in_plane = table.required("in_plane", "a vector at right angles with axis, to 1e-4");
  read_axes(in_plane, {table.required("axis", "three numbers"), in_plane}, scene, term);
  term.site = read_site(table);
  return term;
}

void read_anisotropy(Item const& item, Scene& scene, Field& field) {
  Table const table(item, scene);
  table.accept_only(
      {"constant", "constant2", "axis", "cubic", "axes", "hexagonal", "in_plane", "site"});
  if (table.contains("cubic")) {
    field.crystal_anisotropies.push_back(read_cubic(table));
    return;
  }
  if (table.contains("hexagonal")) {
    field.crystal_anisotropies.push_back(read_hexagonal(table));
    return;
  }
  refuse_keys(table, {"axes"}, "belongs to a cubic anisotropy");
  refuse_keys(table, {"in_plane"}, "belongs to a hexagonal anisotropy");
  Anisotropy term;
  term.constant =
      constant_of_sites(table.required("constant", "a finite number"), scene, term.factors);
  if (auto const second = table.find("constant2"))
    term.constant2 = constant_of_sites(*second, scene, term.factors2);
  term.axis = axis_of_sites(table.required("axis", "three numbers"), scene, term.axes);
  term.site = read_site(table);
  field.anisotropies.push_back(std::move(term));
}

}  // namespace

void read_anisotropies(Item const& item, Scene& scene, Field& field) {
  constexpr std::string_view accepted =
      "{ constant = K, axis = [x, y, z] }, { cubic = Kc, axes = [[..], [..]] }, { hexagonal = K, "
      "axis = [..], in_plane = [..] }, or an array of such tables";
  if (item.node->is_table()) return read_anisotropy(item, scene, field);
  for (auto const& entry : entries(item, 0, std::numeric_limits<std::size_t>::max(), accepted))
    read_anisotropy(entry, scene, field);
}

}  // namespace cayspin::inline v0_2::io::detail

namespace cayspin::inline v0_2::io {

std::array<std::vector<double>, 2> crystal_axes(Scene const& scene, CrystalAnisotropy const& term,
                                                SiteBox const& box) {
  constexpr std::string_view key = "field.anisotropy";
  std::array<std::vector<double>, 2> axes;
  bool const differ = term.axes_of_sites[0].there() || term.axes_of_sites[1].there();
  for (std::size_t i = 0; i < 2; ++i) {
    SiteVectors alike;
    alike.uniform = term.axes[i];
    auto const& of_sites = term.axes_of_sites[i];
    if (differ)
      axes[i] = directions_of_sites(scene, of_sites.there() ? of_sites : alike, key, box);
    else
      axes[i].assign(term.axes[i].begin(), term.axes[i].end());
  }
  auto const there = differ ? occupied(scene, box) : std::vector<unsigned char>();
  for (std::size_t site = 0; site < axes[0].size() / 3; ++site) {
    double const* const first = &axes[0][3 * site];
    double* const second = &axes[1][3 * site];
    if (!there.empty() && !there[site]) continue;
    Triple const a{first[0], first[1], first[2]}, b{second[0], second[1], second[2]};
    if (auto const skew = detail::skew_text(a, b); !skew.empty())
      throw scene_error(scene, key,
                        fmt::format("{}, at {}; accepted: {}", skew, detail::site_text(box, site),
                                    detail::accepted_axes));
    double const along = cayspin::detail::scalar_product(a, b);
    auto const turned =
        detail::normalise({b[0] - along * a[0], b[1] - along * a[1], b[2] - along * a[2]});
    std::ranges::copy(*turned, second);
  }
  return axes;
}

}  // namespace cayspin::inline v0_2::io
