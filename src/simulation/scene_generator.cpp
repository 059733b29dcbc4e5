// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "scene_generator.hpp"

#include "io/scene.hpp"
#include "multirate_method.hpp"
#include "own_field_beside.hpp"
#include "row_piece.hpp"
#include "sites_of_cell.hpp"
#include "space.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

namespace cayspin::simulation {

namespace {

// Terms: SceneFieldNow<Real> or a reference to it. Loops over many packs need a copy, because the
// compiler must assume that stores of packs change values behind references.
template <bool TurningAlone, class Real, class Terms = SceneFieldNow<Real> const&>
struct StoreField {
  Terms terms;
  cayspin::detail::RowFields<Real> fields;

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Stencil const& stencil, std::ptrdiff_t i) const {
    auto h = TurningAlone ? cayspin::detail::turning_field(terms, stencil) : terms.field(stencil);
    if (terms.along_rows.evaluate) h = h + fields.template load<typename Stencil::value_type>(i);
    fields.store(h, i);
  }
};

bool has_dampings_of_columns(io::Scene const& scene) {
  return scene.columns && !scene.columns->dampings.empty();
}

// Returns a field whose site (x, y, z) has the values of column x.
template <class Spins, int Components>
SiteField<typename Spins::value_type, Components, typename Spins::memory_space> field_of_columns(
    Lattice const& lattice, std::vector<double> const& of_columns) {
  std::vector<double> values;
  auto const rows = lattice.sites() / lattice.shape[0];
  values.reserve(of_columns.size() * static_cast<std::size_t>(rows));
  for (std::int64_t row = 0; row < rows; ++row)
    values.insert(values.end(), of_columns.begin(), of_columns.end());
  SiteField<typename Spins::value_type, Components, typename Spins::memory_space> made(
      "SceneGenerator::columns", lattice);
  copy_from_host(values, made);
  return made;
}

template <class Spins>
void put_values(io::Columns const& columns, io::Field field, Lattice const& lattice,
                SceneField<Spins>& made) {
  if (!columns.applied.empty()) {
    std::vector<double> applied;
    for (auto const& of_column : columns.applied)
      for (double const component : of_column) applied.push_back(field.mu0 * component);
    made.set_applied(field_of_columns<Spins, 3>(lattice, applied));
  }
  if (columns.constants.empty()) return;
  std::vector<double> diagonal, others;
  for (std::size_t column = 0; column < columns.constants.size(); ++column) {
    columns.put_constants(column, field);
    auto const entries = quadratic_terms_of(field).entries();
    diagonal.insert(diagonal.end(), entries[0].begin(), entries[0].end());
    others.insert(others.end(), entries[1].begin(), entries[1].end());
  }
  made.set_quadratic(field_of_columns<Spins, 3>(lattice, diagonal),
                     field_of_columns<Spins, 3>(lattice, others));
}

template <class Bodies, class Real>
struct StoreGenerator {
  Bodies const& bodies;
  cayspin::detail::RowFields<Real> fields;

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Stencil const& stencil, std::ptrdiff_t i) const {
    fields.store(bodies(stencil), i);
  }
};

}  // namespace

template <class Real>
void SceneFieldNow<Real>::find_row_ends(cayspin::detail::RowOfSpins<Real> const& spins,
                                        std::int32_t begin, std::int32_t end,
                                        cayspin::detail::RowFields<Real> const& fields,
                                        bool turning_alone) const {
  if (along_rows.is_whole) return;
  RowPiece<Real> const piece{spins, begin, end, fields, has_ends()};
  if (has_values_of_sites())
    return turning_alone ? piece.for_each(StoreField<true, Real, SceneFieldNow>{*this, fields})
                         : piece.for_each(StoreField<false, Real, SceneFieldNow>{*this, fields});
  if (!has_ends()) return;
  if (turning_alone)
    piece.for_each_at_ends(StoreField<true, Real>{*this, fields});
  else
    piece.for_each_at_ends(StoreField<false, Real>{*this, fields});
}

template <class Spins>
void SceneGeneratorNow<Spins>::find_row_ends(
    cayspin::detail::RowOfSpins<typename Spins::value_type> const& row, std::int32_t begin,
    std::int32_t end, cayspin::detail::RowFields<typename Spins::value_type> const& fields,
    bool turning_alone) const {
  if (is_llg) return llg.field().find_row_ends(row, begin, end, fields, turning_alone);
  using Real = typename Spins::value_type;
  RowPiece<Real>{row, begin, end, fields}.for_each(
      StoreGenerator<decltype(bodies), Real>{bodies, fields});
}

template <class Spins>
SceneField<Spins> field_of(io::Scene const& scene, Lattice const& lattice, bool has_slow) {
  std::optional<FieldInPass<Spins>> pass;
  if (io::needs_pass(scene)) pass.emplace(scene, lattice);
  auto field = io::without_numbers_of_sites(scene.field);
  if (slab_of_moments(scene)) field.slab_demag.reset();
  std::error_code ignored;
  if (field.demag && !field.demag->dipoles && std::filesystem::is_regular_file(scene.path, ignored))
    field.demag->cache = std::filesystem::path(scene.path).replace_extension(".demag");
  field = with_joined_own_field<typename Spins::value_type>(scene, std::move(field), lattice);
  SceneField<Spins> made(field, scene.units, lattice, has_slow, std::move(pass));
  if (scene.columns) put_values(*scene.columns, field, lattice, made);
  return made;
}

template <class Spins>
SceneGenerator<Spins>::SceneGenerator(io::Scene const& scene, Lattice const& lattice)
    : SceneGenerator(scene, lattice,
                     scene.system.kind == io::SystemKind::llg ? std::vector{SymmetricTensor{}}
                                                              : io::inverse_inertia(scene)) {}

template <class Spins>
SceneGenerator<Spins>::SceneGenerator(io::Scene const& scene, Lattice const& lattice,
                                      std::vector<SymmetricTensor> const& inverse_inertia)
    : llg_(field_of<Spins>(scene, lattice, has_slow_field(scene)),
           has_dampings_of_columns(scene) ? 0 : scene.system.damping,
           scene.system.precession || scene.system.dampings.there() ||
               has_dampings_of_columns(scene)),
      is_llg_(scene.system.kind == io::SystemKind::llg),
      orthogonal_(scene.integrator.generator == io::Generator::orthogonal),
      bodies_(inverse_inertia, lattice) {
  if (!has_dampings_of_columns(scene)) return;
  dampings_.emplace(field_of_columns<Spins, 1>(lattice, scene.columns->dampings));
  precession_ = scene.system.precession;
}

template <class Spins>
SceneGenerator<Spins> SceneGenerator<Spins>::precession_alone() const {
  SceneGenerator other = *this;
  other.llg_ = LandauLifshitz(llg_.field().made_for(FieldFor::itself), 0, true);
  other.orthogonal_ = false;
  other.alone_ = true;
  return other;
}

template <class Spins>
SceneGeneratorNow<Spins> SceneGenerator<Spins>::now(
    LandauLifshitz<SceneFieldNow<typename Spins::value_type>> const& llg,
    SceneBodiesNow<typename SceneBodies<Spins>::Many> const& bodies) const {
  SceneGeneratorNow<Spins> now{llg, bodies, is_llg_, orthogonal_};
  if (!is_llg_) {  // for rigid bodies, rows hold A instead of H
    auto field = llg.field();
    field.along_rows.is_whole = true;
    now.llg = LandauLifshitz(field, 0);
  }
  if (alone_) return now;
  if (auto const& pass = llg_.field().pass()) now.own = pass->own_of_sites();
  if (dampings_) {
    now.own.dampings = dampings_->array();
    now.own.precession = precession_;
    now.own.rounds_once = true;
  }
  return now;
}

template <class Spins>
void SceneGenerator<Spins>::set_values(io::Field const& field, io::Columns const& values,
                                       std::size_t column) {
  llg_ = LandauLifshitz(llg_.field().with_values(field, values, column), 0, llg_.has_precession());
}

template <class Spins>
template <class Exec>
SceneGeneratorNow<Spins> SceneGenerator<Spins>::prepare(Exec const& exec, Spins const& spins,
                                                        double t) const {
  return now(llg_.prepare(exec, spins, t), bodies_.prepare(exec, spins, t));
}

template <class Spins>
template <class Exec>
SceneGeneratorNow<Spins> SceneGenerator<Spins>::prepare_for_rows(Exec const& exec,
                                                                 Spins const& spins,
                                                                 double t) const {
  return now(llg_.prepare_for_rows(exec, spins, t), bodies_.prepare(exec, spins, t));
}

template <class Spins>
template <class Exec>
SceneGeneratorNow<Spins> SceneGenerator<Spins>::prepare_rate(Exec const& exec, Spins const& rates,
                                                             double t, double dt) const {
  return now(cayspin::detail::prepare_rate(llg_, exec, rates, t, dt),
             bodies_.prepare(exec, rates, t));
}

#define CAYSPIN_INSTANTIATE(Space, Real)                                        \
  template SceneGeneratorNow<SpinField<Real, Space::memory_space>>              \
  SceneGenerator<SpinField<Real, Space::memory_space>>::prepare(                \
      Space const&, SpinField<Real, Space::memory_space> const&, double) const; \
  template SceneGeneratorNow<SpinField<Real, Space::memory_space>>              \
  SceneGenerator<SpinField<Real, Space::memory_space>>::prepare_for_rows(       \
      Space const&, SpinField<Real, Space::memory_space> const&, double) const; \
  template SceneGeneratorNow<SpinField<Real, Space::memory_space>>              \
  SceneGenerator<SpinField<Real, Space::memory_space>>::prepare_rate(           \
      Space const&, SpinField<Real, Space::memory_space> const&, double, double) const;
CAYSPIN_FOR_EACH_SPACE(CAYSPIN_INSTANTIATE, double)
CAYSPIN_FOR_EACH_SPACE(CAYSPIN_INSTANTIATE, float)
#undef CAYSPIN_INSTANTIATE

#define CAYSPIN_INSTANTIATE(Space, Real)                                               \
  template class SceneGenerator<SpinField<Real, Space::memory_space>>;                 \
  template struct SceneGeneratorNow<SpinField<Real, Space::memory_space>>;             \
  template SceneField<SpinField<Real, Space::memory_space>> field_of(io::Scene const&, \
                                                                     Lattice const&, bool);
CAYSPIN_FOR_EACH_SPACE(CAYSPIN_INSTANTIATE, double)
CAYSPIN_FOR_EACH_SPACE(CAYSPIN_INSTANTIATE, float)
#undef CAYSPIN_INSTANTIATE

}  // namespace cayspin::simulation
