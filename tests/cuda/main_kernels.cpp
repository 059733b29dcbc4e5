// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The kernels whose instructions the test `sass` counts. Nothing is run.
#include <cayspin/cayspin.hpp>
#include <cayspin/stepper/paired_stages.hpp>

namespace cayspin::test {

using Exec = Kokkos::DefaultExecutionSpace;
using Generator = LandauLifshitz<EffectiveField<Exchange, UniaxialAnisotropy, Zeeman>>;

template <class Real>
struct MainKernels {
  using S = SpinField<Real, Exec::memory_space>;
  LieEuler<S> euler;
  LieHeun<S> heun;
  Rkmk4<S> rkmk4;
  StereographicRungeKutta<S, tableau::Heun> chart_heun;
  StereographicRungeKutta<S, tableau::Classical4> chart_rk4;
  PairedStages<LieEuler<S>> euler_in_pairs;
  PairedStages<LieHeun<S>> heun_in_pairs;
  PairedStages<Rkmk4<S>> rkmk4_in_pairs;
  PairedStages<StereographicRungeKutta<S, tableau::Heun>> chart_heun_in_pairs;
  PairedStages<StereographicRungeKutta<S, tableau::Classical4>> chart_rk4_in_pairs;

  void step(Generator const& generator, S& spins) {
    auto const each = [&](auto&... stepper) {
      (stepper.step(Exec(), generator, spins, 0, 0.1), ...);
    };
    each(euler, heun, rkmk4, chart_heun, chart_rk4, heun_in_pairs, rkmk4_in_pairs,
         chart_heun_in_pairs, chart_rk4_in_pairs);
    euler_in_pairs.batch(Exec(), generator, spins, 0, 0.1, 2);
  }
};

template struct MainKernels<float>;
template struct MainKernels<double>;

}  // namespace cayspin::test
