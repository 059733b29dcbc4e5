// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Milliseconds of an evaluation of the demagnetising field in the default space, beside the six
// transforms alone of a lattice padded with zeros: by the plans of FFTW that it measures to be the
// fastest, or by cuFFT. Both on one thread with OMP_NUM_THREADS=1. Cases are named
// PRECISION/WHAT/SHAPE.
//   bench_demagnetizing_field --benchmark_filter=f64 --benchmark_repetitions=5
#include "main.hpp"
#include "padded_transforms.hpp"
#include "scene.hpp"

#include <cayspin/cayspin.hpp>
#include <cayspin/demagnetization/demagnetizing_field.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

namespace {

constexpr std::array<std::int64_t, 3> shapes[] = {
    {256, 256, 1}, {512, 512, 1}, {64, 64, 64}, {128, 128, 128}};

template <class Real>
void time_field(benchmark::State& state, cayspin::Lattice const& lattice) {
  auto const spins = scene::random<cayspin::SpinField<Real>>(lattice);
  cayspin::HostField const demag(spins, cayspin::DemagnetizingField(spins));
  Kokkos::DefaultExecutionSpace const exec;
  for (int i = 0; i < 2; ++i) demag.prepare(exec, spins, 0);
  exec.fence();
  for (auto _ : state) {
    demag.prepare(exec, spins, 0);
    exec.fence();
  }
}

template <class Real>
void time_transforms(benchmark::State& state, cayspin::Lattice const& lattice) {
  PaddedTransforms<Real> const transforms(lattice);
  for (auto _ : state) {
    for (int component = 0; component < 3; ++component) transforms();
    Kokkos::fence();
  }
}

template <class Real>
void add(std::string const& prefix) {
  for (auto const& shape : shapes) {
    cayspin::Lattice const lattice{.shape = shape};
    std::string name;
    for (auto const n : shape) name += (name.empty() ? "/" : "x") + std::to_string(n);
    scene::add(prefix + "field" + name,
               [lattice](benchmark::State& state) { time_field<Real>(state, lattice); });
    scene::add(prefix + "transforms" + name,
               [lattice](benchmark::State& state) { time_transforms<Real>(state, lattice); });
  }
}

}  // namespace

void register_benchmarks() {
  add<double>("f64/");
  add<float>("f32/");
}
