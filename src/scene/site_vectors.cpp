// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "dataset_of_sites.hpp"
#include "hdf5/guarded_reading.hpp"
#include "io/ovf.hpp"
#include "io/scene.hpp"
#include "ovf_of_sites.hpp"
#include "sections.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <stdexcept>
#include <utility>

namespace cayspin::inline v0_2::io {

using detail::normalise;

namespace {

detail::DatasetOfSites open_vectors(std::filesystem::path const& path, Lattice const& lattice) {
  detail::DatasetOfSites vectors(path, "/values", lattice, 3, Accepted::numbers);
  if (!vectors.fits()) vectors.refuse_extents(fmt::format("({})", vectors.expected()));
  return vectors;
}

std::vector<double> vectors_of_file(std::filesystem::path const& path, Lattice const& lattice,
                                    SiteBox const& box) {
  auto vectors = is_ovf(path)
                     ? detail::read_ovf_of_sites(path, lattice, 3, box)
                     : read_guarded(path, [&] { return open_vectors(path, lattice).in(box); });
  if (!std::ranges::all_of(vectors, [](double number) { return std::isfinite(number); }))
    throw std::runtime_error(path.string() + ": a value is not finite; accepted: finite numbers");
  return vectors;
}

std::size_t number_in(SiteBox const& box, std::array<std::int64_t, 3> const& at) {
  return static_cast<std::size_t>((at[2] * box.extent[1] + at[1]) * box.extent[0] + at[0]);
}

/// Calls visit(at) for the sites of a box, in order.
template <class Visit>
void for_each_site(SiteBox const& box, Visit const& visit) {
  std::array<std::int64_t, 3> at;
  for (at[2] = 0; at[2] < box.extent[2]; ++at[2])
    for (at[1] = 0; at[1] < box.extent[1]; ++at[1])
      for (at[0] = 0; at[0] < box.extent[0]; ++at[0]) visit(at);
}

/// Numbers of the sites of a box, and of the sites that are up to `reach` past the end of the box
/// along an axis, or before its start if `reach` is negative. read(box) returns the numbers of a
/// box; sites past an open end have `none`.
template <class Number>
class NumbersAlong {
 public:
  template <class Read>
  NumbersAlong(Lattice const& lattice, SiteBox const& box, std::size_t axis, std::int64_t reach,
               Number none, Read const& read)
      : axis_(axis), box_(box), none_(none), own_(read(box)) {
    std::int64_t const extent = lattice.shape[axis];
    for (std::int64_t distance = 1; distance <= std::abs(reach); ++distance) {
      std::int64_t const place =
          box.begin[axis] + (reach > 0 ? box.extent[axis] - 1 + distance : -distance);
      bool const is_past_end = place < 0 || place >= extent;
      auto& [plane, numbers] = beyond_.emplace_back(box, std::vector<Number>());
      plane.begin[axis] = (place + extent) % extent;
      plane.extent[axis] = 1;
      if (!is_past_end || lattice.boundary[axis] == BoundaryKind::periodic) numbers = read(plane);
    }
  }
  Number operator()(std::array<std::int64_t, 3> at) const {
    std::int64_t const i = at[axis_], extent = box_.extent[axis_];
    if (i >= 0 && i < extent) return own_[number_in(box_, at)];
    auto const& [plane, numbers] = beyond_[static_cast<std::size_t>(i < 0 ? -i - 1 : i - extent)];
    at[axis_] = 0;
    return numbers.empty() ? none_ : numbers[number_in(plane, at)];
  }

 private:
  std::size_t axis_;
  SiteBox box_;
  Number none_;
  std::vector<Number> own_;
  std::vector<std::pair<SiteBox, std::vector<Number>>> beyond_;
};

// Returns the region of each site, -1 where there is no spin.
std::vector<std::int64_t> regions_of_spins(Scene const& scene, SiteBox const& box) {
  auto all = regions(scene, box);
  auto const there = occupied(scene, box);
  for (std::size_t site = 0; site < there.size(); ++site)
    if (!there[site]) all[site] = -1;
  return all;
}

}  // namespace

namespace detail {

std::string accepted_site_vectors(Lattice const& lattice) {
  return fmt::format(
      "three components, each a number or {}; {{ file = \"NAME.h5\" }} or .ovf; or {{ regions = "
      "[[..], [..]] }}",
      accepted_site_numbers(lattice));
}

SiteVectors read_site_vectors(Item const& item, Scene& scene) {
  SiteVectors vectors;
  auto const accepted = accepted_site_vectors(scene.lattice);
  if (item.node->is_table()) {
    Table const table(item, scene);
    table.accept_only({"file", "regions"});
    if (auto const count = item.node->as_table()->size(); count != 1)
      item.fail(fmt::format("has {} keys", count), accepted);
    if (auto const regions = table.find("regions")) {
      if (!scene.lattice.regions.there())
        regions->fail("stands without lattice.regions, which says the region of each site",
                      "lattice.regions beside it");
      for (auto const& entry :
           entries(*regions, 1, std::numeric_limits<std::size_t>::max(), "a list of vectors"))
        vectors.per_region.push_back(triple(entry));
    } else {
      vectors.file = input_file(table, "file", "the name of an HDF5 or OVF file");
    }
    return vectors;
  }
  auto const typed = entries(item, 3, 3, accepted);
  for (std::size_t c = 0; c < 3; ++c)
    vectors.uniform[c] = number_of_sites(typed[c], scene, vectors.components[c]);
  return vectors;
}

Triple axis_of_sites(Item const& item, Scene& scene, SiteVectors& axes) {
  auto const* const array = item.node->as_array();
  bool const is_one =
      array != nullptr && std::all_of(array->begin(), array->end(),
                                      [](auto const& entry) { return entry.is_number(); });
  if (is_one || (array == nullptr && !item.node->is_table())) return direction(item);
  axes = read_site_vectors(item, scene);
  for (std::size_t region = 0; region < axes.per_region.size(); ++region)
    if (!normalise(axes.per_region[region]))
      item.fail(fmt::format("the vector of region {} has no direction", region),
                "vectors that are not zero");
  return {};
}

void check_site_vectors(Scene const& scene, SiteVectors const& vectors, std::string_view key) {
  if (vectors.file.empty()) return;
  for_key(scene, vectors.key_or(key), [&] {
    if (is_ovf(vectors.file)) return check_ovf_of_sites(vectors.file, scene.lattice, 3);
    try_reading(vectors.file, [&] { open_vectors(vectors.file, scene.lattice); });
  });
}

}  // namespace detail

std::vector<double> vectors_of_sites(Scene const& scene, SiteVectors const& vectors,
                                     std::string_view key, SiteBox const& box) {
  key = vectors.key_or(key);
  auto const& [nx, ny, nz] = box.extent;
  auto const count = static_cast<std::size_t>(nx * ny * nz);
  std::vector<double> all;
  if (!vectors.file.empty()) {
    all = detail::for_key(scene, key,
                          [&] { return vectors_of_file(vectors.file, scene.lattice, box); });
  } else {
    all.resize(3 * count);
    for (std::size_t c = 0; c < 3; ++c) {
      SiteNumbers component = vectors.components[c];
      for (auto const& vector : vectors.per_region) component.per_region.push_back(vector[c]);
      auto const numbers = component.there() ? numbers_of_sites(scene, component, key, box)
                                             : std::vector(count, vectors.uniform[c]);
      for (std::size_t site = 0; site < count; ++site) all[3 * site + c] = numbers[site];
    }
  }
  for (double& number : all) number *= vectors.unit;
  return all;
}

std::vector<double> directions_of_sites(Scene const& scene, SiteVectors const& vectors,
                                        std::string_view key, SiteBox const& box) {
  auto directions = vectors_of_sites(scene, vectors, key, box);
  auto const there = occupied(scene, box);
  for (std::size_t site = 0; site < directions.size() / 3; ++site) {
    double* const v = &directions[3 * site];
    if (auto const unit = normalise({v[0], v[1], v[2]}))
      std::ranges::copy(*unit, v);
    else if (there.empty() || there[site])
      throw scene_error(scene, vectors.key_or(key),
                        fmt::format("has no direction at {}; accepted: vectors that are not zero",
                                    detail::site_text(box, site)));
  }
  return directions;
}

void require_directions(Scene const& scene) {
  auto const require = [&](SiteVectors const& vectors, std::string_view key) {
    if (!vectors.there()) return;
    for_each_box_of_planes(scene.lattice.shape, 3 * sizeof(double), [&](SiteBox const& box) {
      directions_of_sites(scene, vectors, key, box);
    });
  };
  auto const& field = scene.field;
  for (auto const& term : field.anisotropies) require(term.axes, "field.anisotropy");
  for (auto const& term : field.crystal_anisotropies)
    if (std::ranges::any_of(term.axes_of_sites, &SiteVectors::there))
      for_each_box_of_planes(scene.lattice.shape, 6 * sizeof(double),
                             [&](SiteBox const& box) { crystal_axes(scene, term, box); });
  require(field.dmi_normals, "field.dmi");
  if (auto const& torque = field.torque.slonczewski)
    require(torque->polarizations, "torque.slonczewski.polarization");
}

std::vector<std::array<std::int64_t, 2>> regions_of_bonds(Scene const& scene, SiteBox const& box,
                                                          std::size_t axis) {
  auto const& lattice = scene.lattice;
  auto const own = regions(scene, box);
  // The plane that follows the box along the axis.
  auto behind = box;
  behind.begin[axis] = (box.begin[axis] + box.extent[axis]) % lattice.shape[axis];
  behind.extent[axis] = 1;
  bool const is_open = behind.begin[axis] == 0 && lattice.boundary[axis] == BoundaryKind::open;
  auto const further = regions(scene, behind);
  std::vector<std::array<std::int64_t, 2>> pairs(own.size());
  for_each_site(box, [&](std::array<std::int64_t, 3> const& at) {
    auto next = at;
    bool const is_last = ++next[axis] == box.extent[axis];
    if (is_last) next[axis] = 0;
    auto const here = own[number_in(box, at)];
    pairs[number_in(box, at)] = {here, !is_last  ? own[number_in(box, next)]
                                       : is_open ? here
                                                 : further[number_in(behind, next)]};
  });
  return pairs;
}

std::vector<std::array<std::int64_t, 2>> regions_across(Scene const& scene, SiteBox const& box,
                                                        std::size_t axis, std::int64_t reach) {
  auto const& [nx, ny, nz] = box.extent;
  std::vector<std::array<std::int64_t, 2>> pairs(static_cast<std::size_t>(nx * ny * nz), {-1, -1});
  if (std::abs(reach) >= scene.lattice.shape[axis]) return pairs;
  NumbersAlong<std::int64_t> const region_at(
      scene.lattice, box, axis, reach, -1,
      [&](SiteBox const& part) { return regions_of_spins(scene, part); });
  for_each_site(box, [&](std::array<std::int64_t, 3> const& at) {
    auto const here = region_at(at);
    auto other = at;
    std::int64_t there = -1;
    for (std::int64_t distance = 0; distance < std::abs(reach) && there < 0; ++distance) {
      other[axis] += reach > 0 ? 1 : -1;
      there = region_at(other);
    }
    bool const is_nearest = other[axis] == at[axis] + reach;
    if (here >= 0 && there >= 0 && is_nearest) pairs[number_in(box, at)] = {here, there};
  });
  return pairs;
}

std::vector<double> numbers_across(Scene const& scene, SiteNumbers const& numbers,
                                   std::string_view key, SiteBox const& box, std::size_t axis,
                                   std::int64_t reach) {
  NumbersAlong<double> const number_at(
      scene.lattice, box, axis, reach, 0,
      [&](SiteBox const& part) { return numbers_of_sites(scene, numbers, key, part); });
  std::vector<double> values;
  for_each_site(box, [&](std::array<std::int64_t, 3> at) {
    at[axis] += reach;
    values.push_back(number_at(at));
  });
  return values;
}

std::int64_t reach_of_interlayers(Scene const& scene) {
  std::int64_t reach = 0;
  for (auto const& bond : scene.field.interlayers)
    if (bond.range > 0) reach = std::max(reach, bond.range + 1);
  return reach;
}

}  // namespace cayspin::inline v0_2::io
