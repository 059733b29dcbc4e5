// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/demagnetization/fftw.hpp>
#include <cayspin/detail/execution.hpp>

#if defined(KOKKOS_ENABLE_CUDA)
#include <cayspin/demagnetization/cufft.hpp>
#endif

// Selects the FFT library of an execution space. The classes for both libraries have the members
// that device code calls.
namespace cayspin::inline v0_2::detail {

/// FFTW in host spaces, so that tests can run the device code there. Other spaces have no
/// transforms, except CUDA (below).
template <class Exec>
struct DeviceTransforms {
  static constexpr bool exist = is_synchronous<Exec>;
  template <class Real>
  using Lines = ComplexTransforms<Real>;
  template <class Real>
  using Rows = RowTransforms<Real>;
};

#if defined(KOKKOS_ENABLE_CUDA)
template <>
struct DeviceTransforms<Kokkos::Cuda> {
  static constexpr bool exist = true;
  template <class Real>
  using Lines = CufftComplexTransforms<Real>;
  template <class Real>
  using Rows = CufftRowTransforms<Real>;
};
#endif

}  // namespace cayspin::inline v0_2::detail
