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

/// Purpose of a field. generator: to turn the spins that move; itself: for output, zero where a
/// spin is frozen; energy: as -dE/dm, zero where a spin is frozen, for an energy that falls.
enum class FieldFor { generator, itself, energy };

/// The field of a scene with rarely used terms: couplings, sublattices, currents, vacancies. One
/// pass evaluates all terms into memory before each stage, or on a host row by row as a Runge-Kutta
/// stage reaches it, and the kernels of the methods load the result. So there is one such kernel,
/// rather than one for each method. Compiled by field_in_pass_double.cpp and
/// field_in_pass_single.cpp for the spaces of space.hpp. A handle.
template <class Spins>
class FieldInPass {
  using Real = typename Spins::value_type;
  using Memory = typename Spins::memory_space;

 public:
  FieldInPass(io::Scene const& scene, Lattice const& lattice);

  /// `usual`: the scene's other terms.
  template <class Exec>
  SceneFieldNow<Real> evaluate(Exec const& exec, SceneFieldNow<Real> const& usual,
                               Spins const& spins, double t, FieldFor purpose) const;

  /// Prepares a host loop over rows, without energies: it evaluates all terms, or only those that
  /// are not compiled into stages.
  template <class Exec>
  SceneFieldNow<Real> along_rows(Exec const& exec, SceneFieldNow<Real> const& usual,
                                 Spins const& spins, double t, FieldFor purpose) const;

  /// Returns true if `along_rows` reads no other spins than those of a stage.
  bool rows_need_only_time() const;

  /// Returns true if H is affine in the spins.
  bool is_affine() const;

  /// Returns the site-dependent numbers by which sites turn in H.
  OwnOfSites<Real> own_of_sites() const;

  /// Returns the gyromagnetic ratio if all spins have the same.
  double gyromagnetic() const;

  /// Returns the mean of m weighted by moments, over the sites that have a spin.
  template <class Exec>
  Vec3<double> magnetization(Exec const& exec, Spins const& spins) const;

  /// Returns max | |m| - 1 | over these sites.
  template <class Exec>
  double norm_defect(Exec const& exec, Spins const& spins) const;

  /// Returns the moments; empty if each depends only on the site of the cell.
  std::optional<ScalarField<Real, Memory>> moments_of_sites() const;

  /// Returns 0 where a spin is frozen; empty if all move.
  std::optional<ScalarField<Real, Memory>> const& moves() const;

 private:
  /// `adds_applied`: kernels add the contribution of the applied field. Otherwise H includes it, as
  /// along rows.
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
