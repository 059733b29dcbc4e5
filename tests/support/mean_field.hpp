// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/scalars.hpp>

namespace cayspin::test {

/// A term that needs all spins before each stage: H = -strength * <m>, where <m> is the mean over
/// the lattice, and E = strength * <m>.m / 2 per site.
class MeanField {
 public:
  struct Uniform {
    static constexpr int degree = 2;
    Vec3<double> h;

    template <class Stencil>
    KOKKOS_FUNCTION VectorOf<Stencil> field(Stencil const&) const {
      return as_value<typename Stencil::value_type>(h);
    }
    template <class Stencil>
    KOKKOS_FUNCTION ValueOf<Stencil> energy_density(Stencil const& stencil) const {
      using Value = typename Stencil::value_type;
      return Value(-0.5) * dot(as_value<Value>(h), stencil.center());
    }
  };

  explicit MeanField(double strength) : strength_(strength) {}

  template <class Exec, class Spins>
  Uniform prepare(Exec const& exec, Spins const& spins, double) const {
    return {-strength_ * magnetization(exec, spins)};
  }

 private:
  double strength_;
};

}  // namespace cayspin::test
