// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "random_bits.hpp"
#include "site_expression.hpp"
#include "start.hpp"
#include "start_file.hpp"

#include <cayspin/io/scene.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cayspin::inline v0_1::io {
namespace {

using Site = std::array<std::int64_t, 3>;

Site site_at(SiteBox const& box, std::size_t number) {
  auto const n = static_cast<std::int64_t>(number);
  auto const& [nx, ny, nz] = box.extent;
  return {box.begin[0] + n % nx, box.begin[1] + n / nx % ny, box.begin[2] + n / nx / ny};
}

struct Start {
  Scene const& scene;
  SiteBox const& box;
  std::vector<unsigned char> const& occupied;
  std::vector<double>& spins;

  std::size_t size() const { return spins.size() / 3; }
  // A site without a spin has the zero vector.
  bool is_vacant(std::size_t site) const { return !occupied.empty() && !occupied[site]; }
  void set(std::size_t site, Triple const& m) const {
    if (is_vacant(site)) return;
    std::copy_n(m.data(), 3, spins.begin() + static_cast<std::ptrdiff_t>(3 * site));
  }

  // The site and its spin go into the message.
  void set_normalised(std::size_t site, Triple const& m, std::string_view key) const {
    if (is_vacant(site)) return;
    if (auto const unit = detail::normalise(m)) {
      set(site, *unit);
      return;
    }
    auto const [i, j, plane] = site_at(box, site);
    auto const sites = static_cast<std::int64_t>(scene.lattice.basis.size());
    auto const where = sites == 1 ? fmt::format("site ({}, {}, {})", i, j, plane)
                                  : fmt::format("site {} of cell ({}, {}, {})", plane % sites, i, j,
                                                plane / sites);
    throw scene_error(
        scene, key,
        fmt::format("the spin of {} is ({}, {}, {}); accepted: a finite vector that is not zero",
                    where, m[0], m[1], m[2]));
  }

  void operator()(UniformStart const& uniform) const {
    for (std::size_t site = 0; site < size(); ++site) set(site, uniform.direction);
  }

  void operator()(ExpressionStart const& start) const {
    std::vector<Expression> components;
    for (auto const& text : start.components) {
      components.push_back(detail::site_expression(text, scene));
    }
    for (std::size_t site = 0; site < size(); ++site) {
      auto const variables = detail::site_values(scene.lattice, site_at(box, site));
      Triple m;
      try {
        for (std::size_t c = 0; c < 3; ++c) m[c] = components[c](variables.data());
      } catch (std::runtime_error const& error) {
        throw scene_error(scene, "initial.expression", error.what());
      }
      set_normalised(site, m, "initial.expression");
    }
  }

  // Uniform on the sphere: z and the azimuth are uniform (Archimedes).
  void operator()(RandomStart const& random) const {
    auto const seed = static_cast<std::uint64_t>(random.seed);
    auto const& shape = scene.lattice.shape;
    for (std::size_t site = 0; site < size(); ++site) {
      auto const [i, j, k] = site_at(box, site);
      auto const counter = static_cast<std::uint64_t>((k * shape[1] + j) * shape[0] + i);
      double const z = 2 * detail::random_number(seed, 2 * counter) - 1;
      double const azimuth = 2 * std::numbers::pi * detail::random_number(seed, 2 * counter + 1);
      double const radius = std::sqrt((1 - z) * (1 + z));
      set_normalised(site, {radius * std::cos(azimuth), radius * std::sin(azimuth), z},
                     "initial.random");
    }
  }

  void operator()(FileStart const& file) const {
    std::vector<double> values;
    try {
      values = detail::read_start_file(file.path, scene.lattice, box);
    } catch (std::runtime_error const& error) {
      throw scene_error(scene, "initial.file", error.what());
    }
    set_all(values, "initial.file");
  }

  void operator()(GivenStart const& start) const {
    auto const numbers = 3 * static_cast<std::size_t>(sites(scene));
    if (start.spins->size() != numbers)
      throw scene_error(scene, "initial.given",
                        fmt::format("{} numbers were given; accepted: {}, three for each site",
                                    start.spins->size(), numbers));
    set_all(numbers_in(box, scene.lattice.shape, 3, *start.spins), "initial.given");
  }

  void set_all(std::vector<double> const& values, std::string_view key) const {
    for (std::size_t site = 0; site < size(); ++site) {
      auto const* const m = values.data() + 3 * site;
      set_normalised(site, {m[0], m[1], m[2]}, key);
    }
  }
};

}  // namespace

std::vector<double> initial_spins(Scene const& scene) {
  return initial_spins(scene, {{0, 0, 0}, scene.lattice.shape});
}

std::vector<double> initial_spins(Scene const& scene, SiteBox const& box) {
  auto const& [nx, ny, nz] = box.extent;
  std::vector<double> spins(3 * static_cast<std::size_t>(nx * ny * nz));
  auto const occupied = io::occupied(scene, box);
  std::visit(Start{scene, box, occupied, spins}, scene.initial);
  return spins;
}

}  // namespace cayspin::inline v0_1::io
