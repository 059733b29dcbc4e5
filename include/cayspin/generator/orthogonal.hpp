// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/row_fields.hpp>
#include <cayspin/field/forwarding.hpp>
#include <cayspin/optional_members.hpp>
#include <cayspin/stencil.hpp>

#include <cstdint>
#include <utility>

namespace cayspin::inline v0_2 {

namespace detail {

/// Returns A - (m.A) * m.
template <class Value>
KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> orthogonal_part(Vec3<Value> const& a,
                                                        Vec3<Value> const& m) {
  return multiply_add(Value(Value(0) - dot(m, a)), m, a);
}

}  // namespace detail

/// A generator from which the component along the spin is removed: A_o = A - (m.A) * m.
template <class Generator>
class Orthogonal : public Forwarding<Orthogonal<Generator>, Generator>,
                   public detail::ForwardingEnergy<Orthogonal<Generator>, Generator> {
 public:
  explicit Orthogonal(Generator generator) : generator_(std::move(generator)) {}

  // Members that Forwarding calls.
  template <class Make>
  auto with_parts(Make const& make) const {
    auto prepared = make(generator_);
    return Orthogonal<decltype(prepared)>(std::move(prepared));
  }
  template <class Test>
  bool all_parts(Test const& test) const {
    return test(generator_);
  }
  KOKKOS_FORCEINLINE_FUNCTION Generator const& part() const { return generator_; }

  // Members for host loops over rows (detail/row_fields.hpp).
  static constexpr int row_fields = detail::row_fields<Generator>;
  template <class Real>
  void begin_row(detail::RowOfSpins<Real> const& row, std::int32_t begin, std::int32_t end,
                 detail::RowFields<Real> const& fields) {
    if constexpr (row_fields > 0) generator_.begin_row(row, begin, end, fields);
  }

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> operator()(
      Stencil const& stencil) const {
    return detail::orthogonal_part(detail::evaluate(generator_, stencil), stencil.center());
  }
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> turning_part(
      Stencil const& stencil) const {
    return detail::turning_part(generator_, stencil);
  }

  bool conserves_energy() const
    requires(requires(Generator const& generator) { generator.conserves_energy(); })
  {
    return generator_.conserves_energy();
  }
  KOKKOS_FUNCTION static constexpr bool is_orthogonal() { return true; }

  // For isotropy::Energy; only for a generator of rigid bodies.
  template <class Value, class Site>
  KOKKOS_FORCEINLINE_FUNCTION auto inverse_inertia(Site const& site) const {
    return generator_.template inverse_inertia<Value>(site);
  }

 private:
  Generator generator_;
};

template <class Generator>
Orthogonal<Generator> orthogonal(Generator generator) {
  return Orthogonal<Generator>(std::move(generator));
}

}  // namespace cayspin::inline v0_2
