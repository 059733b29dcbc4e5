// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "applied_field.hpp"
#include "host_solver.hpp"
#include "lattice_terms.hpp"

#include <cayspin/field/dear.hpp>
#include <cayspin/field/host_field.hpp>
#include <cayspin/field/layer_averaged_slab_demag.hpp>
#include <cayspin/field/local_part.hpp>
#include <cayspin/field/zeeman.hpp>
#include <cayspin/generator/rigid_body.hpp>
#include <cayspin/io/field.hpp>

#include <optional>

namespace cayspin::simulation {

/// All terms quadratic in one spin, as one symmetric matrix M: H = M m, E = -m.M m / 2. Any number
/// of anisotropy axes, and a slab's demagnetising field spin by spin.
class QuadraticTerms {
 public:
  void add(double constant, io::Triple const& axis) {
    sum_.add(constant, axis);
    magnitude_.add(std::abs(constant), axis);
    bool const along_z = axis[0] == 0 && axis[1] == 0;
    form_ = along_z && form_ != Form::any ? Form::along_z : Form::any;
  }

  KOKKOS_FORCEINLINE_FUNCTION bool present() const { return form_ != Form::none; }

  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> add_field(Vec3<Value> const& m,
                                                    Vec3<Value> const& h) const {
    if (form_ == Form::along_z) [[likely]]
      return {h.x, h.y, cayspin::detail::multiply_add(as_value<Value>(sum_.zz), m.z, h.z)};
    return present() ? h + field(m) : h;
  }
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION Value energy(Vec3<Value> const& m) const {
    return Value(-0.5) * dot(m, field(m));
  }
  /// Sum of |energy| over the terms.
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION Value magnitude(Vec3<Value> const& m) const {
    return Value(0.5) * dot(m, magnitude_.template matrix<Value>() * m);
  }

 private:
  struct Sum {
    double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;

    void add(double c, io::Triple const& e) {
      xx += c * e[0] * e[0], yy += c * e[1] * e[1], zz += c * e[2] * e[2];
      xy += c * e[0] * e[1], xz += c * e[0] * e[2], yz += c * e[1] * e[2];
    }
    template <class Value>
    KOKKOS_FORCEINLINE_FUNCTION cayspin::detail::SymmetricMatrix<Value> matrix() const {
      using Scalar = cayspin::detail::scalar_t<Value>;
      return {Value(static_cast<Scalar>(xx)), Value(static_cast<Scalar>(yy)),
              Value(static_cast<Scalar>(zz)), Value(static_cast<Scalar>(xy)),
              Value(static_cast<Scalar>(xz)), Value(static_cast<Scalar>(yz))};
    }
  };

  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> field(Vec3<Value> const& m) const {
    return sum_.template matrix<Value>() * m;
  }

  enum class Form { none, along_z, any };

  Sum sum_, magnitude_;
  Form form_ = Form::none;
};

/// The field of any scene at one instant, for kernels. Which terms are there is asked at run time,
/// once per pack of spins, so that a kernel is compiled once for all scenes.
template <class Real>
struct SceneFieldNow {
  SceneLatticeTerms lattice_terms;
  QuadraticTerms quadratic;
  Zeeman zeeman;  // zero without an applied field
  cayspin::detail::LayerField layers;
  cayspin::detail::StoredField<Real> stored;
  bool has_applied, has_layers, has_stored;

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> field(
      Stencil const& stencil) const {
    return add_demagnetization(stencil, lattice_terms.add_field(stencil, local_field(stencil)));
  }
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> turning_field(
      Stencil const& stencil) const {
    return add_demagnetization(stencil,
                               lattice_terms.add_turning_field(stencil, local_field(stencil)));
  }

  /// Does the part of the spin itself depend on the spin?
  KOKKOS_FORCEINLINE_FUNCTION bool local_field_varies() const { return quadratic.present(); }

  /// The linear part alone: without the applied field.
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> linear_field(
      Stencil const& stencil) const {
    auto const none = zero<typename Stencil::value_type>();
    return add_demagnetization(
        stencil, lattice_terms.add_field(stencil, quadratic.add_field(stencil.center(), none)));
  }
  /// The part that comes from other spins, and the rest.
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> neighbor_field(
      Stencil const& stencil) const {
    return add_demagnetization(stencil, lattice_terms.neighbor_field(stencil));
  }
  template <class Spin>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Spin::value_type> local_field(Spin const& spin) const {
    return quadratic.add_field(spin.center(), zeeman.field(spin));
  }
  /// dH/dt along rates, of what prepare_rate returns.
  template <class Value, class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> field_rate(Vec3<Value> const&,
                                                     Stencil const& rates) const {
    return field(rates);
  }

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION typename Stencil::value_type energy_density(
      Stencil const& stencil) const {
    auto e = lattice_terms.energy_density(stencil);
    if (quadratic.present()) e = e + quadratic.energy(stencil.center());
    if (has_applied) e = e + zeeman.energy_density(stencil);
    if (has_layers) e = e + layers.energy_density(stencil);
    if (has_stored) e = e + stored.energy_density(stencil);
    return e;
  }

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION typename Stencil::value_type energy_magnitude(
      Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    Value e(static_cast<cayspin::detail::scalar_t<Value>>(lattice_terms.magnitude));
    if (quadratic.present()) e = e + quadratic.magnitude(stencil.center());
    if (has_applied) e = e + Kokkos::abs(zeeman.energy_density(stencil));
    if (has_layers) e = e + Kokkos::abs(layers.energy_density(stencil));
    if (has_stored) e = e + Kokkos::abs(stored.energy_density(stencil));
    return e;
  }

 private:
  template <class Stencil, class Vector>
  KOKKOS_FORCEINLINE_FUNCTION Vector add_demagnetization(Stencil const& stencil, Vector h) const {
    if (has_layers || has_stored) [[unlikely]] {
      if (has_layers) h = h + layers.field(stencil);
      if (has_stored) h = h + stored.field(stencil);
    }
    return h;
  }
};

/// The effective field that a scene's [field] describes.
template <class Spins>
class SceneField {
  using Real = typename Spins::value_type;

 public:
  using OnHost = HostField<Spins, HostSolver>;
  using DearTerm = Dear<Spins, OnHost>;

  /// `has_dear`: is what the host computes dear?
  SceneField(io::Field const& field, Lattice const& lattice, bool has_dear)
      : lattice_terms_(lattice_terms_of(field, lattice)), applied_(field) {
    for (auto const& term : field.anisotropies) quadratic_.add(term.constant, term.axis);
    if (field.slab_demag) add(*field.slab_demag, field.mu0, lattice);
    if (field.own.nonlocal) stored_.emplace(lattice, HostSolver(field.own.nonlocal));
    if (has_dear) {
      dear_.emplace(lattice, *stored_);
      stored_.reset();
    }
  }

  /// None where no term is dear.
  std::optional<DearTerm> const& dear() const { return dear_; }

  /// Throws NumbersFailed when an applied field is not finite at t.
  template <class Exec>
  SceneFieldNow<Real> prepare(Exec const& exec, Spins const& spins, double t) const {
    auto now = prepare_local(exec, spins, t);
    now.has_layers = layers_.has_value();
    now.has_stored = stored_ || dear_;
    if (layers_) now.layers = cayspin::detail::prepare_term(*layers_, exec, spins, t);
    if (stored_) now.stored = cayspin::detail::prepare_term(*stored_, exec, spins, t);
    if (dear_) now.stored = cayspin::detail::prepare_term(*dear_, exec, spins, t);
    return now;
  }
  /// Looks at no spin: without the terms that do.
  template <class Exec>
  SceneFieldNow<Real> prepare_local(Exec const&, Spins const&, double t) const {
    SceneFieldNow<Real> now{lattice_terms_,     quadratic_, {},   {}, {},
                            applied_.present(), false,      false};
    if (now.has_applied) now.zeeman = {applied_(t)};
    return now;
  }

  template <class Exec, class Any>
  bool is_stationary(Exec const& exec, Any const& spins) const {
    return !applied_.depends_on_time() && needs_time_alone(exec, spins);
  }
  template <class Exec, class Any>
  bool needs_time_alone(Exec const&, Any const&) const {
    return !layers_ && !stored_ && !dear_;
  }

  /// The same for rates of spins, the applied field's own rate in place of the field.
  template <class Exec>
  SceneFieldNow<Real> prepare_rate(Exec const& exec, Spins const& rates, double t,
                                   double dt) const {
    auto now = prepare(exec, rates, t);
    now.has_applied = applied_.depends_on_time();
    now.zeeman = {};
    if (now.has_applied) now.zeeman = {cayspin::detail::time_derivative(applied_, t, dt)};
    return now;
  }

 private:
  void add(io::SlabDemagnetization const& slab, double mu0, Lattice const& lattice) {
    Vec3<double> const normal{slab.normal[0], slab.normal[1], slab.normal[2]};
    double const strength = mu0 * slab.strength;
    if (slab.on_host || slab.dear) {
      stored_.emplace(lattice, HostSolver(SlabDemagOnHost(normal, strength, slab.average_layer)));
    } else if (slab.average_layer) {
      layers_.emplace(lattice, normal.x != 0 ? 0 : normal.y != 0 ? 1 : 2, strength);
    } else {
      quadratic_.add(-strength, slab.normal);
    }
  }

  SceneLatticeTerms lattice_terms_;
  QuadraticTerms quadratic_;
  AppliedField applied_;
  std::optional<LayerAveragedSlabDemag<typename Spins::memory_space>> layers_;
  std::optional<OnHost> stored_;
  std::optional<DearTerm> dear_;
};

}  // namespace cayspin::simulation
