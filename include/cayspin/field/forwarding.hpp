// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/row_fields.hpp>
#include <cayspin/field/parts.hpp>
#include <cayspin/optional_members.hpp>

#include <type_traits>
#include <utility>

namespace cayspin::inline v0_2 {

namespace detail {

template <class Exec, class Spins>
struct PrepareForRows {
  Exec const& exec;
  Spins const& spins;
  double t;

  template <class Part>
  auto operator()(Part const& part) const {
    return prepare_for_rows(part, exec, spins, t);
  }
};

}  // namespace detail

/// CRTP base with the host members of a term or generator made of others. Its members are called
/// before a kernel, and call those of the parts. Derived has two members:
///   auto with_parts(make) const    returns the kernel version, made of make(part) for each part
///   bool all_parts(test) const     true if test(part) holds for every part
/// Members that Derived defines take precedence. The result of with_parts may omit gather
/// (parts.hpp); RedBlack then does not split the field. It may omit begin_row
/// (detail/row_fields.hpp); the field is then evaluated spin by spin.
template <class Derived, class... Parts>
class Forwarding {
 public:
  static constexpr bool depends_on_time = (detail::depends_on_time<Parts> || ...);
  static constexpr bool is_local = (detail::is_local<Parts> && ...);
  static constexpr bool is_conservative = (detail::is_conservative<Parts> && ...);

  template <class Exec, class Spins>
  auto prepare(Exec const& exec, Spins const& spins, double t) const {
    return derived().with_parts(
        [&](auto const& part) { return detail::prepare_term(part, exec, spins, t); });
  }
  template <class Exec, class Spins>
  auto prepare_for_rows(Exec const& exec, Spins const& spins, double t) const {
    if constexpr (goes_along_rows<Exec, Spins>())
      return derived().with_parts(detail::PrepareForRows<Exec, Spins>{exec, spins, t});
    else
      return derived().prepare(exec, spins, t);
  }
  template <class Exec, class Spins>
  bool rows_need_only_time(Exec const& exec, Spins const& spins) const {
    return derived().all_parts([&](auto const& part) {
      if constexpr (goes_along_rows<Exec, Spins>())
        return detail::rows_need_only_time(part, exec, spins);
      else
        return detail::needs_only_time(part, exec, spins);
    });
  }
  template <class Exec, class Spins>
  bool is_stationary(Exec const& exec, Spins const& spins) const {
    return derived().all_parts(
        [&](auto const& part) { return detail::is_stationary(part, exec, spins); });
  }
  template <class Exec, class Spins>
  bool needs_only_time(Exec const& exec, Spins const& spins) const {
    return derived().all_parts(
        [&](auto const& part) { return detail::needs_only_time(part, exec, spins); });
  }

  friend detail::PartsOf<Parts...> parts_of(Forwarding const*) { return {}; }

 private:
  /// True if the kernel version, made of parts for rows, calls begin_row of each part.
  template <class Exec, class Spins>
  static constexpr bool goes_along_rows() {
    using Make = detail::PrepareForRows<Exec, Spins>;
    using ForRows = decltype(std::declval<Derived const&>().with_parts(std::declval<Make>()));
    return detail::row_fields<ForRows> ==
           (0 + ... + detail::row_fields<std::invoke_result_t<Make, Parts const&>>);
  }

  Derived const& derived() const { return static_cast<Derived const&>(*this); }
};

namespace detail {

/// Marks a term that sees the spins of all sites, even those that the stencil of a
/// FieldWithVacancies hides. parts_of lists the mark as a part.
template <class Term>
struct SeesAllSpins {};

/// Device members for the energy of a term or generator that has one part, Derived::part(). They
/// exist if that part has an energy.
template <class Derived, class Part>
class ForwardingEnergy {
 public:
  static constexpr int energy_terms = detail::energy_terms<Part>;

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION ValueOf<Stencil> energy_density(Stencil const& stencil) const
    requires has_energy_density<Part, Stencil>
  {
    return part().energy_density(stencil);
  }
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION ValueOf<Stencil> energy_magnitude(Stencil const& stencil) const
    requires has_energy_density<Part, Stencil>
  {
    return detail::energy_magnitude(part(), stencil);
  }
  template <class Stencil, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void energy_densities(Stencil const& stencil, Value* energies) const
    requires has_energy_density<Part, Stencil>
  {
    detail::energy_densities(part(), stencil, energies);
  }

 private:
  KOKKOS_FORCEINLINE_FUNCTION Part const& part() const {
    return static_cast<Derived const&>(*this).part();
  }
};

}  // namespace detail
}  // namespace cayspin::inline v0_2
