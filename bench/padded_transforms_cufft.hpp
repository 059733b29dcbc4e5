// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

// PaddedTransforms by cuFFT; read through padded_transforms.hpp.
#include <cayspin/demagnetization/cufft.hpp>

#include <Kokkos_Core.hpp>

/// Of zeros, which stay what they are.
template <class Real>
class PaddedTransforms {
  using Functions = cayspin::detail::Cufft<Real>;

 public:
  explicit PaddedTransforms(cayspin::Lattice const& lattice)
      : numbers_("numbers", 2 * PaddedExtents(lattice).waves()) {
    using cayspin::detail::require_cufft;
    PaddedExtents const extents(lattice);
    auto const [z, y, x] = extents.extent;
    require_cufft(cufftPlan3d(&forward_, z, y, x, Functions::forward));
    require_cufft(cufftPlan3d(&backward_, z, y, x, Functions::backward));
  }
  ~PaddedTransforms() {
    cufftDestroy(forward_);
    cufftDestroy(backward_);
  }
  PaddedTransforms(PaddedTransforms const&) = delete;
  PaddedTransforms& operator=(PaddedTransforms const&) = delete;

  void operator()() const {
    auto* const spectrum = reinterpret_cast<typename Functions::Complex*>(numbers_.data());
    Functions::run_forward(forward_, numbers_.data(), spectrum);
    Functions::run_backward(backward_, spectrum, numbers_.data());
  }

 private:
  Kokkos::View<Real*> numbers_;
  cufftHandle forward_{}, backward_{};
};
