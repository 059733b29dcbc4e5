// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/demagnetization/fftw.hpp>
#include <cayspin/detail/execution.hpp>

#if defined(KOKKOS_ENABLE_CUDA)
#include <cayspin/demagnetization/cufft.hpp>
#endif

// Who transforms the numbers of an execution space: transforms with the same members.
namespace cayspin::inline v0_1::detail {

/// FFTW in a host space, which lets tests run what is written for devices; none elsewhere.
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

}  // namespace cayspin::inline v0_1::detail
