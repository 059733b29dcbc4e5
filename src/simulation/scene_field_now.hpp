// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/field.hpp"
#include "lattice_terms.hpp"

#include <cayspin/detail/row_fields.hpp>
#include <cayspin/field/host_field.hpp>
#include <cayspin/field/parts.hpp>
#include <cayspin/field/zeeman.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace cayspin::simulation {

/// All terms that are quadratic in a single spin, as one symmetric matrix M: H = M m and
/// E = -m.(M m) / 2. These are any number of anisotropy axes, and a slab's local demagnetising
/// field.
class QuadraticTerms {
 public:
  void add(double constant, io::Triple const& axis) {
    sum_.add(constant, axis);
    magnitude_.add(std::abs(constant), axis);
    bool const along_z = axis[0] == 0 && axis[1] == 0;
    form_ = along_z && form_ != Form::any ? Form::along_z : Form::any;
  }

  /// Returns `factor` times the sum of these terms and `others`.
  QuadraticTerms with(QuadraticTerms const& others, double factor) const {
    QuadraticTerms both;
    both.sum_ = sum_.with(others.sum_, factor);
    both.magnitude_ = magnitude_.with(others.magnitude_, std::abs(factor));
    both.form_ = std::max(form_, others.form_);
    return both;
  }

  /// Returns xx, yy, zz of the matrix, and xy, xz, yz.
  std::array<io::Triple, 2> entries() const {
    return {{{sum_.xx, sum_.yy, sum_.zz}, {sum_.xy, sum_.xz, sum_.yz}}};
  }

  KOKKOS_FORCEINLINE_FUNCTION bool present() const { return form_ != Form::none; }
  bool operator==(QuadraticTerms const&) const = default;

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
  /// Return what add_field and energy return, for terms with the same axes as these and with the
  /// matrix that has these entries.
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> add_field(Vec3<Value> const& m, Vec3<Value> const& h,
                                                    Vec3<Value> const& diagonal,
                                                    Vec3<Value> const& others) const {
    if (form_ == Form::along_z)
      return {h.x, h.y, cayspin::detail::multiply_add(diagonal.z, m.z, h.z)};
    return h + matrix_of(diagonal, others) * m;
  }
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION Value energy(Vec3<Value> const& m, Vec3<Value> const& diagonal,
                                           Vec3<Value> const& others) const {
    return Value(-0.5) * dot(m, matrix_of(diagonal, others) * m);
  }
  /// Returns the sum of |energy| over the terms.
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION Value magnitude(Vec3<Value> const& m) const {
    return Value(0.5) * dot(m, magnitude_.template matrix<Value>() * m);
  }

 private:
  struct Sum {
    double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;
    bool operator==(Sum const&) const = default;

    void add(double c, io::Triple const& e) {
      xx += c * e[0] * e[0], yy += c * e[1] * e[1], zz += c * e[2] * e[2];
      xy += c * e[0] * e[1], xz += c * e[0] * e[2], yz += c * e[1] * e[2];
    }
    Sum with(Sum const& other, double factor) const {
      return {factor * (xx + other.xx), factor * (yy + other.yy), factor * (zz + other.zz),
              factor * (xy + other.xy), factor * (xz + other.xz), factor * (yz + other.yz)};
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
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static cayspin::detail::SymmetricMatrix<Value> matrix_of(
      Vec3<Value> const& diagonal, Vec3<Value> const& others) {
    return {diagonal.x, diagonal.y, diagonal.z, others.x, others.y, others.z};
  }

  enum class Form { none, along_z, any };

  Sum sum_, magnitude_;
  Form form_ = Form::none;
};

/// Returns the quadratic terms of a scene's field.
inline QuadraticTerms quadratic_terms_of(io::Field const& field) {
  QuadraticTerms terms;
  for (auto const& term : field.anisotropies) terms.add(term.constant, term.axis);
  auto const& slab = field.slab_demag;
  if (slab && !slab->on_host && !slab->multirate)
    terms.add(-(field.mu0 * slab->strength), slab->normal);
  return terms;
}

/// A function that computes H along a piece of a row, and is compiled once for all methods;
/// `evaluate` is null if there is none. `is_whole`: the function computes the whole H or, if
/// `lacks_local` is true, all of H but the anisotropy axes and the applied field, which stages add.
template <class Real>
struct FieldAlongRows {
  using Fields = cayspin::detail::RowFields<Real>;
  void (*evaluate)(void const* terms, cayspin::detail::RowOfSpins<Real> const& row,
                   std::int32_t begin, std::int32_t end, Fields const& to) = nullptr;
  void const* terms = nullptr;
  bool is_whole = false, lacks_local = false;
};

/// The field of any scene at one instant, for kernels. Terms are enabled at run time, once per pack
/// of spins, so that a kernel is compiled once for all scenes.
template <class Real>
struct SceneFieldNow {
  SceneLatticeTerms lattice_terms;
  QuadraticTerms quadratic;
  Zeeman zeeman;  // zero without an applied field
  cayspin::detail::StoredField<Real> stored;
  bool has_applied, has_stored;
  cayspin::SiteArray<Real, 1> energies = {};  // of all terms, if one pass computes them
  FieldAlongRows<Real> along_rows = {};
  // Values of sites; with any of them, find_row_ends computes H on whole rows. The first, if it has
  // data, replaces `zeeman`. The others, if they have data, are entries of the matrix of quadratic
  // terms, which replace those of `quadratic`.
  cayspin::SiteArray<Real, 3> applied_of_sites = {}, diagonal_of_sites = {}, others_of_sites = {};
  bool couples_along_x = true;

  // Set by begin_row, for its row.
  cayspin::detail::RowInput<Real> row = {};  // H found so far
  // Number of sites from the second pack on whose H kernels compute: all but those of the last
  // pack; 0 if H of all sites is in `row`; every_site if the ends of rows need no care.
  std::ptrdiff_t compiled_sites = 0;
  bool adds_row = false, adds_more = false;

  static constexpr int row_fields = 1;
  void begin_row(cayspin::detail::RowOfSpins<Real> const& spins, std::int32_t begin,
                 std::int32_t end, cayspin::detail::RowFields<Real> const& fields) {
    constexpr std::ptrdiff_t lanes = cayspin::detail::host_lanes<Real>;
    std::ptrdiff_t const last = (spins.row.nx - 1) / lanes * lanes;
    bool const is_in_row = along_rows.is_whole || has_values_of_sites();
    compiled_sites = is_in_row    ? 0
                     : has_ends() ? std::max<std::ptrdiff_t>(last - lanes, 0)
                                  : every_site;
    row = {fields.data - begin, fields.stride};
    adds_row = along_rows.evaluate != nullptr;
    adds_more = has_stored || adds_row;
    if (adds_row) along_rows.evaluate(along_rows.terms, spins, begin, end, fields);
  }
  bool has_values_of_sites() const { return applied_of_sites.data || diagonal_of_sites.data; }
  /// Returns true if H at the ends of rows differs in form from H between them.
  bool has_ends() const {
    // Single numbers are multiplied by coefficients that are zero; what lies past an end may be
    // NaN.
    return couples_along_x || cayspin::detail::host_lanes<Real> == 1;
  }
  /// Computes H in the packs at the ends of a row, from the results of begin_row.
  void find_row_ends(cayspin::detail::RowOfSpins<Real> const& spins, std::int32_t begin,
                     std::int32_t end, cayspin::detail::RowFields<Real> const& fields,
                     bool turning_alone) const;

  /// Returns H at sites of the row, after begin_row and find_row_ends.
  template <bool TurningAlone, class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> field_along_row(
      Stencil const& stencil) const {
    if (!is_compiled(stencil.site().x())) [[unlikely]]
      return add_lacking(stencil, stencil.site().load(row));
    if constexpr (TurningAlone)
      return add_more(stencil, lattice_terms.add_turning_field(stencil, uniform_part(stencil)));
    else
      return add_more(stencil, lattice_terms.add_field(stencil, uniform_part(stencil)));
  }

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> field(
      Stencil const& stencil) const {
    return add_demagnetization(stencil, lattice_terms.add_field(stencil, local_field(stencil)));
  }
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> gather(
      cayspin::detail::TurningField, Stencil const& stencil) const {
    return add_demagnetization(stencil,
                               lattice_terms.add_turning_field(stencil, local_field(stencil)));
  }

  /// Returns true if the on-site part of H depends on the spin.
  KOKKOS_FORCEINLINE_FUNCTION bool local_field_varies() const { return quadratic.present(); }

  /// Returns the part of H that is linear in the spins: H without the applied field.
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> linear_field(
      Stencil const& stencil) const {
    auto const none = zero<typename Stencil::value_type>();
    return add_demagnetization(
        stencil, lattice_terms.add_field(stencil, add_quadratic_field(stencil, none)));
  }
  /// Return the part of H due to other spins, and the on-site part.
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> gather(
      cayspin::detail::NeighborField, Stencil const& stencil) const {
    return add_demagnetization(stencil, lattice_terms.neighbor_field(stencil));
  }
  // Only methods that refuse values per site ask for the local part.
  template <class Spin>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Spin::value_type> gather(cayspin::detail::LocalField,
                                                                     Spin const& spin) const {
    return uniform_part(spin);
  }
  template <class Spin>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Spin::value_type> local_field(Spin const& spin) const {
    return add_quadratic_field(spin, applied_field(spin));
  }
  /// Returns dH/dt for spins that change at `rates`. Call it on the result of prepare_rate.
  template <class Value, class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> field_rate(Vec3<Value> const&,
                                                     Stencil const& rates) const {
    return field(rates);
  }

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION typename Stencil::value_type energy_density(
      Stencil const& stencil) const {
    if (energies.data) return stencil.site().load(energies);
    auto e = lattice_terms.energy_density(stencil);
    if (quadratic.present()) e = e + quadratic_energy(stencil);
    if (has_applied) e = e + applied_energy(stencil);
    if (has_stored) e = e + stored.energy_density(stencil);
    return e;
  }

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION typename Stencil::value_type energy_magnitude(
      Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    Value e(static_cast<cayspin::detail::scalar_t<Value>>(lattice_terms.magnitude));
    // lattice_terms.magnitude lacks a program's own field, which `energies` includes.
    if (energies.data) return e + Kokkos::abs(stencil.site().load(energies));
    if (quadratic.present()) e = e + quadratic.magnitude(stencil.center());
    if (has_applied) e = e + Kokkos::abs(applied_energy(stencil));
    if (has_stored) e = e + Kokkos::abs(stored.energy_density(stencil));
    return e;
  }

 private:
  template <class Spin>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Spin::value_type> applied_field(
      Spin const& spin) const {
    if (applied_of_sites.data) [[unlikely]]
      return spin.site().load(applied_of_sites);
    return zeeman.field(spin);
  }
  template <class Spin, class Vector>
  KOKKOS_FORCEINLINE_FUNCTION Vector add_quadratic_field(Spin const& spin, Vector const& h) const {
    if (diagonal_of_sites.data) [[unlikely]]
      return quadratic.add_field(spin.center(), h, Vector(spin.site().load(diagonal_of_sites)),
                                 Vector(spin.site().load(others_of_sites)));
    return quadratic.add_field(spin.center(), h);
  }
  template <class Spin>
  KOKKOS_FORCEINLINE_FUNCTION typename Spin::value_type quadratic_energy(Spin const& spin) const {
    using Vector = Vec3<typename Spin::value_type>;
    if (diagonal_of_sites.data) [[unlikely]]
      return quadratic.energy(spin.center(), Vector(spin.site().load(diagonal_of_sites)),
                              Vector(spin.site().load(others_of_sites)));
    return quadratic.energy(spin.center());
  }
  template <class Spin>
  KOKKOS_FORCEINLINE_FUNCTION typename Spin::value_type applied_energy(Spin const& spin) const {
    using Value = typename Spin::value_type;
    return Value(-1) * dot(spin.center(), applied_field(spin));
  }
  // Like local_field, without tests for values of sites.
  template <class Spin>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Spin::value_type> uniform_part(Spin const& spin) const {
    return quadratic.add_field(spin.center(), zeeman.field(spin));
  }
  static constexpr std::ptrdiff_t every_site = -1;  // as an unsigned number, the largest
  KOKKOS_FORCEINLINE_FUNCTION bool is_compiled(std::ptrdiff_t x) const {
    constexpr std::ptrdiff_t first = cayspin::detail::host_lanes<Real>;
    return static_cast<std::size_t>(x - first) < static_cast<std::size_t>(compiled_sites);
  }
  // Vectors are passed as temporaries, because g++ copies named ones through memory.
  template <class Stencil, class Vector>
  KOKKOS_FORCEINLINE_FUNCTION Vector add_lacking(Stencil const& stencil, Vector h) const {
    if (along_rows.lacks_local)
      h = quadratic.add_field(stencil.center(), h) + zeeman.field(stencil);
    return h;
  }
  template <class Stencil, class Vector>
  KOKKOS_FORCEINLINE_FUNCTION Vector add_more(Stencil const& stencil, Vector h) const {
    if (adds_more) [[unlikely]] {
      if (has_stored) h = h + stored.field(stencil);
      if (adds_row) h = h + stencil.site().load(row);
    }
    return h;
  }
  template <class Stencil, class Vector>
  KOKKOS_FORCEINLINE_FUNCTION Vector add_demagnetization(Stencil const& stencil, Vector h) const {
    if (has_stored) [[unlikely]]
      h = h + stored.field(stencil);
    return h;
  }
};

/// Site-dependent numbers that change how spins turn in H.
template <class Real>
struct OwnOfSites {
  cayspin::SiteArray<Real, 1> dampings = {}, rates = {};  // may have no data
  bool precession = true;
  bool rounds_once = false;  // A is rounded as in LandauLifshitz with one damping for all sites

  KOKKOS_FORCEINLINE_FUNCTION bool any() const { return rates.data || dampings.data; }
  /// Returns A. `h`: H if `dampings` has data, otherwise A without site-dependent values.
  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> of(Site const& site, Vec3<Value> const& m,
                                             Vec3<Value> const& h) const {
    if (!any()) [[likely]]
      return h;
    auto a = h;
    if (dampings.data) {
      Value const damping = site.load(dampings);
      auto const turned = cross(m, h);
      if (!precession)
        a = damping * turned;
      else
        a = rounds_once ? multiply_add(damping, turned, h) : h + damping * turned;
    }
    return rates.data ? site.load(rates) * a : a;
  }
};

}  // namespace cayspin::simulation
