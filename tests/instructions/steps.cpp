// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Runs the main methods and a sample under callgrind, which writes one dump for each of them, with
// the instructions that its kernels executed.
#include "here.hpp"

#include <cayspin/field/effective_field.hpp>
#include <cayspin/field/exchange.hpp>
#include <cayspin/field/uniaxial_anisotropy.hpp>
#include <cayspin/field/zeeman.hpp>
#include <cayspin/generator/landau_lifshitz.hpp>
#include <cayspin/observer/record.hpp>
#include <cayspin/stepper/corrected_euler.hpp>
#include <cayspin/stepper/methods.hpp>

namespace cayspin::instructions {
namespace {

Lattice const lattice = Lattice::cubic(64, 4, 4);  // callgrind.py uses its number of sites
LandauLifshitz const generator(EffectiveField(Exchange(lattice, 1),
                                              UniaxialAnisotropy(0.5, {0, 0, 1}),
                                              Zeeman{{0, 0, 0.3}}),
                               0.1);

template <class Stepper>
void count_step(char const* name) {
  typename Stepper::spins_type spins("spins", lattice);
  Stepper stepper(spins);
  stepper.use(Path::pass);
  CALLGRIND_ZERO_STATS;
  stepper.step(Here(), generator, spins, 0, 0.01);
  CALLGRIND_DUMP_STATS_AT(name);
}

template <class Spins>
void count_sample(char const* name) {
  Spins const spins("spins", lattice);
  using Generator = std::remove_const_t<decltype(generator)>;
  using Look = detail::SampleOfSites<Generator, detail::NoGenerator, typename Spins::value_type>;
  auto const look = [&] {
    detail::reduce_sites<detail::SumsThenMaxima<Look::sums>, Look::count>(
        Here(), "sample", spins.layout(), Look{generator, {}, spins.array()});
  };
  look();  // makes the loader bind the functions of the C library
  CALLGRIND_ZERO_STATS;
  look();
  CALLGRIND_DUMP_STATS_AT(name);
}

}  // namespace
}  // namespace cayspin::instructions

int main() {
  using namespace cayspin;
  using namespace cayspin::instructions;
  using F64 = Spins<double>;
  using F32 = Spins<float>;
  count_step<LieEuler<F64>>("f64_LieEuler");
  count_step<LieHeun<F64>>("f64_LieHeun");
  count_step<Rkmk4<F64>>("f64_Rkmk4");
  count_step<Rkmk4<F32>>("f32_Rkmk4");
  count_step<StereographicRungeKutta<F64, tableau::Heun>>("f64_StereographicHeun");
  count_step<StereographicRungeKutta<F64, tableau::Classical4>>("f64_StereographicRk4");
  count_step<StereographicRungeKutta<F32, tableau::Classical4>>("f32_StereographicRk4");
  count_step<ProjectedRk4<F64>>("f64_ProjectedRk4");
  count_step<ProjectedRungeKutta<F64, tableau::Oscillatory74>>("f64_Projected74");
  count_sample<F64>("f64_sample");
}
