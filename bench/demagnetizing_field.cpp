// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Milliseconds per evaluation of the demagnetising field in the default space, next to those of the
// six transforms of a zero-padded lattice, by FFTW with measured plans or by cuFFT. With
// OMP_NUM_THREADS=1 field and transforms run on one thread. Cases are named PRECISION/field/SHAPE
// and PRECISION/transforms/SHAPE.
//   bench_demagnetizing_field --benchmark_filter=f64 --benchmark_repetitions=5
#include "main.hpp"
#include "scene.hpp"

#include <cayspin/cayspin.hpp>
#include <cayspin/demagnetization/demagnetizing_field.hpp>
#include <cayspin/demagnetization/device_transforms.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

namespace {

constexpr std::array<std::int64_t, 3> shapes[] = {
    {256, 256, 1}, {512, 512, 1}, {64, 64, 64}, {128, 128, 128}};

/// A forward and a backward transform of one component on a lattice padded to twice its extent
/// along each axis of more than one cell. All values are zero, before and after.
template <class Real>
class PaddedTransforms {
#if defined(KOKKOS_ENABLE_CUDA)
  using Functions = cayspin::detail::Cufft<Real>;
  using Numbers = Kokkos::View<Real*, Kokkos::CudaSpace>;
#else
  using Functions = cayspin::detail::Fftw<Real>;
  using Numbers = Kokkos::View<Real*, Kokkos::HostSpace>;
#endif
  using Complex = typename Functions::Complex;

 public:
  explicit PaddedTransforms(cayspin::Lattice const& lattice) {
    int extent[3];  // x last
    for (std::size_t axis = 0; axis < 3; ++axis) {
      auto const n = static_cast<int>(lattice.shape[axis]);
      extent[2 - axis] = n > 1 ? 2 * n : 1;
    }
    auto const waves = static_cast<std::size_t>(extent[0]) * static_cast<std::size_t>(extent[1]) *
                       static_cast<std::size_t>(extent[2] / 2 + 1);
    numbers_ = Numbers("numbers", 2 * waves);
#if defined(KOKKOS_ENABLE_CUDA)
    using cayspin::detail::require_cufft;
    require_cufft(cufftPlan3d(&forward_, extent[0], extent[1], extent[2], Functions::forward));
    require_cufft(cufftPlan3d(&backward_, extent[0], extent[1], extent[2], Functions::backward));
#else
    forward_ = Functions::plan_forward(3, extent, 1, numbers_.data(), nullptr, 1, 0, spectrum(),
                                       nullptr, 1, 0, FFTW_MEASURE);
    backward_ = Functions::plan_backward(3, extent, 1, spectrum(), nullptr, 1, 0, numbers_.data(),
                                         nullptr, 1, 0, FFTW_MEASURE);
    Kokkos::deep_copy(numbers_, Real(0));
#endif
  }
  ~PaddedTransforms() {
    Functions::destroy(forward_);
    Functions::destroy(backward_);
  }
  PaddedTransforms(PaddedTransforms const&) = delete;
  PaddedTransforms& operator=(PaddedTransforms const&) = delete;

  void operator()() const {
    Functions::run_forward(forward_, numbers_.data(), spectrum());
    Functions::run_backward(backward_, spectrum(), numbers_.data());
  }

 private:
  Complex* spectrum() const { return reinterpret_cast<Complex*>(numbers_.data()); }

  Numbers numbers_;
  typename Functions::Plan forward_{}, backward_{};
};

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
