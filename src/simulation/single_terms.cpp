// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "single_terms.hpp"

#include "io/free_sides.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace cayspin::simulation {

namespace {

// With dipoles, each site has its own moment. A scene with only another term has no dipoles, but
// must keep these moments.
void keep_moments_of_sites(io::Scene const& scene, io::Lattice& lattice) {
  if (!io::has_moments_of_sites(scene) || lattice.moments_of_sites.there()) return;
  lattice.moments_of_sites = {};  // all_moments() is in reduced units, whatever the scene's unit
  lattice.moments_of_sites.key = "lattice.moments";
  lattice.moments_of_sites.given = std::make_shared<std::vector<double> const>(
      io::all_moments(scene, {{0, 0, 0}, scene.lattice.shape}));
}

}  // namespace

void keep_numbers_of_free_sides(io::Scene const& scene, std::vector<io::Anisotropy>& terms) {
  for (auto& term : terms) {
    if (!io::is_of_free_sides(term.factors)) continue;
    auto numbers = io::numbers_of_sites(scene, term.factors, "field.anisotropy",
                                        {{0, 0, 0}, scene.lattice.shape});
    io::SiteNumbers kept;
    kept.key = term.factors.key;
    kept.given = std::make_shared<std::vector<double> const>(std::move(numbers));
    term.factors = kept;
  }
}

std::vector<std::pair<std::string, io::Scene>> single_terms(io::Scene const& scene) {
  auto const& field = scene.field;
  std::vector<std::pair<std::string, io::Scene>> terms;
  auto const add = [&](std::string_view name) -> io::Field& {
    terms.emplace_back(name, scene);
    auto& alone = terms.back().second.field;
    alone = {};
    alone.mu0 = field.mu0;
    alone.exchange_factors = field.exchange_factors;
    alone.dmi_factors = field.dmi_factors;
    alone.dmi_normals = field.dmi_normals;
    alone.exchange_between = field.exchange_between;
    alone.in_time = field.in_time;
    return alone;
  };
  std::apply(
      [&](auto... member) {
        auto const add_lattice_term = [&](auto one) {
          using Term = typename std::remove_cvref_t<decltype(field.*one)>::value_type;
          if (field.*one) add(Term::key).*one = field.*one;
        };
        (add_lattice_term(member), ...);
      },
      io::Field::lattice_terms);
  if (field.d2d_dmi) add("dmi").d2d_dmi = field.d2d_dmi;
  if (!field.interlayers.empty()) {
    auto& alone = add("interlayer");
    alone.interlayers = field.interlayers;
    alone.exchange_at_faces = field.exchange_at_faces;
  }
  if (!field.couplings.empty() || !field.couplings_file.empty()) {
    auto& alone = add("couplings");
    alone.couplings = field.couplings;
    alone.couplings_file = field.couplings_file;
    alone.couplings_scale = field.couplings_scale;
    alone.has_couplings_scale = field.has_couplings_scale;
  }
  auto anisotropies = field.anisotropies;
  auto const at_free_sides = std::ranges::stable_partition(
      anisotropies, [](auto const& term) { return !io::is_of_free_sides(term.factors); });
  if (!at_free_sides.empty()) {
    auto const dmi = std::ranges::find(terms, "dmi", [](auto const& term) { return term.first; });
    dmi->second.field.anisotropies.assign(at_free_sides.begin(), at_free_sides.end());
    keep_numbers_of_free_sides(scene, dmi->second.field.anisotropies);
  }
  anisotropies.erase(at_free_sides.begin(), at_free_sides.end());
  if (!anisotropies.empty() || !field.crystal_anisotropies.empty()) {
    auto& alone = add("anisotropy");
    alone.anisotropies = anisotropies;
    alone.crystal_anisotropies = field.crystal_anisotropies;
  }
  if (field.applied) add("applied").applied = field.applied;
  if (!field.sources.empty()) add("sources").sources = field.sources;
  if (field.own.uniform) add("applied").own.uniform = field.own.uniform;
  if (field.slab_demag) add("slab_demag").slab_demag = field.slab_demag;
  if (field.demag) add(field.demag->key).demag = field.demag;
  if (field.own.nonlocal) {
    add("nonlocal").own.nonlocal = field.own.nonlocal;
    keep_moments_of_sites(scene, terms.back().second.lattice);
  }
  for (auto& [name, alone] : terms) {
    auto& of_alone = alone.field;
    if (!of_alone.exchange) of_alone.exchange_factors = {}, of_alone.exchange_between.clear();
    if (!of_alone.has_dmi()) of_alone.dmi_factors = {};
  }
  return terms;
}

io::MoreScalars more_scalars(io::Scene const& scene) {
  io::MoreScalars more;
  if (scene.output.regions) more.regions = io::region_count(scene);
  if (scene.output.terms && scene.system.kind == io::SystemKind::rigid_body)
    more.terms = {"rotation"};
  else if (scene.output.terms)
    for (auto const& term : single_terms(scene)) more.terms.push_back(term.first);
  more.shift = scene.lattice.follow.has_value();
  return more;
}

void require_same_terms(io::Scene const& first, io::Scene const& scene) {
  auto const before = more_scalars(first).terms;
  if (more_scalars(scene).terms == before) return;
  throw io::scene_error(
      scene, "field",
      fmt::format("has different terms from those at the start, and output.terms stores the energy "
                  "of each; accepted: the terms {}, or output.terms = false",
                  fmt::join(before, ", ")));
}

}  // namespace cayspin::simulation
