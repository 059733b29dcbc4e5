// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "initial_state.hpp"
#include "io/counted.hpp"
#include "random_bits.hpp"
#include "sections.hpp"
#include "site_expression.hpp"
#include "start_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cayspin::inline v0_2::io::detail {
namespace {

ExpressionStart read_expressions(Item const& item, Lattice const& lattice) {
  constexpr std::string_view accepted = "three strings, each an expression in x, y, z, i, j, k";
  return {three(item, accepted, [&](Item const& each) {
    auto text = string(each, accepted);
    try {
      site_expression(text, lattice);
    } catch (std::invalid_argument const& error) {
      each.fail(error.what());
    }
    return text;
  })};
}

RandomStart read_random(Item const& item, Scene& scene) {
  constexpr std::string_view accepted = "a whole number >= 0";
  Table const table(item, scene);
  table.accept_only({"seed"});
  return {integer(table.required("seed", accepted), {accepted, 0})};
}

GivenStart read_given(Item const& item, Scene const& scene) {
  constexpr std::string_view accepted =
      "uniform, expression, random, file or state (the first frame of the run's file holds these "
      "spins)";
  if (!boolean(item)) item.fail("false has no meaning", "true, or another key");
  if (!scene.given.spins)
    item.fail("stands for spins that a program gives, and none did", accepted);
  return {scene.given.spins};
}

}  // namespace

Initial read_initial(Table const& root) {
  constexpr std::string_view accepted = "exactly one of uniform, expression, random, file, state";
  auto const table = root.table("initial", "a table [initial]");
  if (auto const state = table.find("state")) return read_initial_state(table, *state);
  // `given` is set by a program for its own spins; users do not type it.
  if (!table.contains("given"))
    table.accept_only({"uniform", "expression", "random", "file", "state"});
  if (auto const count = table.item().node->as_table()->size(); count != 1) {
    table.item().fail(fmt::format("has {} keys", count), accepted);
  }
  if (auto const item = table.find("uniform")) return UniformStart{direction(*item)};
  if (auto const item = table.find("expression"))
    return read_expressions(*item, root.scene().lattice);
  if (auto const item = table.find("random")) return read_random(*item, root.scene());
  if (auto const item = table.find("given")) return read_given(*item, root.scene());
  return FileStart{input_file(table, "file", "the name of an HDF5 or OVF file")};
}

}  // namespace cayspin::inline v0_2::io::detail

namespace cayspin::inline v0_2::io {
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
  // Returns true for a site without a spin, which has the zero vector.
  bool is_vacant(std::size_t site) const { return !occupied.empty() && !occupied[site]; }
  void set(std::size_t site, Triple const& m) const {
    if (is_vacant(site)) return;
    std::copy_n(m.data(), 3, spins.begin() + static_cast<std::ptrdiff_t>(3 * site));
  }

  // Stores m / |m|. Errors name the site and m.
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
    detail::refuse(scene, key,
                   fmt::format("the spin of {} is ({}, {}, {})", where, m[0], m[1], m[2]),
                   key != "initial.given" || scene.lattice.occupied.there()
                       ? "a finite vector that is not zero"
                       : "a finite vector that is not zero, or lattice.occupied that is 0 there");
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
      detail::for_key(scene, "initial.expression", [&] {
        for (std::size_t c = 0; c < 3; ++c) m[c] = components[c](variables.data());
      });
      set_normalised(site, m, "initial.expression");
    }
  }

  void operator()(InitialState const& state) const {
    for (std::size_t site = 0; site < size(); ++site)
      set_normalised(site, detail::spin_of_state(state, scene.lattice, site_at(box, site)),
                     "initial.state");
  }

  // Draws each spin uniformly from the sphere: z and the azimuth are uniform (Archimedes).
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
    auto const read = [&] { return detail::read_start_file(file.path, scene.lattice, box); };
    auto const values = detail::for_key(scene, "initial.file", read);
    require_shape(values, file.path.lexically_proximate(scene.path.parent_path()).string());
    set_all(values, "initial.file");
  }

  void operator()(GivenStart const& start) const {
    auto const numbers = 3 * static_cast<std::size_t>(sites(scene));
    if (start.spins->size() != numbers)
      detail::refuse(scene, "initial.given",
                     fmt::format("{} numbers were given", start.spins->size()),
                     fmt::format("{}, three for each site", numbers));
    set_all(numbers_in(box, scene.lattice.shape, 3, *start.spins), "initial.given");
  }

  // Zero vectors in the file mean sites without a spin. Refuses them on sites that lattice.occupied
  // fills.
  void require_shape(std::vector<double> const& values, std::string const& name) const {
    if (occupied.empty()) return;
    std::int64_t there = 0, zeros = 0;
    for (std::size_t site = 0; site < size(); ++site) {
      auto const* const m = values.data() + 3 * site;
      there += occupied[site];
      zeros += occupied[site] && m[0] == 0 && m[1] == 0 && m[2] == 0;
    }
    if (zeros > 0)
      detail::refuse(scene, "initial.file",
                     fmt::format("is zero on {} of the {} that lattice.occupied fills", zeros,
                                 counted(there, "site")),
                     fmt::format("lattice.occupied = {{ file = \"{}\" }}, or no such key", name));
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

}  // namespace cayspin::inline v0_2::io
