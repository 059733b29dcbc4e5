// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/stencil.hpp>

#include <concepts>
#include <utility>

namespace cayspin::inline v0_2 {

/// A uniform applied field: H = applied, E = -m.H per site. Evaluation throws std::invalid_argument
/// when `applied` is not finite.
struct Zeeman {
  static constexpr int degree = 1;  // H does not depend on the spins
  static constexpr bool is_local = true;
  Vec3<double> applied;

  template <class Spins>
  void check_spins(Spins const&) const {
    detail::finite(applied, "cayspin::Zeeman: the applied field");
  }

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> field(Stencil const&) const {
    return as_value<ValueOf<Stencil>>(applied);
  }

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION ValueOf<Stencil> energy_density(Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    return Value(-1) * dot(stencil.center(), as_value<Value>(applied));
  }
};

/// A uniform applied field that changes with time: `applied(t)` is called on the host before each
/// evaluation of the field, with its time t.
template <class Applied>
class TimeDependentZeeman {
  static_assert(std::is_invocable_r_v<Vec3<double>, Applied const&, double>,
                "TimeDependentZeeman takes a callable Vec3<double>(double t).");

 public:
  static constexpr bool depends_on_time = true;
  static constexpr bool is_local = true;

  explicit TimeDependentZeeman(Applied applied) : applied_(std::move(applied)) {}

  template <class Exec, class Spins>
  Zeeman prepare(Exec const&, Spins const&, double t) const {
    return Zeeman{detail::finite(applied_(t), "cayspin::TimeDependentZeeman: the applied field")};
  }
  Applied const& applied() const { return applied_; }

 private:
  Applied applied_;
};

}  // namespace cayspin::inline v0_2
