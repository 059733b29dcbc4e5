// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/distant_sites.hpp>
#include <cayspin/detail/pack.hpp>
#include <cayspin/spin_field.hpp>
#include <cayspin/vec3.hpp>

#include <Kokkos_Core.hpp>

#include <cstdint>

namespace cayspin::simulation {

/// Bonds from each site to the site at `offset` from it, with only vacant sites in between.
template <class Real>
struct DistantBonds {
  std::int32_t offset[3] = {};
  cayspin::SiteArray<Real, 1> bilinear, biquadratic;  // 0 where there is no bond
  cayspin::SiteArray<Real, 1> exchange = {};          // constant at the other end; may have no data
  double per_square = 0;                              // 2 / spacing^2
};

/// Bonds to the next and the previous site along each axis, and the `distant` ones. The energy of a
/// bond is E = -J * s.s' - B * (s.s')^2, where s and s' are the spins on the two sides of the face
/// between the cells. `bilinear` (J) and `biquadratic` (B) hold the bonds to the next sites along
/// each axis; without data there are none along that axis. In the half cell between the centre and
/// the face, exchange A adds the energy k * (1 - m.s), where m is the spin of the cell and
/// k = 2 * A / spacing^2. The spins s and s' minimise the total energy of the bond and its two half
/// cells. This boundary condition of exchange at the face makes thick layers accurate to second
/// order in the spacing (as in Suess et al., PRB 107, 104424, 2023). Where A is 0, and if
/// `exchange` has no data, s is m.
template <class Real>
struct InterlayerOfSites {
  cayspin::detail::DistantSites<Real> spins;
  cayspin::SiteArray<Real, 1> bilinear[3] = {}, biquadratic[3] = {};
  cayspin::SiteArray<Real, 1> exchange = {};  // A; may have no data
  double per_square[3] = {};                  // 2 / spacing^2
  std::int32_t sweeps = 0;                    // after so many sweeps, s is exact to rounding
  DistantBonds<Real> const* distant = nullptr;
  std::int32_t distant_count = 0;

  KOKKOS_FORCEINLINE_FUNCTION bool any() const {
    return bilinear[0].data || bilinear[1].data || bilinear[2].data || distant_count > 0;
  }
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> field(
      Stencil const& stencil) const {
    FieldOrEnergy<true, Stencil> sum{*this, stencil};
    sum.add_all();
    return sum.field;
  }
  /// Returns half the energy of the site's bonds.
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION typename Stencil::value_type energy_density(
      Stencil const& stencil) const {
    FieldOrEnergy<false, Stencil> sum{*this, stencil};
    sum.add_all();
    return sum.energy;
  }

 private:
  template <bool IsField, class Stencil>
  struct FieldOrEnergy {
    using Value = typename Stencil::value_type;
    InterlayerOfSites const& bonds;
    Stencil const& stencil;
    Vec3<Value> field = zero<Value>();
    Value energy = Value(0);

    KOKKOS_FORCEINLINE_FUNCTION void add_all() {
      add<0>(), add<1>(), add<2>();
      for (std::int32_t i = 0; i < bonds.distant_count; ++i) add(bonds.distant[i]);
    }

   private:
    template <int Axis>
    KOKKOS_FORCEINLINE_FUNCTION void add() {
      if (!bonds.bilinear[Axis].data) return;
      auto const none = zero<Value>();
      auto const& site = stencil.site();
      Value const J = site.load(bonds.bilinear[Axis]), B = site.load(bonds.biquadratic[Axis]);
      Value own(0), on(0), back(0);
      if (bonds.exchange.data) {
        auto const factor = as_value<Value>(bonds.per_square[Axis]);
        own = site.load(bonds.exchange);
        on = factor * site.template neighbor<Axis, 1>(bonds.exchange, own);
        back = factor * site.template neighbor<Axis, 0>(bonds.exchange, own);
        own = factor * own;
      }
      add_bond(J, B, own, on, stencil.template next<Axis>(none));
      add_bond(site.template neighbor<Axis, 0>(bonds.bilinear[Axis], J),
               site.template neighbor<Axis, 0>(bonds.biquadratic[Axis], B), own, back,
               stencil.template previous<Axis>(none));
    }
    KOKKOS_FORCEINLINE_FUNCTION void add(DistantBonds<Real> const& of) {
      auto const& site = stencil.site();
      auto const [dx, dy, dz] = of.offset;
      Real const* const row = bonds.spins.row(site.y(), site.z(), dy, dz);
      if (!row) return;
      Value own(0), other(0);
      if (bonds.exchange.data) {
        own = as_value<Value>(of.per_square) * site.load(bonds.exchange);
        other = as_value<Value>(of.per_square) * site.load(of.exchange);
      }
      add_bond(site.load(of.bilinear), site.load(of.biquadratic), own, other,
               bonds.spins.template along<Value>(row, site.x() + dx));
    }
    KOKKOS_FORCEINLINE_FUNCTION void add_bond(Value const& J_of_bond, Value const& B_of_bond,
                                              Value const& k, Value const& k_of_other,
                                              Vec3<Value> const& other) {
      using cayspin::detail::holds_everywhere, cayspin::detail::select;
      auto const& m = stencil.center();
      Value const none(0), is_there = dot(other, other);
      Value const J = select<Value>(is_there == none, none, J_of_bond);
      Value const B = select<Value>(is_there == none, none, B_of_bond);
      auto const has_none = Kokkos::abs(J) + Kokkos::abs(B) == none;
      if (holds_everywhere(has_none)) return;  // few sites are at faces
      auto s = m, s_of_other = other;
      for (std::int32_t sweep = 0; sweep < bonds.sweeps; ++sweep) {
        auto const s_before = s, before = s_of_other;
        s = at_face(k, m, J, B, s, s_of_other);
        s_of_other = at_face(k_of_other, other, J, B, s_of_other, s);
        if (are_equal(s, s_before) && are_equal(s_of_other, before)) break;
      }
      Value const along = dot(s, s_of_other);
      if constexpr (IsField) {
        Value const strength = J + Value(2) * B * along;
        auto const direct = strength * s_of_other, through_cell = k * (s - m);
        field = field + select<Value>(k == none, direct,
                                      select<Value>(has_none, zero<Value>(), through_cell));
      } else {
        Value const bent =
            k * (Value(1) - dot(m, s)) + k_of_other * (Value(1) - dot(other, s_of_other));
        Value const bond = bent - (J + B * along) * along;
        energy = energy + Value(0.5) * select<Value>(has_none, none, bond);
      }
    }
    KOKKOS_FORCEINLINE_FUNCTION static bool are_equal(Vec3<Value> const& a, Vec3<Value> const& b) {
      return cayspin::detail::holds_everywhere(a.x == b.x && a.y == b.y && a.z == b.z);
    }
    /// Returns a better approximation of the s that minimises
    /// k * (1 - m.s) - J * s.s' - B * (s.s')^2; for B = 0 it is exact at the given s'. Without
    /// exchange (k = 0) returns m, the spin of the cell.
    KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> at_face(Value const& k, Vec3<Value> const& m,
                                                           Value const& J, Value const& B,
                                                           Vec3<Value> const& s,
                                                           Vec3<Value> const& s_of_other) {
      using cayspin::detail::select;
      Value const none(0);
      auto const sum =
          multiply_add(k, m, Value(J + Value(2) * B * dot(s, s_of_other)) * s_of_other);
      Value const square = dot(sum, sum);
      Value const length = Kokkos::sqrt(select<Value>(square == none, Value(1), square));
      return select<Value>(k == none, m, Value(Value(1) / length) * sum);
    }
  };
};

}  // namespace cayspin::simulation
