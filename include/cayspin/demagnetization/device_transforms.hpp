// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/demagnetization/fftw.hpp>
#include <cayspin/detail/execution.hpp>

#include <complex>

#if defined(KOKKOS_ENABLE_CUDA)
#include <cayspin/demagnetization/cufft.hpp>
#endif

// Who transforms the numbers of an execution space: makers of transforms with the same members.
namespace cayspin::inline v0_1::detail {

/// None for a space that is not named below.
template <class Exec>
struct DeviceTransforms {
  static constexpr bool exist = is_synchronous<Exec>;

  /// FFTW in a host space, which lets tests run what is written for devices.
  template <class Real>
  class Lines {
   public:
    Lines(int length, int stride, int count, int distance)
        : forward_(Plan::forward, length, stride, count, distance),
          backward_(Plan::backward, length, stride, count, distance) {}
    void forward(Exec const&, Kokkos::complex<Real>* data) const { forward_(as_std(data)); }
    void backward(Exec const&, Kokkos::complex<Real>* data) const { backward_(as_std(data)); }

   private:
    using Plan = ComplexTransforms<Real>;
    Plan forward_, backward_;
  };

  template <class Real>
  class Rows {
   public:
    Rows(int length, int count) : plan_(length, count) {}
    void forward(Exec const&, Real* rows, Kokkos::complex<Real>* waves) const {
      plan_.forward(rows, as_std(waves));
    }
    void backward(Exec const&, Kokkos::complex<Real>* waves, Real* rows) const {
      plan_.backward(as_std(waves), rows);
    }

   private:
    RowTransforms<Real> plan_;
  };

 private:
  template <class Real>
  static std::complex<Real>* as_std(Kokkos::complex<Real>* data) {
    return reinterpret_cast<std::complex<Real>*>(data);
  }
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
