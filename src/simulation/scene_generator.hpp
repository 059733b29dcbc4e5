// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "scene_bodies.hpp"
#include "scene_field.hpp"

#include <cayspin/generator/landau_lifshitz.hpp>
#include <cayspin/generator/orthogonal.hpp>
#include <cayspin/observer/record.hpp>

#include <cayspin_paper/analytic_sigma.hpp>
#include <cayspin_paper/series_source.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace cayspin::inline v0_2::io {
struct Scene;
}

namespace cayspin::simulation {

/// The A of any scene at one instant, for kernels. One type for all scenes: the system, and whether
/// the component along the spin is removed, are selected at run time.
template <class Spins>
struct SceneGeneratorNow {
  LandauLifshitz<SceneFieldNow<typename Spins::value_type>> llg;
  SceneBodiesNow<typename SceneBodies<Spins>::Many> bodies;
  bool is_llg, orthogonal;
  OwnOfSites<typename Spins::value_type> own = {};
  bool is_changed = false;  // set by begin_row: A is not just that of `llg`

  static constexpr int row_fields = cayspin::detail::row_fields<decltype(llg)>;
  void begin_row(cayspin::detail::RowOfSpins<typename Spins::value_type> const& row,
                 std::int32_t begin, std::int32_t end,
                 cayspin::detail::RowFields<typename Spins::value_type> const& fields) {
    llg.begin_row(row, begin, end, fields);
    is_changed = orthogonal || own.any();
  }
  /// Stores H at the ends of the row or, for rigid bodies, A at all sites of the piece.
  void find_row_ends(cayspin::detail::RowOfSpins<typename Spins::value_type> const& row,
                     std::int32_t begin, std::int32_t end,
                     cayspin::detail::RowFields<typename Spins::value_type> const& fields,
                     bool turning_alone) const;

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> operator()(
      Stencil const& stencil) const {
    if constexpr (cayspin::detail::is_along_row<Stencil>)
      return changed_along_row<false>(
          stencil, llg.in_field(stencil, llg.field().template field_along_row<false>(stencil)));
    else
      return changed(stencil, is_llg ? llg(stencil) : bodies(stencil));
  }
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> turning_part(
      Stencil const& stencil) const {
    if constexpr (cayspin::detail::is_along_row<Stencil>) {
      return changed_along_row<true>(
          stencil, llg.in_field(stencil, llg.field().template field_along_row<true>(stencil)));
    } else {
      return own.of(stencil.site(), stencil.center(),
                    is_llg ? llg.turning_part(stencil) : bodies(stencil));
    }
  }

  template <class Value, class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> rate(Vec3<Value> const& m, Stencil const& rates) const {
    using cayspin::detail::rate_of;
    return own.of(rates.site(), m, is_llg ? rate_of(llg, m, rates) : rate_of(bodies, m, rates));
  }

  /// Returns the generator without the removal of the component of A along the spin.
  SceneGeneratorNow bare() const {
    auto other = *this;
    other.orthogonal = false;
    return other;
  }

  // For series of spins only: series of rigid bodies have a separate generator.
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> series_source(
      Stencil const& stencil) const {
    return llg.field().field(stencil);
  }
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> linear_series_source(
      Stencil const& stencil) const {
    return llg.field().linear_field(stencil);
  }
  template <int K, class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> derivative(Vec3<Value> const* m,
                                                     Vec3<Value> const* source) const {
    return orthogonal ? cayspin::detail::orthogonal_derivative<K>(llg, m, source)
                      : cayspin::detail::series_derivative<K>(llg, m, source);
  }

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION typename Stencil::value_type energy_density(
      Stencil const& stencil) const {
    return is_llg ? llg.energy_density(stencil) : bodies.energy_density(stencil);
  }
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION typename Stencil::value_type energy_magnitude(
      Stencil const& stencil) const {
    return is_llg ? llg.energy_magnitude(stencil)
                  : cayspin::detail::energy_magnitude(bodies, stencil);
  }

 private:
  template <bool TurningAlone, class Stencil, class Vector>
  KOKKOS_FORCEINLINE_FUNCTION Vector changed_along_row(Stencil const& stencil, Vector a) const {
    if (is_changed) [[unlikely]] {
      a = own.of(stencil.site(), stencil.center(), a);
      if (!TurningAlone && orthogonal) a = cayspin::detail::orthogonal_part(a, stencil.center());
    }
    return a;
  }
  /// Applies the site-dependent numbers to A, and removes its component along the spin if
  /// requested.
  template <class Spin, class Vector>
  KOKKOS_FORCEINLINE_FUNCTION Vector changed(Spin const& spin, Vector const& a) const {
    Vector const own_a = own.of(spin.site(), spin.center(), a);
    return orthogonal ? cayspin::detail::orthogonal_part(own_a, spin.center()) : own_a;
  }
};

/// The generator described by a scene's [system], [field] and integrator.generator.
template <class Spins>
class SceneGenerator {
 public:
  /// Throws io::SceneError, for example for an invalid inertia.
  SceneGenerator(io::Scene const& scene, Lattice const& lattice);

  /// For rigid bodies whose inverse inertia is in memory; ignores the inertia of the scene.
  SceneGenerator(io::Scene const& scene, Lattice const& lattice,
                 std::vector<SymmetricTensor> const& inverse_inertia);

  bool is_llg() const { return is_llg_; }
  template <class Exec>
  bool is_stationary(Exec const& exec, Spins const& spins) const {
    return !is_llg_ || llg_.is_stationary(exec, spins);
  }
  template <class Exec>
  bool needs_only_time(Exec const& exec, Spins const& spins) const {
    return !is_llg_ || llg_.needs_only_time(exec, spins);
  }
  template <class Exec>
  bool rows_need_only_time(Exec const& exec, Spins const& spins) const {
    return !is_llg_ || llg_.rows_need_only_time(exec, spins);
  }
  LandauLifshitz<SceneField<Spins>> const& landau_lifshitz() const { return llg_; }
  RigidBodies<Spins> rigid_bodies() const { return {bodies_, orthogonal_}; }
  bool is_orthogonal() const { return orthogonal_; }
  bool is_affine() const { return llg_.field().is_affine(); }
  bool conserves_energy() const { return !is_llg_ || llg_.conserves_energy(); }

  /// Returns the generator of undamped precession about the effective field.
  SceneGenerator precession_alone() const;

  /// Replaces the field by that of one column, for energies, and sets the damping to 0. `field`:
  /// the scene's.
  void set_values(io::Field const& field, io::Columns const& values, std::size_t column);

  /// Compiled only in scene_generator.cpp, for the spaces of space.hpp.
  template <class Exec>
  SceneGeneratorNow<Spins> prepare(Exec const& exec, Spins const& spins, double t) const;
  template <class Exec>
  SceneGeneratorNow<Spins> prepare_for_rows(Exec const& exec, Spins const& spins, double t) const;
  template <class Exec>
  SceneGeneratorNow<Spins> prepare_rate(Exec const& exec, Spins const& rates, double t,
                                        double dt) const;

 private:
  LandauLifshitz<SceneField<Spins>> llg_;
  bool is_llg_, orthogonal_;
  SceneBodies<Spins> bodies_;
  bool alone_ = false;  // only precession: ignores site-dependent numbers
  // Dampings of the sites of columns, and whether these precess; llg_ then has no damping.
  std::optional<ScalarField<typename Spins::value_type, typename Spins::memory_space>> dampings_;
  bool precession_ = true;

  SceneGeneratorNow<Spins> now(
      LandauLifshitz<SceneFieldNow<typename Spins::value_type>> const& llg,
      SceneBodiesNow<typename SceneBodies<Spins>::Many> const& bodies) const;
};

/// Like cayspin::sample, but with the magnetization weighted by a scene's moments, and the norm
/// defect only of sites that have a spin. `of_scene`: the generator or the field of the scene,
/// which gives the energy.
template <class Exec, class OfScene, class Spins, class... Generators>
Sample sample_scene(Exec const& exec, OfScene const& of_scene, Step const& step, Spins const& spins,
                    Generators const&... generators) {
  auto found = cayspin::sample(exec, of_scene, step, spins, generators...);
  auto const& pass = [&]() -> auto const& {
    if constexpr (requires { of_scene.landau_lifshitz(); })
      return of_scene.landau_lifshitz().field().pass();
    else
      return of_scene.pass();
  }();
  if (pass) {
    found.magnetization = pass->magnetization(exec, spins);
    found.norm_defect = pass->norm_defect(exec, spins);
  }
  return found;
}

/// Isotropy with a constant sigma, which is selected at run time and may be zero.
struct SceneIsotropy {
  double sigma = 0;

  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> operator()(Vec3<Value> const& m,
                                                     Vec3<Value> const& a) const {
    if (sigma == 0) return a;
    return multiply_add(Value(static_cast<cayspin::detail::scalar_t<Value>>(sigma)), m, a);
  }
};

}  // namespace cayspin::simulation
