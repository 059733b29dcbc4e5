// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Valid user code: terms and generators as plain structs, and observers with and without a result.
// Compiled, not run.
#include <cayspin/cayspin.hpp>

namespace cayspin::test {

#if !defined(__CUDA_ARCH__) && !defined(__HIP_DEVICE_COMPILE__) && !defined(__SYCL_DEVICE_ONLY__)
// Host loops use whole registers even if the default execution space is a device. The pack that
// Kokkos itself would choose depends on that space.
#if defined(KOKKOS_ARCH_AVX512XEON)
static_assert(sizeof(detail::Pack<double>) == 64 && sizeof(detail::Pack<float>) == 64);
#elif defined(KOKKOS_ARCH_AVX2)
static_assert(sizeof(detail::Pack<double>) == 32 && sizeof(detail::Pack<float>) == 32);
#elif defined(KOKKOS_ARCH_ARM_NEON)
static_assert(sizeof(detail::Pack<double>) == 16 && sizeof(detail::Pack<float>) == 16);
#endif
#endif

/// H = -c * (m.m) * m, E = c * (m.m)^2 / 4
struct Quartic {
  double c;
  template <class Stencil>
  KOKKOS_FUNCTION auto field(Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    auto const& m = stencil.center();
    return Value(Value(static_cast<detail::scalar_t<Value>>(-c)) * dot(m, m)) * m;
  }
  template <class Stencil>
  KOKKOS_FUNCTION auto energy_density(Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    auto const square = dot(stencil.center(), stencil.center());
    return Value(Value(static_cast<detail::scalar_t<Value>>(0.25 * c)) * square * square);
  }
};

/// A term that is prepared on the host for each stage.
struct Growing {
  template <class Exec, class Spins>
  Quartic prepare(Exec const&, Spins const&, double t) const {
    return {t};
  }
};

/// A generator that has only the call operator, which returns A.
struct Spinning {
  template <class Stencil>
  KOKKOS_FUNCTION auto operator()(Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    return Vec3<Value>{Value(0), Value(0), Value(1)} + stencil.template next<0>();
  }
};

template <class Real>
double use() {
  Kokkos::DefaultExecutionSpace const exec;
  SpinField<Real> spins("spins", Lattice::chain(10));
  EffectiveField const field(Quartic{1}, Growing(), Zeeman{{0, 0, 1}});
  LandauLifshitz const generator(field, 0.1);
  LieEuler stepper(spins);
  auto const silent = [](auto const&, Step const&, auto const&) {};
  auto const early = [](auto const&, Step const&, auto const&) { return Next::proceed; };
  integrate(exec, stepper, generator, spins, {0, 0.1, 2}, silent, Every(2, early));
  integrate(exec, stepper, Spinning(), spins, {0, 0.1, 2});
  return energy(exec, Quartic{1}, spins).value + energy(exec, generator, spins).value;
}

template double use<float>();
template double use<double>();

}  // namespace cayspin::test
