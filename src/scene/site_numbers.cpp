// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "dataset_of_sites.hpp"
#include "free_boundary.hpp"
#include "hdf5/guarded_reading.hpp"
#include "io/scene.hpp"
#include "sections.hpp"
#include "site_expression.hpp"
#include "start_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace cayspin::inline v0_1::io {
namespace {

detail::DatasetOfSites open_values(std::filesystem::path const& path, Lattice const& lattice) {
  detail::DatasetOfSites values(path, "/values", lattice, 1);
  if (!values.fits()) values.refuse_extents(fmt::format("({})", values.expected()));
  return values;
}

// Sites are occupied where a file has spins.
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

// Before they are multiplied by their unit.
std::vector<double> typed_numbers(Scene const& scene, SiteNumbers const& numbers,
                                  std::string_view key, SiteBox const& box) {
  if (numbers.given) {
    if (std::ssize(*numbers.given) != sites(scene))
      detail::refuse(scene, key, fmt::format("{} numbers were given", numbers.given->size()),
                     fmt::format("{}, one for each site", sites(scene)));
    if (!are_finite(*numbers.given))
      throw scene_error(scene, key, "a number that was given is not finite");
    return numbers_in(box, scene.lattice.shape, 1, *numbers.given);
  }
  if (auto at_sides = detail::numbers_at_free_sides(scene, numbers, box)) return *at_sides;
  if (numbers.file.empty()) return values_at_sites(scene, numbers.expression, key, box);
  return detail::for_key(scene, key, [&] {
    if (is_file_of_spins(numbers, key))
      return detail::sites_with_spins(numbers.file, scene.lattice, box);
    auto values = read_guarded(numbers.file,
                               [&] { return open_values(numbers.file, scene.lattice).in(box); });
    if (!are_finite(values))
      throw std::runtime_error(numbers.file.string() + ": a value is not finite");
    return values;
  });
}

}  // namespace

namespace detail {

std::string accepted_site_numbers(Lattice const& lattice) {
  return fmt::format("an expression in {}, or {{ file = \"NAME.h5\" }}",
                     fmt::join(site_variables(lattice), ", "));
}

bool read_site_numbers(Item const& item, Scene& scene, SiteNumbers& numbers) {
  if (item.node->is_table()) {
    Table const table(item, scene);
    auto const given = table.find("given");
    // As in [initial].
    if (!given || item.node->as_table()->size() > 1) table.accept_only({"file"});
    if (given) {
      if (!boolean(*given)) given->fail("false has no meaning", "file");
      auto const found = scene.given.numbers.find(item.key);
      if (found == scene.given.numbers.end())
        given->fail("stands for numbers that a program gives, and none did", "file");
      numbers.given = found->second;
    } else {
      numbers.file = input_file(table, "file");
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
    if (numbers.file.empty()) return;
    for_key(scene, numbers.key_or(key), [&] {
      if (is_file_of_spins(numbers, key)) return check_start_file(numbers.file, scene.lattice);
      try_reading(numbers.file, [&] { open_values(numbers.file, scene.lattice); });
    });
  };
  auto const& field = scene.field;
  check(scene.lattice.occupied, "lattice.occupied");
  check(scene.lattice.frozen, "lattice.frozen");
  check(scene.system.dampings, "system.damping");
  check(field.exchange_factors, "field.exchange");
  check(field.dmi_factors, "field.dmi");
  for (auto const& term : field.anisotropies) check(term.factors, "field.anisotropy");
}

}  // namespace detail

std::vector<double> numbers_of_sites(Scene const& scene, SiteNumbers const& numbers,
                                     std::string_view key, SiteBox const& box) {
  auto values = typed_numbers(scene, numbers, numbers.key_or(key), box);
  for (double& value : values) value *= numbers.unit;
  return values;
}

}  // namespace cayspin::inline v0_1::io
