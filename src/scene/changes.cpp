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
  if (!same_of_cell(a.moments, b.moments, b.basis.size())) return "lattice.moments";
  if (!same_of_cell(a.gyromagnetic, b.gyromagnetic, b.basis.size())) return "lattice.gyromagnetic";
  if (!same_sites<double>(before, now, &Lattice::moments_of_sites, moments_of_sites, 1))
    return "lattice.moments";
  if (!same_sites<double>(before, now, &Lattice::gyromagnetic_of_sites, gyromagnetic_of_sites, 1))
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
