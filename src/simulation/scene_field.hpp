// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "applied_field.hpp"
#include "field_in_pass.hpp"
#include "io/ensemble.hpp"
#include "io/field.hpp"
#include "scene_field_now.hpp"
#include "whole_field.hpp"

#include <cayspin/field/slow_field.hpp>
#include <cayspin/generator/rigid_body.hpp>
#include <cayspin/optional_members.hpp>

#include <cayspin_paper/field_rate.hpp>

#include <cstddef>
#include <optional>
#include <type_traits>
#include <utility>

namespace cayspin::simulation {

/// The effective field that a scene's [field] describes.
template <class Spins>
class SceneField {
  using Real = typename Spins::value_type;
  using Vectors = SiteField<Real, 3, typename Spins::memory_space>;

 public:
  using SlowTerm = SlowField<Spins, WholeField<Spins>>;

  /// `has_slow`: the field that is computed from all spins at once is multirate.
  SceneField(io::Field const& field, io::Units const& units, Lattice const& lattice, bool has_slow,
             std::optional<FieldInPass<Spins>> pass)
      : lattice_terms_(lattice_terms_of(field, lattice)),
        applied_(field, units),
        pass_(std::move(pass)) {
    if (!pass_)
      for (auto const& term : field.anisotropies) quadratic_.add(term.constant, term.axis);
    if (field.slab_demag) add(*field.slab_demag, field.mu0, lattice);
    if (field.demag) add(*field.demag, field.mu0, lattice);
    if (field.own.nonlocal) stored_.emplace(lattice, HostSolver(field.own.nonlocal));
    if (has_slow) {
      slow_.emplace(lattice, *stored_);
      stored_.reset();
    }
  }

  /// Returns a copy of the field for another purpose.
  SceneField made_for(FieldFor purpose) const {
    auto other = *this;
    other.purpose_ = purpose;
    return other;
  }
  /// Returns a copy of the field with the values of one column. `field`: the scene's, which must
  /// not need a pass.
  SceneField with_values(io::Field const& field, io::Columns const& values,
                         std::size_t column) const {
    auto other = *this;
    if (!values.applied.empty()) other.applied_ = applied_.with(values.applied[column]);
    if (!values.constants.empty()) {
      auto of_column = field;
      values.put_constants(column, of_column);
      other.quadratic_ = quadratic_terms_of(of_column);
    }
    return other;
  }
  /// Replace the applied field, which includes mu0, and the quadratic terms by values of sites. The
  /// field must not have a pass.
  void set_applied(Vectors const& applied) { applied_of_sites_ = applied; }
  void set_quadratic(Vectors const& diagonal, Vectors const& others) {
    diagonal_of_sites_ = diagonal;
    others_of_sites_ = others;
  }
  bool is_affine() const { return !pass_ || pass_->is_affine(); }

  /// Empty if the kernels of methods evaluate the terms themselves.
  std::optional<FieldInPass<Spins>> const& pass() const { return pass_; }
  /// Empty if no term is multirate.
  std::optional<SlowTerm> const& slow() const { return slow_; }

  /// Throws NumbersFailed when an applied field is not finite at t.
  template <class Exec>
  SceneFieldNow<Real> prepare(Exec const& exec, Spins const& spins, double t) const {
    auto const now = usual_terms(exec, spins, t);
    return pass_ ? pass_->evaluate(exec, now, spins, t, purpose_) : now;
  }
  template <class Exec>
  SceneFieldNow<Real> prepare_for_rows(Exec const& exec, Spins const& spins, double t) const {
    auto const now = usual_terms(exec, spins, t);
    return pass_ ? pass_->along_rows(exec, now, spins, t, purpose_) : now;
  }

  template <class Exec, class Any>
  bool is_stationary(Exec const& exec, Any const& spins) const {
    return !applied_.depends_on_time() && needs_only_time(exec, spins);
  }
  template <class Exec, class Any>
  bool needs_only_time(Exec const&, Any const&) const {
    return !stored_ && !slow_ && !pass_;
  }

  template <class Exec, class Any>
  bool rows_need_only_time(Exec const&, Any const&) const {
    return !stored_ && !slow_ && (!pass_ || pass_->rows_need_only_time());
  }

  /// Prepares dH/dt for given rates of change of the spins. The time derivative of the applied
  /// field takes the place of the applied field.
  template <class Exec>
  SceneFieldNow<Real> prepare_rate(Exec const& exec, Spins const& rates, double t,
                                   double dt) const {
    auto now = prepare(exec, rates, t);
    now.has_applied = applied_.depends_on_time();
    now.zeeman = {};
    now.applied_of_sites = {};
    double const seen = pass_ ? pass_->gyromagnetic() : 1;
    if (now.has_applied) now.zeeman = {seen * cayspin::detail::time_derivative(applied_, t, dt)};
    return now;
  }

 private:
  template <class Exec>
  SceneFieldNow<Real> usual_terms(Exec const& exec, Spins const& spins, double t) const {
    SceneFieldNow<Real> now{lattice_terms_,     quadratic_,      {}, {},
                            applied_.present(), stored_ || slow_};
    if (now.has_applied) now.zeeman = {applied_(t)};
    if (applied_of_sites_) now.applied_of_sites = applied_of_sites_->array();
    if (diagonal_of_sites_) {
      now.diagonal_of_sites = diagonal_of_sites_->array();
      now.others_of_sites = others_of_sites_->array();
    }
    if (stored_) now.stored = cayspin::detail::prepare_term(*stored_, exec, spins, t);
    if (slow_) now.stored = cayspin::detail::prepare_term(*slow_, exec, spins, t);
    now.couples_along_x = lattice_terms_.couples_along_x();
    return now;
  }

  auto moments_of_sites() const {
    return pass_ ? pass_->moments_of_sites()
                 : std::optional<ScalarField<Real, typename Spins::memory_space>>();
  }
  void add(io::Demagnetization const& demag, double mu0, Lattice const& lattice) {
    if constexpr (!std::is_same_v<typename Spins::memory_space, Kokkos::HostSpace>)
      if (auto field = demagnetization_in_place<Spins>(demag, mu0, lattice)) {
        stored_.emplace(lattice, std::move(field), moments_of_sites());
        return;
      }
    stored_.emplace(lattice, HostSolver(demagnetization_on_host<Real>(demag, mu0, lattice)),
                    moments_of_sites());
  }
  void add(io::SlabDemagnetization const& slab, double mu0, Lattice const& lattice) {
    Vec3<double> const normal{slab.normal[0], slab.normal[1], slab.normal[2]};
    double const strength = mu0 * slab.strength;
    if (slab.on_host || slab.multirate) {
      stored_.emplace(lattice, HostSolver(SlabDemagOnHost(normal, strength)), moments_of_sites());
    } else {
      quadratic_.add(-strength, slab.normal);
    }
  }

  SceneLatticeTerms lattice_terms_;
  QuadraticTerms quadratic_;
  AppliedField applied_;
  std::optional<Vectors> applied_of_sites_, diagonal_of_sites_, others_of_sites_;
  std::optional<WholeField<Spins>> stored_;
  std::optional<SlowTerm> slow_;
  std::optional<FieldInPass<Spins>> pass_;
  FieldFor purpose_ = FieldFor::generator;
};

/// Returns the field of a scene. Compiled in scene_generator.cpp.
template <class Spins>
SceneField<Spins> field_of(io::Scene const& scene, Lattice const& lattice, bool has_slow);

}  // namespace cayspin::simulation
