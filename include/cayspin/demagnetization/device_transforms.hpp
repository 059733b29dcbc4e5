// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/demagnetization/fftw.hpp>
#include <cayspin/detail/execution.hpp>

#if defined(KOKKOS_ENABLE_CUDA)
#include <cayspin/demagnetization/cufft.hpp>
#endif

// Selects the FFT library of an execution space. The classes of both libraries have the same
// members.
namespace cayspin::inline v0_2::detail {

/// FFTW in a host space, so that tests can run the device code there; none elsewhere.
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
