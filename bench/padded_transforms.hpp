// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/demagnetization/fftw.hpp>
#include <cayspin/lattice.hpp>

#include <Kokkos_Core.hpp>

#include <cstddef>

/// Twice the lattice's along each axis that is longer than a cell, x last.
struct PaddedExtents {
  int extent[3];

  explicit PaddedExtents(cayspin::Lattice const& lattice) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      auto const n = static_cast<int>(lattice.shape[axis]);
      extent[2 - axis] = n > 1 ? 2 * n : 1;
    }
  }
  std::size_t waves() const {
    return static_cast<std::size_t>(extent[0]) * static_cast<std::size_t>(extent[1]) *
           static_cast<std::size_t>(extent[2] / 2 + 1);
  }
};

#if defined(KOKKOS_ENABLE_CUDA)
#include "padded_transforms_cufft.hpp"
#else

/// Of zeros, which stay what they are.
template <class Real>
class PaddedTransforms {
  using Functions = cayspin::detail::Fftw<Real>;
  using Complex = typename Functions::Complex;

 public:
  explicit PaddedTransforms(cayspin::Lattice const& lattice) {
    PaddedExtents const extents(lattice);
    auto const waves = extents.waves();
    int const* const extent = extents.extent;
    numbers_ = Kokkos::View<Real*, Kokkos::HostSpace>("numbers", 2 * waves);
    forward_ = Functions::plan_forward(3, extent, 1, numbers_.data(), nullptr, 1, 0, spectrum(),
                                       nullptr, 1, 0, FFTW_MEASURE);
    backward_ = Functions::plan_backward(3, extent, 1, spectrum(), nullptr, 1, 0, numbers_.data(),
                                         nullptr, 1, 0, FFTW_MEASURE);
    Kokkos::deep_copy(numbers_, Real(0));
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

  Kokkos::View<Real*, Kokkos::HostSpace> numbers_;
  typename Functions::Plan forward_, backward_;
};

#endif
