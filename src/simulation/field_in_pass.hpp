// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "scene_field_now.hpp"

#include <cayspin/spin_field.hpp>

#include <memory>
#include <optional>
#include <vector>

namespace cayspin::inline v0_1::io {
struct Scene;
}

namespace cayspin::simulation {

/// Purposes of a field: to turn those spins that do; for itself, zero where a spin is
/// frozen; or as -dE/dm, the same, for an energy that falls.
enum class FieldFor { generator, itself, energy };

/// The field of a scene whose terms are those of few scenes: couplings, sublattices, currents,
/// vacancies. One pass evaluates all terms into memory before each stage, or on a host along each
/// row as a Runge-Kutta stage comes to it, and the kernels of the methods load what it wrote; so
/// there is one such kernel, and not one for each method.
/// Compiled in field_in_pass.cpp, for the spaces of space.hpp. A handle.
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

  /// For a host loop over rows, without energies: it evaluates as it goes what the terms that are
  /// compiled into stages do not have, or all.
  template <class Exec>
  SceneFieldNow<Real> along_rows(Exec const& exec, SceneFieldNow<Real> const& usual,
                                 Spins const& spins, double t, FieldFor purpose) const;

  /// Does `along_rows` look at no other spins than those of a stage?
  bool rows_need_time_alone() const;

  /// Is H affine in the spins?
  bool is_affine() const;

  /// How sites turn in H, each by its own numbers.
  OwnOfSites<Real> own_of_sites() const;

  /// The gyromagnetic ratio, where all spins have the same.
  double gyromagnetic() const;

  /// The mean of m weighted by moments, over the sites that have a spin.
  template <class Exec>
  Vec3<double> magnetization(Exec const& exec, Spins const& spins) const;

  /// max | |m| - 1 | over these sites.
  template <class Exec>
  double norm_defect(Exec const& exec, Spins const& spins) const;

  /// 0 where a spin is frozen; none where all move.
  std::optional<ScalarField<Real, Memory>> const& moves() const;

 private:
  /// `adds_applied`: kernels add what the applied field makes. Otherwise H has it, as along rows.
  template <class Exec>
  SceneFieldNow<Real> evaluate_with(Exec const& exec, SceneFieldNow<Real> const& usual,
                                    Spins const& spins, double t, FieldFor purpose,
                                    bool adds_applied) const;

  /// Without any term.
  SceneFieldNow<Real> nothing() const;

  class Terms;
  std::shared_ptr<Terms const> terms_;
};

}  // namespace cayspin::simulation
