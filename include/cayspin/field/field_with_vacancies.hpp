// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/field/coefficient.hpp>
#include <cayspin/field/forwarding.hpp>
#include <cayspin/field/pair_couplings.hpp>
#include <cayspin/field/parts.hpp>
#include <cayspin/stencil.hpp>

#include <stdexcept>
#include <type_traits>
#include <utility>

namespace cayspin::inline v0_2 {

namespace detail {

/// A stencil that treats a vacant neighbour as missing: the spin at the centre, or the vector
/// passed for missing neighbours, replaces it.
template <class Stencil, class Real>
class StencilAmongVacancies {
 public:
  using value_type = typename Stencil::value_type;
  using vector_type = typename Stencil::vector_type;

  KOKKOS_FORCEINLINE_FUNCTION StencilAmongVacancies(Stencil const& stencil,
                                                    SiteArray<Real, 1> const& occupation)
      : stencil_(stencil), occupation_(occupation) {}

  KOKKOS_FORCEINLINE_FUNCTION vector_type const& center() const { return stencil_.center(); }
  template <int Axis>
  KOKKOS_FORCEINLINE_FUNCTION vector_type previous() const {
    return unless_vacant<Axis, 0>(stencil_.template previous<Axis>(), center());
  }
  template <int Axis>
  KOKKOS_FORCEINLINE_FUNCTION vector_type next() const {
    return unless_vacant<Axis, 1>(stencil_.template next<Axis>(), center());
  }
  template <int Axis>
  KOKKOS_FORCEINLINE_FUNCTION vector_type previous(vector_type const& missing) const {
    return unless_vacant<Axis, 0>(stencil_.template previous<Axis>(missing), missing);
  }
  template <int Axis>
  KOKKOS_FORCEINLINE_FUNCTION vector_type next(vector_type const& missing) const {
    return unless_vacant<Axis, 1>(stencil_.template next<Axis>(missing), missing);
  }
  KOKKOS_FORCEINLINE_FUNCTION auto const& site() const { return stencil_.site(); }

 private:
  template <int Axis, int Direction>
  KOKKOS_FORCEINLINE_FUNCTION vector_type unless_vacant(vector_type const& neighbor,
                                                        vector_type const& missing) const {
    value_type const zero(0);  // on hosts also the result past an open end along x
    auto const vacant = site().template neighbor<Axis, Direction>(occupation_, zero) == zero;
    return select<value_type>(vacant, missing, neighbor);
  }

  Stencil const& stencil_;
  SiteArray<Real, 1> const& occupation_;
};

/// A FieldWithVacancies prepared for one time, for kernels.
template <class Field, class Real>
class FieldAmongVacancies {
  template <class Stencil>
  using Inner = StencilAmongVacancies<Stencil, Real>;

 public:
  static constexpr bool is_local = detail::is_local<Field>;
  static constexpr int energy_terms = detail::energy_terms<Field>;

  FieldAmongVacancies(Field field, SiteArray<Real, 1> const& occupation)
      : field_(std::move(field)), occupation_(occupation) {}

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> field(Stencil const& stencil) const {
    return gather(WholeField(), stencil);
  }
  template <class Take, class Stencil>
    requires(!std::is_same_v<Take, TurningField>)  // turning_field() then calls `field`
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> gather(Take const& take,
                                                       Stencil const& stencil) const {
    return unless_vacant(stencil, take(field_, Inner<Stencil>(stencil, occupation_)));
  }
  KOKKOS_FORCEINLINE_FUNCTION bool local_field_varies() const {
    return detail::local_field_varies(field_);
  }

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION ValueOf<Stencil> energy_density(Stencil const& stencil) const {
    return unless_vacant(stencil, field_.energy_density(Inner<Stencil>(stencil, occupation_)));
  }
  template <class Stencil, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void energy_densities(Stencil const& stencil, Value* energies) const {
    detail::energy_densities(field_, Inner<Stencil>(stencil, occupation_), energies);
    for (int i = 0; i < energy_terms; ++i) energies[i] = unless_vacant(stencil, energies[i]);
  }

  friend PartsOf<Field> parts_of(FieldAmongVacancies const*) { return {}; }

 private:
  template <class Stencil, class Value>
  KOKKOS_FORCEINLINE_FUNCTION Value unless_vacant(Stencil const& stencil,
                                                  Value const& value) const {
    return select<Value>(stencil.site().load(occupation_) == Value(0), Value(0), value);
  }
  template <class Stencil, class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> unless_vacant(Stencil const& stencil,
                                                        Vec3<Value> const& h) const {
    return {unless_vacant(stencil, h.x), unless_vacant(stencil, h.y), unless_vacant(stencil, h.z)};
  }

  Field field_;
  SiteArray<Real, 1> occupation_;
};

}  // namespace detail

/// A field on a lattice with vacancies. `occupation` is 1 on sites that hold a spin and 0 on vacant
/// ones. A vacant site has no field and no energy, so steps leave its spin unchanged; its
/// neighbours see a missing spin, as past an open end. User terms that use the stencil need no
/// change. Every term must be in `field`: a term outside of it still rotates the spins of vacant
/// sites. A HostField's solver receives these spins too, and must leave them out.
template <class Field, class Real, class MemorySpace>
class FieldWithVacancies : public Forwarding<FieldWithVacancies<Field, Real, MemorySpace>, Field> {
  static_assert(!detail::holds<PairCouplings, Field>(),
                "PairCouplings read the spins of vacant sites: where these are zero vectors, no "
                "FieldWithVacancies is needed.");
  static_assert(!detail::holds<detail::SeesAllSpins, Field>(),
                "SlowField evaluates its term for the spins of vacant sites, too: inside "
                "FieldWithVacancies it takes a HostField or a local term.");

 public:
  static constexpr int energy_terms = detail::energy_terms<Field>;

  /// Throws std::invalid_argument when an occupation is neither 0 nor 1.
  FieldWithVacancies(Field field, ScalarField<Real, MemorySpace> occupation)
      : field_(std::move(field)), occupation_(std::move(occupation)) {
    if (!detail::signs_of(occupation_, "cayspin::FieldWithVacancies: the occupation").zero_or_one)
      throw std::invalid_argument(
          "cayspin::FieldWithVacancies: the occupation must be 0 or 1 on every site");
  }

  template <class Spins>
  void check_spins(Spins const& spins) const {
    detail::require_lattice_of(spins, occupation_, "cayspin::FieldWithVacancies");
  }
  // Called by Forwarding.
  template <class Make>
  auto with_parts(Make const& make) const {
    using Prepared = decltype(make(field_));
    return detail::FieldAmongVacancies<Prepared, Real>(make(field_), occupation_.array());
  }
  template <class Test>
  bool all_parts(Test const& test) const {
    return test(field_);
  }

 private:
  Field field_;
  ScalarField<Real, MemorySpace> occupation_;
};

}  // namespace cayspin::inline v0_2
