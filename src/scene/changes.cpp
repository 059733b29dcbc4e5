// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "io/changes.hpp"

#include "sections.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <string_view>

namespace cayspin::inline v0_2::io {
namespace {

// Compares two numbers, allowing for the round-off of a conversion from SI.
bool same(double a, double b) {
  return a == b || std::abs(a - b) <= 1e-12 * std::max(std::abs(a), std::abs(b));
}

bool same(Triple const& a, Triple const& b) {
  return std::ranges::equal(a, b, [](double x, double y) { return std::abs(x - y) <= 1e-12; });
}

bool same_spacing(Scene const& before, Scene const& now, std::size_t axis) {
  return same(before.lattice.spacing[axis] * before.units.length,
              now.lattice.spacing[axis] * now.units.length);
}

// Compares the numbers of a cell's sites. If a vector is empty, all its numbers are 1.
bool same_of_cell(std::vector<double> before, std::vector<double> now, std::size_t sites) {
  if (before.empty()) before.assign(sites, 1);
  if (now.empty()) now.assign(sites, 1);
  return std::ranges::equal(before, now, [](double a, double b) { return same(a, b); });
}

template <class Number>
using OfSites = std::vector<Number> (*)(Scene const&, SiteBox const&);

// Compares numbers per site. If of_sites(scene, box) returns none, all sites have the value
// `otherwise`.
template <class Number>
bool same_sites(Scene const& before, Scene const& now, SiteNumbers Lattice::*numbers,
                OfSites<Number> of_sites, Number otherwise) {
  auto const &a = before.lattice.*numbers, &b = now.lattice.*numbers;
  if (!a.there() && !b.there()) return true;
  if (a.there() == b.there() && a.expression == b.expression && a.file == b.file &&
      a.image == b.image && a.levels == b.levels && !a.given == !b.given && a.unit == b.unit &&
      a.per_region.empty() && b.per_region.empty())
    return true;
  auto const& [nx, ny, nz] = now.lattice.shape;
  auto const at_once = planes_to_read(now.lattice.shape, sizeof(double));
  for (std::int64_t plane = 0; plane < nz; plane += at_once) {
    auto const planes = std::min(at_once, nz - plane);
    SiteBox const box{{0, 0, plane}, {nx, ny, planes}};
    auto one = of_sites(before, box), other = of_sites(now, box);
    auto const count = static_cast<std::size_t>(nx * ny * planes);
    for (auto* const some : {&one, &other})
      if (some->empty()) some->assign(count, otherwise);
    if (!std::ranges::equal(one, other, [](auto x, auto y) { return same(x, y); })) return false;
  }
  return true;
}

// Returns numbers per site, converted from reduced units to the units of the scene, because two
// scenes in SI may have different reduced units. `unit`: the reduced unit of these numbers.
// `of_cell`: the numbers of the cell's sites, used if the scene has none per site.
std::vector<double> in_own_units(Scene const& scene, SiteBox const& box, OfSites<double> of_sites,
                                 std::vector<double> const& of_cell, double unit) {
  auto numbers = of_sites(scene, box);
  auto const in_plane = static_cast<std::size_t>(box.extent[0] * box.extent[1]);
  auto const first = static_cast<std::size_t>(box.begin[2]);
  if (numbers.empty()) {
    numbers.resize(in_plane * static_cast<std::size_t>(box.extent[2]));
    for (std::size_t site = 0; site < numbers.size(); ++site)
      numbers[site] = of_cell_site(of_cell, (first + site / in_plane) % scene.lattice.basis.size());
  }
  for (double& number : numbers) number *= unit;
  return numbers;
}

std::vector<double> own_moments(Scene const& scene, SiteBox const& box) {
  return in_own_units(scene, box, moments_of_sites, scene.lattice.moments,
                      scene.material ? scene.material->moment : 1);
}

std::vector<double> own_gyromagnetic(Scene const& scene, SiteBox const& box) {
  return in_own_units(scene, box, gyromagnetic_of_sites, scene.lattice.gyromagnetic,
                      scene.material ? scene.material->gamma : 1);
}

// Compares numbers of the cell's sites, or numbers per site if one of the scenes has these.
bool same_numbers(Scene const& before, Scene const& now, std::vector<double> Lattice::*of_cell,
                  SiteNumbers Lattice::*of_sites, OfSites<double> in_units) {
  auto const &a = before.lattice, &b = now.lattice;
  if ((a.*of_sites).there() || (b.*of_sites).there())
    return same_sites<double>(before, now, of_sites, in_units, 1);
  return same_of_cell(a.*of_cell, b.*of_cell, b.basis.size());
}

bool same(toml::node const& a, toml::node const& b);

bool same(toml::array const& a, toml::array const& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (!same(a[i], b[i])) return false;
  return true;
}

bool same(toml::table const& a, toml::table const& b) {
  if (a.size() != b.size()) return false;
  return std::ranges::all_of(a, [&](auto const& entry) {
    auto const* const other = b.get(entry.first.str());
    return other && same(entry.second, *other);
  });
}

bool same(toml::node const& a, toml::node const& b) {
  // Integers are compared exactly: as double, seeds above 2^53 could be equal.
  if (a.is_integer() && b.is_integer()) return *a.as_integer() == *b.as_integer();
  if (a.is_number() && b.is_number()) return a.value<double>() == b.value<double>();
  if (a.type() != b.type()) return false;
  return a.visit([&](auto const& typed) {
    using Node = std::remove_cvref_t<decltype(typed)>;
    auto const& other = *b.as<toml::impl::unwrap_node<Node>>();
    if constexpr (toml::is_table<Node> || toml::is_array<Node>)
      return same(typed, other);
    else
      return *typed == *other;
  });
}

void find_changes(toml::table const& before, toml::table const& now, std::string const& prefix,
                  std::vector<std::string>& found) {
  std::set<std::string, std::less<>> keys;
  for (auto const* const table : {&before, &now})
    for (auto const& [key, value] : *table) keys.emplace(key.str());
  for (auto const& key : keys) {
    auto const *const a = before.get(key), *const b = now.get(key);
    if (a && b && a->is_table() && b->is_table())
      find_changes(*a->as_table(), *b->as_table(), prefix + key + '.', found);
    else if (!a || !b || !same(*a, *b))
      found.push_back(prefix + key);
  }
}

}  // namespace

std::string changed_lattice_key(Scene const& before, Scene const& now) {
  auto const &a = before.lattice, &b = now.lattice;
  if (before.system.kind != now.system.kind) return "system.kind";
  if (now.system.kind != SystemKind::llg) return {};
  if (!std::ranges::equal(a.cell, b.cell, [](auto& x, auto& y) { return same(x, y); }))
    return "lattice.cell";
  if (!std::ranges::equal(a.basis, b.basis, [](auto& x, auto& y) { return same(x, y); }))
    return "lattice.basis";
  bool const is_crystal = b.basis.size() > 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    bool const counts = b.shape[axis] > 1 || is_crystal || before.field.demag || now.field.demag;
    if (!counts) continue;
    if (!same_spacing(before, now, axis)) return "lattice.spacing";
    if (a.boundary[axis] != b.boundary[axis]) return "lattice.boundary";
  }
  if (!same_numbers(before, now, &Lattice::moments, &Lattice::moments_of_sites, own_moments))
    return "lattice.moments";
  if (!same_numbers(before, now, &Lattice::gyromagnetic, &Lattice::gyromagnetic_of_sites,
                    own_gyromagnetic))
    return "lattice.gyromagnetic";
  if (!same_sites<unsigned char>(before, now, &Lattice::occupied, occupied, 1))
    return "lattice.occupied";
  if (!same_sites<unsigned char>(before, now, &Lattice::frozen, frozen, 0)) return "lattice.frozen";
  return {};
}

std::vector<std::string> changed_keys(std::string const& before, std::string const& now) {
  auto const parsed = [](std::string const& text) {
    try {
      return toml::parse(text);
    } catch (toml::parse_error const& error) {
      throw SceneError("a scene's text is not TOML: " + std::string(error.description()));
    }
  };
  std::vector<std::string> found;
  find_changes(parsed(before), parsed(now), {}, found);
  return found;
}

}  // namespace cayspin::inline v0_2::io
