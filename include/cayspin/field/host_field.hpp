// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/ghosts.hpp>
#include <cayspin/spin_field.hpp>
#include <cayspin/stencil.hpp>

#include <type_traits>
#include <utility>

namespace cayspin::inline v0_2 {

namespace detail {

template <class Real>
struct StoredField {
  SiteArray<Real, 3> array;
  double energy_factor;

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> field(Stencil const& stencil) const {
    return stencil.site().load(array);
  }
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION ValueOf<Stencil> energy_density(Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    return as_value<Value>(energy_factor) * dot(stencil.center(), stencil.site().load(array));
  }
};

}  // namespace detail

/// A field that host code computes from all spins at once. Use it to add any non-local field (an
/// FFT demag, a boundary-element solver). For each evaluation, the spins are copied to host memory,
/// `solver(spins, field, t)` fills `field`, and `field` is copied back. If the spins are in host
/// memory, nothing is copied. On a part of a lattice (mpi::Domain) the solver gets that part, and
/// fills all sites but its ghosts.
///
/// Solver: a callable void(SpinField<Real, HostSpace> const& spins, SpinField<Real, HostSpace>
/// const& field, double t) with a member `degree`: 1 when H does not depend on m (E = -m.H), 2 when
/// H is a symmetric linear function of m (E = -m.H/2). A solver callable as solver(exec, spins,
/// field, t), with fields in the memory space of the spins, is called that way without copies.
template <class Spins, class Solver>
class HostField {
  using Real = typename Spins::value_type;
  using HostSpins = SpinField<Real, Kokkos::HostSpace>;
  static constexpr bool on_host = std::is_same_v<typename Spins::memory_space, Kokkos::HostSpace>;
  static constexpr bool in_place =
      std::is_invocable_v<Solver const&, typename Spins::memory_space::execution_space const&,
                          Spins const&, Spins const&, double>;
  static_assert(in_place ||
                    std::is_invocable_v<Solver const&, HostSpins const&, HostSpins const&, double>,
                "HostField needs a solver callable as solver(host_spins, host_field, t) const.");
  static_assert(
      requires { requires Solver::degree == 1 || Solver::degree == 2; },
      "HostField's solver needs a static constexpr int degree: 1 for H independent of m, "
      "2 for H linear in m.");

 public:
  HostField(Lattice const& lattice, Solver solver)
      : solver_(std::move(solver)), field_("HostField::field", lattice) {
    if constexpr (!on_host && !in_place) {
      host_spins_ = HostSpins("HostField::host_spins", lattice);
      host_field_ = HostSpins("HostField::host_field", lattice);
    }
  }
  /// Uses the lattice, precision and memory space of the spins `like`.
  HostField(Spins const& like, Solver solver) : HostField(like.lattice(), std::move(solver)) {}

  template <class Others>
  void check_spins(Others const& spins) const {
    static_assert(std::is_same_v<Others, Spins>,
                  "HostField was made for spins of another precision or memory space: "
                  "HostField(spins, solver) takes both from the spins.");
    require_lattice("cayspin::HostField", field_.lattice(), spins.lattice());
  }

  bool is_affine() const { return true; }  // by the solver's degree

  template <class Exec, class Others>
  detail::StoredField<Real> prepare(Exec const& exec, Others const& spins, double t) const {
    if constexpr (!std::is_same_v<Others, Spins>) {
      // a static_assert in check_spins refuses these spins
    } else if constexpr (in_place) {
      solver_(exec, spins, field_, t);
      detail::update_ghosts(exec, field_.lattice(), field_);
    } else if constexpr (on_host) {
      exec.fence("cayspin::HostField: spins ready");
      solver_(spins, field_, t);
      detail::update_ghosts(exec, field_.lattice(), field_);
    } else {
      Kokkos::deep_copy(exec, host_spins_.allocation(), spins.allocation());
      exec.fence("cayspin::HostField: spins copied");
      solver_(host_spins_, host_field_, t);
      Kokkos::deep_copy(exec, field_.allocation(), host_field_.allocation());
      detail::update_ghosts(exec, field_.lattice(), field_);
    }
    return {field_.array(), Solver::degree == 1 ? -1.0 : -0.5};
  }

 private:
  Solver solver_;
  Spins field_;
  HostSpins host_spins_, host_field_;
};

namespace detail {
template <class Term>
inline constexpr bool is_host_field = false;
template <class Spins, class Solver>
inline constexpr bool is_host_field<HostField<Spins, Solver>> = true;
}  // namespace detail

/// Deduces double precision in the default memory space when no spins are given.
template <class Solver>
HostField(Lattice, Solver) -> HostField<SpinField<double>, Solver>;

}  // namespace cayspin::inline v0_2
