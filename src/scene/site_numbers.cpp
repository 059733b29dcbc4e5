// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "dataset_of_sites.hpp"
#include "free_boundary.hpp"
#include "hdf5/guarded_reading.hpp"
#include "image.hpp"
#include "io/ovf.hpp"
#include "io/scene.hpp"
#include "ovf_of_sites.hpp"
#include "sections.hpp"
#include "site_expression.hpp"
#include "start_file.hpp"
#include "values_of_sites.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace cayspin::inline v0_2::io {
namespace {

constexpr std::size_t most_regions = 65536;

detail::DatasetOfSites open_values(std::filesystem::path const& path, Lattice const& lattice) {
  detail::DatasetOfSites values(path, "/values", lattice, 1, Accepted::numbers);
  if (!values.fits()) values.refuse_extents(fmt::format("({})", values.expected()));
  return values;
}

std::vector<double> values_of_file(std::filesystem::path const& path, Lattice const& lattice,
                                   SiteBox const& box) {
  if (is_ovf(path)) return detail::read_ovf_of_sites(path, lattice, 1, box);
  return read_guarded(path, [&] { return open_values(path, lattice).in(box); });
}

// Returns true for lattice.occupied, if its file has spins, which are zero on sites without a spin.
bool is_file_of_spins(SiteNumbers const& numbers, std::string_view key) {
  return key == "lattice.occupied" && detail::holds_spins(numbers.file);
}

bool are_finite(std::vector<double> const& values) {
  return std::ranges::all_of(values, [](double value) { return std::isfinite(value); });
}

std::vector<double> values_at_sites(Scene const& scene, std::string const& text,
                                    std::string_view key, SiteBox const& box) {
  auto const expression = detail::site_expression(text, scene);
  auto const& [nx, ny, nz] = box.extent;
  std::vector<double> values;
  values.reserve(static_cast<std::size_t>(nx * ny * nz));
  for (std::int64_t k = 0; k < nz; ++k)
    for (std::int64_t j = 0; j < ny; ++j)
      for (std::int64_t i = 0; i < nx; ++i) {
        auto const variables = detail::site_values(
            scene.lattice, {box.begin[0] + i, box.begin[1] + j, box.begin[2] + k});
        values.push_back(detail::for_key(scene, key, [&] { return expression(variables.data()); }));
      }
  return values;
}

std::vector<double> numbers_of_regions(Scene const& scene, std::vector<double> const& numbers,
                                       std::string_view key, SiteBox const& box) {
  auto const of_sites = regions(scene, box);
  std::vector<double> values(of_sites.size());
  for (std::size_t site = 0; site < values.size(); ++site) {
    auto const region = static_cast<std::size_t>(of_sites[site]);
    if (region >= numbers.size())
      throw scene_error(
          scene, key,
          fmt::format("has no number for region {}, to which {} belongs; accepted: one "
                      "for each region, from 0",
                      region, detail::site_text(box, site)));
    values[site] = numbers[region];
  }
  return values;
}

// Returns the numbers as typed, before they are multiplied by their unit.
std::vector<double> typed_numbers(Scene const& scene, SiteNumbers const& numbers,
                                  std::string_view key, SiteBox const& box) {
  if (numbers.given) {
    if (std::ssize(*numbers.given) != sites(scene))
      detail::refuse(scene, key, fmt::format("{} numbers were given", numbers.given->size()),
                     fmt::format("{}, one for each site", sites(scene)));
    if (!are_finite(*numbers.given))
      detail::refuse(scene, key, "a number that was given is not finite", "finite numbers");
    return numbers_in(box, scene.lattice.shape, 1, *numbers.given);
  }
  if (!numbers.per_region.empty()) return numbers_of_regions(scene, numbers.per_region, key, box);
  if (auto at_sides = detail::numbers_at_free_sides(scene, numbers, box)) return *at_sides;
  if (!numbers.image.empty())
    return detail::for_key(scene, key,
                           [&] { return detail::numbers_of_image(numbers, scene.lattice, box); });
  if (numbers.file.empty()) return values_at_sites(scene, numbers.expression, key, box);
  return detail::for_key(scene, key, [&] {
    if (is_file_of_spins(numbers, key))
      return detail::sites_with_spins(numbers.file, scene.lattice, box);
    auto values = values_of_file(numbers.file, scene.lattice, box);
    if (!are_finite(values))
      throw std::runtime_error(numbers.file.string() +
                               ": a value is not finite; accepted: finite numbers");
    return values;
  });
}

}  // namespace

namespace detail {
namespace {

void read_numbers_of_regions(Item const& item, Scene& scene, SiteNumbers& numbers) {
  if (!scene.lattice.regions.there())
    item.fail("stands without lattice.regions, which says the region of each site",
              "lattice.regions beside it");
  for (auto const& entry : entries(item, 1, most_regions, "a list of numbers, one for each region"))
    numbers.per_region.push_back(number(entry));
}

}  // namespace

std::string site_text(SiteBox const& box, std::size_t number) {
  auto const at = static_cast<std::int64_t>(number);
  auto const [nx, ny, nz] = box.extent;
  return fmt::format("site ({}, {}, {})", box.begin[0] + at % nx, box.begin[1] + at / nx % ny,
                     box.begin[2] + at / (nx * ny));
}

std::string accepted_site_numbers(Lattice const& lattice) {
  return fmt::format(
      "an expression in {}, {{ file = \"NAME.h5\" }}, {{ image = \"NAME.png\" }} or {{ regions = [v0, "
      "v1, ..] }}",
      fmt::join(site_variables(lattice), ", "));
}

bool are_numbers_of_sites(Item const& item) {
  auto const* const table = item.node->as_table();
  if (table == nullptr) return item.node->is_string();
  return table->contains("file") || table->contains("image") || table->contains("regions") ||
         table->contains("given");
}

bool read_site_numbers(Item const& item, Scene& scene, SiteNumbers& numbers) {
  if (item.node->is_table()) {
    Table const table(item, scene);
    if (item.node->as_table()->empty())
      item.fail("has 0 keys", accepted_site_numbers(scene.lattice));
    if (table.contains("image")) {
      read_image_keys(table, numbers);
      return true;
    }
    auto const given = table.find("given");
    // A program sets `given` for its own numbers; users do not type it.
    if (!given || item.node->as_table()->size() > 1)
      table.accept_only({"file", "image", "regions"});
    if (auto const regions = table.find("regions")) {
      if (item.node->as_table()->size() > 1) regions->fail("stands beside file", "one of the two");
      read_numbers_of_regions(*regions, scene, numbers);
    } else if (given) {
      if (!boolean(*given)) given->fail("false has no meaning", "file");
      auto const found = scene.given.numbers.find(item.key);
      if (found == scene.given.numbers.end())
        given->fail("stands for numbers that a program gives, and none did", "file");
      numbers.given = found->second;
    } else {
      numbers.file = input_file(table, "file", "the name of an HDF5 or OVF file");
    }
    return true;
  }
  if (!item.node->is_string()) return false;
  numbers.expression = string(item, accepted_site_numbers(scene.lattice));
  try {
    site_expression(numbers.expression, scene.lattice);
  } catch (std::invalid_argument const& error) {
    item.fail(error.what());
  }
  return true;
}

double number_of_sites(Item const& item, Scene& scene, SiteNumbers& numbers) {
  if (read_site_numbers(item, scene, numbers)) return 1;
  auto const accepted = "a finite number, " + accepted_site_numbers(scene.lattice);
  return number(item, {accepted});
}

void check_site_numbers(Scene const& scene) {
  auto const check = [&](SiteNumbers const& numbers, std::string_view key) {
    if (numbers.file.empty() && numbers.image.empty()) return;
    for_key(scene, numbers.key_or(key), [&] {
      if (!numbers.image.empty()) return check_image(numbers.image);
      if (is_file_of_spins(numbers, key)) return check_start_file(numbers.file, scene.lattice);
      if (is_ovf(numbers.file)) return detail::check_ovf_of_sites(numbers.file, scene.lattice, 1);
      try_reading(numbers.file, [&] { open_values(numbers.file, scene.lattice); });
    });
  };
  for_each_value_of_sites(scene, check, [&](SiteVectors const& vectors, std::string_view key) {
    check_site_vectors(scene, vectors, key);
  });
}

}  // namespace detail

std::vector<std::int64_t> regions(Scene const& scene, SiteBox const& box) {
  auto const values = typed_numbers(scene, scene.lattice.regions, "lattice.regions", box);
  std::vector<std::int64_t> regions(values.size());
  for (std::size_t site = 0; site < values.size(); ++site) {
    double const value = values[site];
    if (!(value >= 0 && value < most_regions && value == std::floor(value)))
      throw scene_error(scene, "lattice.regions",
                        fmt::format("is {} at {}; accepted: whole numbers from 0 to {}", value,
                                    detail::site_text(box, site), most_regions - 1));
    regions[site] = static_cast<std::int64_t>(value);
  }
  return regions;
}

std::int64_t region_count(Scene const& scene) {
  std::int64_t count = 0;
  for_each_box_of_planes(scene.lattice.shape, sizeof(double), [&](SiteBox const& box) {
    count = std::max(count, std::ranges::max(regions(scene, box)) + 1);
  });
  return count;
}

std::vector<double> moments_of_sites(Scene const& scene, SiteBox const& box) {
  auto const& numbers = scene.lattice.moments_of_sites;
  if (!numbers.there()) return {};
  auto values = numbers_of_sites(scene, numbers, "lattice.moments", box);
  for (std::size_t site = 0; site < values.size(); ++site)
    if (!(values[site] >= 0))
      throw scene_error(scene, numbers.key_or("lattice.moments"),
                        fmt::format("is {:.6g} at {}; accepted: numbers >= 0, 0 for no spin",
                                    values[site] / numbers.unit, detail::site_text(box, site)));
  return values;
}

std::vector<double> gyromagnetic_of_sites(Scene const& scene, SiteBox const& box) {
  auto const& numbers = scene.lattice.gyromagnetic_of_sites;
  if (!numbers.there()) return {};
  auto values = numbers_of_sites(scene, numbers, "lattice.gyromagnetic", box);
  for (std::size_t site = 0; site < values.size(); ++site)
    if (!(values[site] > 0))
      throw scene_error(scene, numbers.key_or("lattice.gyromagnetic"),
                        fmt::format("is {:.6g} at {}; accepted: numbers > 0",
                                    values[site] / numbers.unit, detail::site_text(box, site)));
  return values;
}

std::vector<double> numbers_of_sites(Scene const& scene, SiteNumbers const& numbers,
                                     std::string_view key, SiteBox const& box) {
  auto values = typed_numbers(scene, numbers, numbers.key_or(key), box);
  for (double& value : values) value *= numbers.unit;
  return values;
}

}  // namespace cayspin::inline v0_2::io
