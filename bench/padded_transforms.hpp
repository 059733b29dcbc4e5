// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/demagnetization/device_transforms.hpp>
#include <cayspin/lattice.hpp>

#include <Kokkos_Core.hpp>

#include <cstddef>

/// Transforms there and back of a lattice padded to twice its length along each axis that is longer
/// than a cell. Of zeros, which stay what they are.
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
