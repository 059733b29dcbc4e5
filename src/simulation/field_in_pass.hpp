// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "scene_field_now.hpp"

#include <cayspin/spin_field.hpp>

#include <memory>
#include <optional>
#include <vector>

namespace cayspin::inline v0_2::io {
struct Scene;
}

namespace cayspin::simulation {

/// The purpose of a field. generator: H times the gyromagnetic ratio that the scene lists for this
/// site of the cell, for the generator that turns the spins; itself: H, for output; energy: -dE/dm,
/// for searches that lower the energy, and for modes. The last two are zero at frozen spins.
enum class FieldFor { generator, itself, energy };

/// The field of a scene with rarely used terms, such as couplings, sublattices, currents and
/// vacancies. A separate pass evaluates all terms into memory before each stage, and the kernels of
/// the methods load the result. On a host, a Runge-Kutta stage instead evaluates all terms, or only
/// the rare ones, row by row (along_rows). Either way, the rare terms are not compiled again for
/// each method. Compiled by field_in_pass_double.cpp and field_in_pass_single.cpp for the spaces of
/// space.hpp. A handle: copies share their data.
template <class Spins>
class FieldInPass {
  using Real = typename Spins::value_type;
  using Memory = typename Spins::memory_space;

 public:
  FieldInPass(io::Scene const& scene, Lattice const& lattice);

  /// Evaluates H and E of all sites into memory, and returns a field that loads them. `usual`: the
  /// terms that SceneField has prepared.
  template <class Exec>
  SceneFieldNow<Real> evaluate(Exec const& exec, SceneFieldNow<Real> const& usual,
                               Spins const& spins, double t, FieldFor purpose) const;

  /// Prepares the terms for a loop over rows on a host. The loop evaluates either all terms, or
  /// only those that are not compiled into stages; it computes no energies. On devices, for a
  /// purpose other than the generator, and if terms reach beyond the ghosts of a part, H, including
  /// the applied field, is evaluated into memory instead.
  template <class Exec>
  SceneFieldNow<Real> along_rows(Exec const& exec, SceneFieldNow<Real> const& usual,
                                 Spins const& spins, double t, FieldFor purpose) const;

  /// Returns true if the loop of along_rows reads only spins that a stage reads anyway.
  bool rows_need_only_time() const;

  /// Returns true if H is affine in the spins.
  bool is_affine() const;

  /// Returns the site-dependent numbers that change how spins turn in H.
  OwnOfSites<Real> own_of_sites() const;

  /// Returns the gyromagnetic ratio of the spins, which must all have the same one.
  double gyromagnetic() const;

  /// Returns the mean of m weighted by moments, over the sites that have a spin.
  template <class Exec>
  Vec3<double> magnetization(Exec const& exec, Spins const& spins) const;

  /// Returns max | |m| - 1 | over the sites that have a spin.
  template <class Exec>
  double norm_defect(Exec const& exec, Spins const& spins) const;

  /// Returns the moments; empty unless io::has_moments_of_sites.
  std::optional<ScalarField<Real, Memory>> moments_of_sites() const;

  /// Returns 0 where a spin is frozen and 1 elsewhere; empty if none is frozen.
  std::optional<ScalarField<Real, Memory>> const& moves() const;

 private:
  /// `adds_applied`: if true, the kernels of the methods add the applied field; if false, the pass
  /// includes that field in H.
  template <class Exec>
  SceneFieldNow<Real> evaluate_with(Exec const& exec, SceneFieldNow<Real> const& usual,
                                    Spins const& spins, double t, FieldFor purpose,
                                    bool adds_applied) const;

  /// Returns a field without terms.
  SceneFieldNow<Real> nothing() const;

  class Terms;
  std::shared_ptr<Terms const> terms_;
};

}  // namespace cayspin::simulation
