// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/field/uniaxial_anisotropy.hpp>

#include <concepts>
#include <utility>

namespace cayspin {

/// A uniform applied field: H = applied, E = -m.H per site.
struct Zeeman {
  Vec3<double> applied;

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> field(Stencil const&) const {
    return as_value<typename Stencil::value_type>(applied);
  }

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION typename Stencil::value_type energy_density(
      Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    return Value(-1) * dot(stencil.center(), as_value<Value>(applied));
  }
};

/// A uniform applied field that changes with time: `applied(t)` is called on the host, once per
/// stage, at the stage's own time.
template <class Applied>
class TimeDependentZeeman {
  static_assert(std::is_invocable_r_v<Vec3<double>, Applied const&, double>,
                "TimeDependentZeeman takes a callable Vec3<double>(double t).");

 public:
  explicit TimeDependentZeeman(Applied applied) : applied_(std::move(applied)) {}

  template <class Exec, class Spins>
  Zeeman prepare(Exec const&, Spins const&, double t) const {
    return {applied_(t)};
  }

 private:
  Applied applied_;
};

}  // namespace cayspin
