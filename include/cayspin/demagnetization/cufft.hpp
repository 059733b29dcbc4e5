// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <Kokkos_Core.hpp>
#include <cufft.h>

#include <memory>
#include <stdexcept>
#include <string>

// FFTs of the demagnetising field by cuFFT, with the data layout of fftw.hpp. They work in device
// memory, on the CUDA stream of an execution space instance.
namespace cayspin::inline v0_2::detail {

template <class Real>
struct Cufft;
template <>
struct Cufft<double> {
  using Complex = cufftDoubleComplex;
  static constexpr auto complex = CUFFT_Z2Z;
  static constexpr auto forward = CUFFT_D2Z;
  static constexpr auto backward = CUFFT_Z2D;
  static constexpr auto run_complex = cufftExecZ2Z;
  static constexpr auto run_forward = cufftExecD2Z;
  static constexpr auto run_backward = cufftExecZ2D;
};
template <>
struct Cufft<float> {
  using Complex = cufftComplex;
  static constexpr auto complex = CUFFT_C2C;
  static constexpr auto forward = CUFFT_R2C;
  static constexpr auto backward = CUFFT_C2R;
  static constexpr auto run_complex = cufftExecC2C;
  static constexpr auto run_forward = cufftExecR2C;
  static constexpr auto run_backward = cufftExecC2R;
};

inline void require_cufft(cufftResult result) {
  if (result != CUFFT_SUCCESS)
    throw std::runtime_error("cayspin::DemagnetizingField: cuFFT failed with result " +
                             std::to_string(static_cast<int>(result)));
}

class CufftPlan {
 public:
  /// Distances in memory: `stride` between successive values of a transform, `distance` between
  /// successive transforms.
  struct Places {
    int stride, distance;
  };

  CufftPlan(cufftType type, int length, int count, Places in, Places out) {
    // cuFFT uses the strides only if `embed` is given. The value of `embed` is ignored in one
    // dimension.
    int embed = length;
    cufftHandle plan{};
    require_cufft(cufftPlanMany(&plan, 1, &length, &embed, in.stride, in.distance, &embed,
                                out.stride, out.distance, type, count));
    plan_.reset(new cufftHandle(plan));
  }

  cufftHandle on(Kokkos::Cuda const& exec) const {
    require_cufft(cufftSetStream(*plan_, exec.cuda_stream()));
    return *plan_;
  }

 private:
  struct Destroy {
    void operator()(cufftHandle const* plan) const {
      cufftDestroy(*plan);
      delete plan;
    }
  };
  std::unique_ptr<cufftHandle const, Destroy> plan_;
};

/// `count` complex transforms in place, unscaled. In memory, successive values of a transform are
/// `stride` apart, and successive transforms are `distance` apart.
template <class Real>
class CufftComplexTransforms {
  using Functions = Cufft<Real>;

 public:
  CufftComplexTransforms(int length, int stride, int count, int distance)
      : plan_(Functions::complex, length, count, {stride, distance}, {stride, distance}) {}

  void forward(Kokkos::Cuda const& exec, Kokkos::complex<Real>* data) const {
    run(exec, data, CUFFT_FORWARD);
  }
  void backward(Kokkos::Cuda const& exec, Kokkos::complex<Real>* data) const {
    run(exec, data, CUFFT_INVERSE);
  }

 private:
  void run(Kokkos::Cuda const& exec, Kokkos::complex<Real>* data, int direction) const {
    auto* const numbers = reinterpret_cast<typename Functions::Complex*>(data);
    require_cufft(Functions::run_complex(plan_.on(exec), numbers, numbers, direction));
  }

  CufftPlan plan_;
};

/// Unscaled transforms between `count` rows of real numbers and their wave numbers 0 .. length / 2.
/// The numbers of a row are adjacent in memory. So are the values of all rows at one wave number.
template <class Real>
class CufftRowTransforms {
  using Functions = Cufft<Real>;

 public:
  CufftRowTransforms(int length, int count)
      : forward_(Functions::forward, length, count, {1, length}, {count, 1}),
        backward_(Functions::backward, length, count, {count, 1}, {1, length}) {}

  void forward(Kokkos::Cuda const& exec, Real* rows, Kokkos::complex<Real>* waves) const {
    require_cufft(Functions::run_forward(forward_.on(exec), rows, as_cufft(waves)));
  }
  /// Overwrites `waves`.
  void backward(Kokkos::Cuda const& exec, Kokkos::complex<Real>* waves, Real* rows) const {
    require_cufft(Functions::run_backward(backward_.on(exec), as_cufft(waves), rows));
  }

 private:
  static auto as_cufft(Kokkos::complex<Real>* waves) {
    return reinterpret_cast<typename Functions::Complex*>(waves);
  }

  CufftPlan forward_, backward_;
};

}  // namespace cayspin::inline v0_2::detail
