// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "site_numbers.hpp"

#include "hdf5/read_in_child.hpp"
#include "hdf5/real_dataset.hpp"
#include "site_expression.hpp"

#include <cayspin/io/scene.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <stdexcept>

namespace cayspin::inline v0_1::io {
namespace {

// /values (nz, ny, nx), or (site, nz, ny, nx) of a crystal.
class ValuesOfSites {
 public:
  ValuesOfSites(std::filesystem::path const& path, Lattice const& lattice)
      : shape_(lattice.shape),
        sites_(static_cast<std::int64_t>(lattice.basis.size())),
        dataset_(path, "/values") {
    std::vector<hsize_t> expected;
    for (auto const extent : {sites_, shape_[2] / sites_, shape_[1], shape_[0]})
      expected.push_back(static_cast<hsize_t>(extent));
    if (sites_ == 1) expected.erase(expected.begin());
    if (dataset_.extents() != Extents(expected.begin(), expected.end()))
      dataset_.refuse_extents(fmt::format("({})", fmt::join(expected, ", ")));
  }

  std::vector<double> in(SiteBox const& box) const {
    if (sites_ == 1)
      return dataset_.read(extents({box.begin[2], box.begin[1], box.begin[0]}),
                           extents({box.extent[2], box.extent[1], box.extent[0]}));
    std::vector<double> numbers;
    for (auto plane = box.begin[2]; plane < box.begin[2] + box.extent[2]; ++plane) {
      auto const of_plane =
          dataset_.read(extents({plane % sites_, plane / sites_, box.begin[1], box.begin[0]}),
                        extents({1, 1, box.extent[1], box.extent[0]}));
      numbers.insert(numbers.end(), of_plane.begin(), of_plane.end());
    }
    return numbers;
  }

 private:
  static Extents extents(std::initializer_list<std::int64_t> numbers) {
    return Extents(numbers.begin(), numbers.end());
  }

  std::array<std::int64_t, 3> shape_;
  std::int64_t sites_;
  RealDataset dataset_;
};

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
        try {
          values.push_back(expression(variables.data()));
        } catch (std::runtime_error const& error) {
          throw scene_error(scene, key, error.what());
        }
      }
  return values;
}

// Before they are multiplied by their unit.
std::vector<double> typed_numbers(Scene const& scene, SiteNumbers const& numbers,
                                  std::string_view key, SiteBox const& box) {
  if (numbers.given) {
    if (std::ssize(*numbers.given) != sites(scene))
      throw scene_error(scene, key,
                        fmt::format("{} numbers were given; accepted: {}, one for each site",
                                    numbers.given->size(), sites(scene)));
    if (!are_finite(*numbers.given))
      throw scene_error(scene, key, "a number that was given is not finite");
    return numbers_in(box, scene.lattice.shape, 1, *numbers.given);
  }
  if (numbers.file.empty()) return values_at_sites(scene, numbers.expression, key, box);
  try {
    auto values = read_guarded(numbers.file,
                               [&] { return ValuesOfSites(numbers.file, scene.lattice).in(box); });
    if (!are_finite(values))
      throw std::runtime_error(numbers.file.string() + ": a value is not finite");
    return values;
  } catch (std::runtime_error const& error) {
    throw scene_error(scene, key, error.what());
  }
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
    table.accept_only({given ? "given" : "file"});
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
  return number(item, "a finite number, " + accepted_site_numbers(scene.lattice));
}

void check_site_numbers(Scene const& scene) {
  auto const check = [&](SiteNumbers const& numbers, std::string_view key) {
    if (numbers.file.empty()) return;
    key = numbers.key_or(key);
    try {
      try_in_child(numbers.file, [&] { ValuesOfSites(numbers.file, scene.lattice); });
    } catch (std::runtime_error const& error) {
      throw scene_error(scene, key, error.what());
    }
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
