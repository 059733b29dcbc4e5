// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "memory_of_terms.hpp"

#include "demagnetization.hpp"
#include "sites_of_cell.hpp"

#include <algorithm>
#include <cstddef>
#include <set>
#include <vector>

namespace cayspin::simulation {
namespace {

/// Numbers of stored fields.
struct Fields {
  std::int64_t scalars = 0, vectors = 0;

  void add_scalar_if(bool there) { scalars += there ? 1 : 0; }
  void add_vector_if(bool there) { vectors += there ? 1 : 0; }
};

void add_bonds(io::Field const& field, Lattice const& lattice, Fields& stored) {
  int axes = 0;
  for (int axis = 0; axis < 3; ++axis) axes += lattice.has_neighbors(axis) ? 1 : 0;
  if (field.exchange_factors.there()) stored.scalars += 1 + axes;  // constants, bonds
  if (field.dmi_factors.there()) stored.scalars += field.dmi_normals.there() ? 3 : 1;
  bool const has_faces = field.exchange_at_faces.there();
  stored.add_scalar_if(has_faces);
  constexpr int of_next = 2;                 // bilinear, biquadratic
  int const of_distant = has_faces ? 3 : 2;  // also the exchange
  constexpr int directions = 2;
  std::set<std::int64_t> ranges;
  for (auto const& bond : field.interlayers) ranges.insert(bond.range);
  for (auto const range : ranges)
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (range == 0 && lattice.has_neighbors(static_cast<int>(axis)))
        stored.scalars += of_next;
      else if (range > 0 && range + 1 < lattice.shape[axis])
        stored.scalars += directions * of_distant;
}

void add_anisotropies(io::Scene const& scene, Fields& stored) {
  auto const add_constants = [&](auto const& term) {
    stored.scalars += term.constant2 != 0 || term.factors2.there() ? 2 : 1;
  };
  for (auto const& term : scene.field.anisotropies) {
    if (term.is_plain()) continue;
    add_constants(term);
    stored.add_vector_if(term.axes.there());
  }
  for (auto const& term : scene.field.crystal_anisotropies) {
    if (term.is_plain()) continue;
    add_constants(term);
    if (term.axes_of_sites[0].there() || term.axes_of_sites[1].there()) stored.vectors += 2;
  }
  stored.add_scalar_if(slab_of_moments(scene).has_value());
}

void add_torques(io::Field const& field, Fields& stored) {
  auto const& slonczewski = field.torque.slonczewski;
  if (!slonczewski) return;
  stored.add_scalar_if(slonczewski->damping_like_of_sites.there() ||
                       slonczewski->damping_like_per_moment);
  stored.add_scalar_if(slonczewski->field_like_of_sites.there() ||
                       slonczewski->field_like_per_moment);
  stored.add_vector_if(slonczewski->polarizations.there());
}

void add_sources(io::Field const& field, Fields& stored) {
  std::vector<io::AppliedComponent> times;  // sources with equal ones are stored as one
  for (auto const& source : field.sources)
    if (std::ranges::find(times, source.time) == times.end()) times.push_back(source.time);
  stored.vectors += static_cast<std::int64_t>(times.size());
}

// Returns what FieldInPass stores.
Fields fields_of_pass(io::Scene const& scene, Lattice const& lattice) {
  auto const& field = scene.field;
  bool const has_moments = io::has_moments_of_sites(scene);
  bool const has_ratios = scene.lattice.gyromagnetic_of_sites.there();
  Fields stored{.scalars = 2, .vectors = 1};  // energies, moments, H
  stored.add_scalar_if(scene.lattice.frozen.there());
  stored.add_scalar_if(has_moments);
  stored.add_scalar_if(io::has_vacancies(scene) && !has_moments && field.exchange &&
                       !field.exchange_factors.there());
  stored.add_scalar_if(scene.system.dampings.there());
  stored.add_scalar_if(has_ratios || scene.system.gilbert_of_sites);
  stored.add_scalar_if(has_ratios && io::has_torque(field));
  stored.add_vector_if(has_moments && io::is_nonlocal(field));
  add_bonds(field, lattice, stored);
  add_anisotropies(scene, stored);
  add_torques(field, stored);
  add_sources(field, stored);
  return stored;
}

}  // namespace

template <class Real>
std::int64_t memory_of_terms(io::Scene const& scene, Lattice const& lattice) {
  auto const& field = scene.field;
  Fields stored;
  if (io::needs_pass(scene)) stored = fields_of_pass(scene, lattice);
  stored.add_vector_if(static_cast<bool>(field.own.nonlocal));
  if (auto const& columns = scene.columns) {
    stored.add_vector_if(!columns->applied.empty());
    stored.vectors += columns->constants.empty() ? 0 : 2;
    stored.add_scalar_if(!columns->dampings.empty());
  }
  auto const& slab = field.slab_demag;
  stored.add_vector_if(slab && (slab->on_host || slab->multirate));
  std::int64_t bytes = stored.scalars * field_bytes<Real>(lattice, 1) +
                       stored.vectors * field_bytes<Real>(lattice, 3);
  if (field.demag)
    bytes += field_bytes<Real>(lattice, 3) + demagnetization_bytes<Real>(*field.demag, lattice);
  return bytes;
}

template std::int64_t memory_of_terms<double>(io::Scene const&, Lattice const&);
template std::int64_t memory_of_terms<float>(io::Scene const&, Lattice const&);

}  // namespace cayspin::simulation
