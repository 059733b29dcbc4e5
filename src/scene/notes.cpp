// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "io/notes.hpp"

#include "io/counted.hpp"
#include "io/ovf.hpp"
#include "sections.hpp"

#include <cayspin/demagnetization/images.hpp>
#include <cayspin/shells.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace cayspin::inline v0_2::io {
namespace {

using Cells = std::array<std::int64_t, 3>;

// Larger lattices are not searched site by site, which would take too long.
constexpr std::int64_t most_sites_counted = 10'000'000;

class Notes {
 public:
  explicit Notes(Scene const& scene) : scene_(scene), cells_(scene.lattice.shape) {
    cells_[2] /= static_cast<std::int64_t>(scene.lattice.basis.size());
  }

  std::vector<std::string> operator()() {
    of_motion();
    of_neighbours();
    of_images();
    of_couplings();
    if (sites(scene_) <= most_sites_counted) of_sites();
    of_mesh();
    if (scene_.units.si) of_magnitudes();
    return std::move(lines_);
  }

 private:
  void add(std::string_view key, std::string_view message) {
    lines_.emplace_back(scene_error(scene_, key, message).what());
  }

  bool has_neighbours(std::size_t axis) const { return cells_[axis] > 1; }
  bool is_periodic(std::size_t axis) const {
    return scene_.lattice.boundary[axis] == BoundaryKind::periodic;
  }
  /// Returns true if wanted(axis) is true for an axis along which cells have neighbours.
  bool any_axis(auto const& wanted) const {
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (has_neighbours(axis) && wanted(axis)) return true;
    return false;
  }

  void of_motion() {
    auto const& [system, field] = std::tie(scene_.system, scene_.field);
    if (!system.precession && system.damping == 0 && !system.dampings.there() && !has_torque(field))
      add("system.precession", "false with damping = 0: no spin moves");
    if (field.mu0 != 1 && !field.applied && field.applied_in_turn.empty() &&
        field.sources.empty() && !field.slab_demag && !field.demag)
      add("field.mu0", "acts nowhere: there is no applied, sources, slab_demag, demag or dipoles");
  }

  void of_neighbours() {
    auto const& field = scene_.field;
    bool const si = scene_.units.si;
    auto const any = [](std::size_t) { return true; };
    constexpr std::string_view alone = "acts nowhere: no cell has a neighbour";
    if (field.exchange && field.exchange->constant != 0 && !any_axis(any))
      add(!si ? "field.exchange" : scene_.material->atomistic ? "material.J" : "material.A", alone);
    if (field.bulk_dmi && field.bulk_dmi->constant != 0 && !any_axis(any))
      add(si ? "material.D_bulk" : "field.dmi", alone);
    if (field.d2d_dmi) {
      auto const in_plane = [](std::size_t axis) { return axis < 2; };
      if (!any_axis(in_plane))
        add(si ? "material.D2d" : "field.dmi",
            any_axis(any) ? "acts nowhere: cells have neighbours only along z" : alone);
    }
    if (field.dmi && field.dmi->interfacial != 0) {
      auto const across = [&](std::size_t axis) {
        return std::abs(field.dmi->normal[axis]) < 1 - 1e-12;
      };
      if (!any_axis(across))
        add(si ? "material.D" : "field.dmi",
            any_axis(any) ? "acts nowhere: cells have neighbours only along the normal" : alone);
    }
    if (sites(scene_) <= most_sites_counted) of_bonds_between_regions();
    if (auto const& current = field.torque.zhang_li) {
      auto const flows = [&](std::size_t axis) {
        auto const* const number = std::get_if<double>(&current->velocity[axis]);
        return number == nullptr || *number != 0;
      };
      if (!any_axis(flows))
        add("torque.zhang_li", "acts nowhere: no cell has a neighbour along the current");
    }
  }

  /// Returns true if, somewhere in the lattice, `range` cells without a spin lie between a spin of
  /// one of these regions and a spin of the other.
  bool meet(std::array<std::int64_t, 2> const& regions, std::int64_t range) const {
    return any_axis([&](std::size_t axis) {
      auto const pairs = regions_across(scene_, {{0, 0, 0}, scene_.lattice.shape}, axis, range + 1);
      return std::ranges::any_of(
          pairs, [&](auto const& pair) { return std::ranges::is_permutation(pair, regions); });
    });
  }

  void of_bonds_between_regions() {
    auto const note = [&](std::string_view key, std::array<std::int64_t, 2> const& regions,
                          std::int64_t range) {
      if (meet(regions, range)) return;
      auto const which =
          fmt::format("acts nowhere: no spins of regions {} and {} ", regions[0], regions[1]);
      add(key, which + (range == 0 ? "are neighbours"
                                   : fmt::format("have {} without a spin between them",
                                                 counted(range, "cell"))));
    };
    for (auto const& bond : scene_.field.interlayers)
      note("field.interlayer", bond.regions, bond.range);
    for (auto const& bond : scene_.field.exchange_between)
      note("field.exchange_between", bond.regions, 0);
  }

  void of_images() {
    if (!scene_.field.demag) return;
    auto const& name = scene_.field.demag->key;
    auto const key = fmt::format("field.{}.periodic_images", name);
    if (!scene_.places.contains(key)) return;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!has_neighbours(axis)) continue;
      auto const images = scene_.field.demag->periodic_images[axis];
      if (images > 0 && !is_periodic(axis))
        add(key, fmt::format("images along {}, where lattice.boundary is open: only {} sees them",
                             "xyz"[axis], name));
      if (images == 0 && is_periodic(axis))
        add(key, fmt::format("no images along {}, where lattice.boundary is periodic: {} sees "
                             "ends there",
                             "xyz"[axis], name));
    }
  }

  bool leaves(Coupling const& coupling) const {
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (!is_periodic(axis) && std::abs(coupling.offset[axis]) >= cells_[axis]) return true;
    return false;
  }
  bool comes_back(Coupling const& coupling) const {
    if (coupling.between[0] != coupling.between[1]) return false;
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (coupling.offset[axis] % cells_[axis] != 0) return false;
    return true;
  }

  double length(Coupling const& coupling) const {
    auto const made = crystal(scene_.lattice);
    auto const [i, j, k] = coupling.offset;
    auto const here = made.position({0, 0, 0}, static_cast<std::size_t>(coupling.between[0])),
               there = made.position({i, j, k}, static_cast<std::size_t>(coupling.between[1]));
    double square = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
      square += std::pow((there[axis] - here[axis]) * scene_.lattice.spacing[axis], 2);
    return std::sqrt(square);
  }

  void of_couplings() {
    auto const bonds = couplings(scene_);
    if (bonds.empty()) return;
    if (!scene_.field.couplings_file.empty()) {
      if (std::ranges::all_of(bonds, [&](auto const& bond) { return leaves(bond); }))
        add("field.couplings.file", "acts nowhere: no bond of it fits into the lattice");
      return;
    }
    auto const first = look_at_shells(bonds);
    for (std::size_t i = first; i < bonds.size(); ++i)
      if (comes_back(bonds[i]))
        add(key_of_bond(i), "couples each site to itself, once around the periodic lattice");
  }

  std::string key_of_bond(std::size_t bond) const {
    constexpr auto pairs = "field.couplings.pairs";
    return scene_.places.contains(pairs) ? pairs : fmt::format("field.couplings[{}]", bond);
  }

  std::size_t shells() const {
    if (!scene_.places.contains("field.couplings.shells")) return 0;
    auto const document = toml::parse(scene_.text);
    auto const typed = document.at_path("field.couplings.shells");
    auto const* const with_unit = typed.as_table();  // { meV = [..] }
    auto const* const numbers =
        with_unit == nullptr ? typed.as_array() : with_unit->begin()->second.as_array();
    return numbers == nullptr ? 0 : numbers->size();
  }

  // Adds a note for each shell that does not fit into the lattice. Returns how many of the bonds
  // belong to shells: these come first, nearest shell first.
  std::size_t look_at_shells(std::vector<Coupling> const& bonds) {
    auto const count = shells();
    std::size_t first = 0, next = 0;
    for (std::size_t shell = 0; shell < count && first < bonds.size(); first = next, ++shell) {
      double const shortest = length(bonds[first]);
      bool fits = false;
      for (next = first;
           next < bonds.size() && length(bonds[next]) <= shortest * (1 + same_distance); ++next)
        fits = fits || !(leaves(bonds[next]) || comes_back(bonds[next]));
      if (!fits)
        add("field.couplings.shells",
            fmt::format("entry {}, for pairs {:.6g}{} apart, acts nowhere: no such pair fits into "
                        "the lattice",
                        shell, shortest * scene_.units.length, scene_.units.si ? " m" : ""));
    }
    return first;
  }

  // Counts the sites that lattice.occupied leaves empty, whatever their moments.
  std::int64_t zeros_of_occupied() const {
    auto by_key = scene_;
    by_key.lattice.moments.clear();
    by_key.lattice.moments_of_sites = {};
    auto const& [nx, ny, nz] = by_key.lattice.shape;
    std::int64_t zeros = 0;
    for (std::int64_t plane = 0; plane < nz; ++plane)
      zeros += std::ranges::count(occupied(by_key, {{0, 0, plane}, {nx, ny, 1}}), 0);
    return zeros;
  }

  void of_sites() {
    auto const& lattice = scene_.lattice;
    auto const count = lattice.basis.size();
    if (!has_vacancies(scene_) && !lattice.frozen.there()) return;
    std::vector<std::int64_t> spins(count), moving(count);
    auto const& [nx, ny, nz] = lattice.shape;
    for (std::int64_t plane = 0; plane < nz; ++plane) {
      SiteBox const box{{0, 0, plane}, {nx, ny, 1}};
      auto const there = occupied(scene_, box), held = frozen(scene_, box);
      auto const kind = static_cast<std::size_t>(plane) % count;
      for (std::size_t site = 0; site < static_cast<std::size_t>(nx * ny); ++site) {
        bool const has_spin = there.empty() || there[site];
        spins[kind] += has_spin;
        moving[kind] += has_spin && (held.empty() || !held[site]);
      }
    }
    of_counts(spins, moving);
  }

  void of_counts(std::vector<std::int64_t> const& spins, std::vector<std::int64_t> const& moving) {
    auto const& lattice = scene_.lattice;
    auto const total = [](auto const& of) {
      std::int64_t sum = 0;
      for (auto const each : of) sum += each;
      return sum;
    };
    auto const all = sites(scene_), there = total(spins), free = total(moving);
    if (lattice.occupied.there()) {
      bool const moments_may_be_zero =
          lattice.moments_of_sites.there() || std::ranges::count(lattice.moments, 0.0) > 0;
      auto const zeros = moments_may_be_zero ? zeros_of_occupied() : all - there;
      if (zeros > 0 && is_shape_of_start())
        add("initial.file",
            fmt::format("zero vectors are sites without a spin, {} of {}", zeros, all));
      else if (zeros == 0)
        add("lattice.occupied", "is 0 nowhere: every site has a spin");
    }
    if (lattice.frozen.there() && free == there)
      add("lattice.frozen", "holds no spin");
    else if (lattice.frozen.there() && free == 0)
      add("lattice.frozen", "holds every spin: nothing moves");
    auto const is_empty = [&](int site) {
      return site >= 0 && spins[static_cast<std::size_t>(site)] == 0;
    };
    constexpr std::string_view nowhere = "acts nowhere: no cell has a spin on site {}";
    for (auto const* const list : {&scene_.field.anisotropies})
      for (auto const& term : *list)
        if (is_empty(term.site))
          add("field.anisotropy", fmt::format(fmt::runtime(nowhere), term.site));
    for (auto const& term : scene_.field.crystal_anisotropies)
      if (is_empty(term.site))
        add("field.anisotropy", fmt::format(fmt::runtime(nowhere), term.site));
    if (!scene_.places.contains("field.couplings.shells"))
      for (std::size_t i = 0; i < scene_.field.couplings.size(); ++i)
        for (int const site : scene_.field.couplings[i].between)
          if (is_empty(site)) {
            add(key_of_bond(i), fmt::format(fmt::runtime(nowhere), site));
            break;
          }
  }

  bool is_shape_of_start() const {
    auto const* const start = std::get_if<FileStart>(&scene_.initial);
    return start != nullptr && scene_.lattice.occupied.file == start->path;
  }

  // Adds a note if the cells of an OVF start file differ in size from those of the lattice. Spins
  // are assigned by index, whatever the size.
  void of_mesh() {
    auto const* const start = std::get_if<FileStart>(&scene_.initial);
    if (start == nullptr || !scene_.units.si || !is_ovf(start->path)) return;
    auto const mesh =
        detail::for_key(scene_, "initial.file", [&] { return read_ovf_mesh(start->path); });
    if (mesh.unit != "m") return;
    std::array<double, 3> edges{};
    for (std::size_t axis = 0; axis < 3; ++axis)
      edges[axis] = scene_.lattice.spacing[axis] * scene_.units.length;
    auto const differs = [&](std::size_t axis) {
      return std::abs(mesh.step[axis] - edges[axis]) > 1e-4 * edges[axis];
    };
    if (any_axis(differs))
      add("initial.file", fmt::format("its cells are {:.6g} m, and lattice.spacing is {:.6g} m",
                                      fmt::join(mesh.step, " x "), fmt::join(edges, " x ")));
  }

  /// Adds notes for values that look as if typed in other units.
  void of_magnitudes() {
    auto const& material = *scene_.material;
    auto const look = [&](std::string_view key, double value, double least, double most,
                          std::string_view meaning) {
      if (value != 0 && !(std::abs(value) >= least && std::abs(value) <= most))
        add(key, fmt::format("{:.6g} {}", value, meaning));
    };
    // With site-dependent factors, the constant is only their unit.
    double const exchange =
        scene_.field.exchange_factors.there() ? 0 : material.exchange.value_or(0);
    look("material.gamma", material.gamma, 1e9, 1e13,
         "rad/(s T) is far from an electron's 1.76e11; in m/(A s) that is 2.21e5");
    if (material.atomistic) {
      look("material.mu_s", material.moment, 1e-26, 1e-20,
           "J/T is far from a Bohr magneton, 9.274e-24 J/T");
      look("material.J", exchange, 0, 1e-18,
           "J is far above the exchange between two spins; 1 meV is 1.602e-22 J");
    } else {
      look("material.Ms", material.moment, 100, 1e7,
           "A/m is far from the Ms of magnets; mu0 Ms = 1 T is 7.96e5 A/m");
      look("material.A", exchange, 0, 1e-9, "J/m is far above the A of magnets, about 1e-11 J/m");
    }
    for (double const edge : scene_.lattice.spacing)
      if (edge * scene_.units.length > 1e-4)
        return add("lattice.spacing", fmt::format("{:.6g} m is large for a cell; 1 nm is 1e-9 m",
                                                  edge * scene_.units.length));
  }

  Scene const& scene_;
  Cells cells_;
  std::vector<std::string> lines_;
};

}  // namespace

std::vector<std::string> notes(Scene const& scene) {
  if (scene.system.kind != SystemKind::llg) return {};
  return Notes(scene)();
}

}  // namespace cayspin::inline v0_2::io
