// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <Kokkos_Complex.hpp>
#include <fftw3.h>

#include <complex>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <type_traits>

// FFTs of the demagnetising field by FFTW, in both precisions. Plans use FFTW_ESTIMATE, which does
// not measure times. So FFTW always chooses the same plan, and results are bitwise identical in
// every run. Arrays are aligned to cache lines, as Kokkos allocates them.
namespace cayspin::inline v0_2::detail {

template <class Real>
struct Fftw;
template <>
struct Fftw<double> {
  using Plan = fftw_plan;
  using Complex = fftw_complex;
  static constexpr auto plan_complex = fftw_plan_many_dft;
  static constexpr auto plan_forward = fftw_plan_many_dft_r2c;
  static constexpr auto plan_backward = fftw_plan_many_dft_c2r;
  static constexpr auto destroy = fftw_destroy_plan;
  static constexpr auto run_complex = fftw_execute_dft;
  static constexpr auto run_forward = fftw_execute_dft_r2c;
  static constexpr auto run_backward = fftw_execute_dft_c2r;
};
template <>
struct Fftw<float> {
  using Plan = fftwf_plan;
  using Complex = fftwf_complex;
  static constexpr auto plan_complex = fftwf_plan_many_dft;
  static constexpr auto plan_forward = fftwf_plan_many_dft_r2c;
  static constexpr auto plan_backward = fftwf_plan_many_dft_c2r;
  static constexpr auto destroy = fftwf_destroy_plan;
  static constexpr auto run_complex = fftwf_execute_dft;
  static constexpr auto run_forward = fftwf_execute_dft_r2c;
  static constexpr auto run_backward = fftwf_execute_dft_c2r;
};

/// Mutex for FFTW's planner, which is not thread-safe.
inline std::mutex fftw_planner;

template <class Real>
class FftwPlan {
  using Functions = Fftw<Real>;
  using Plan = typename Functions::Plan;

 public:
  /// `make`: a callable that returns a plan from an FFTW planner. Throws std::runtime_error if it
  /// returns no plan.
  template <class Make>
  explicit FftwPlan(Make const& make) {
    std::scoped_lock const alone(fftw_planner);
    plan_.reset(make());
    if (!plan_) throw std::runtime_error("cayspin::DemagnetizingField: FFTW has no plan");
  }
  Plan get() const { return plan_.get(); }

 private:
  struct Destroy {
    void operator()(Plan plan) const {
      std::scoped_lock const alone(fftw_planner);
      Functions::destroy(plan);
    }
  };
  std::unique_ptr<std::remove_pointer_t<Plan>, Destroy> plan_;
};

template <class Real>
auto as_fftw(std::complex<Real>* data) {
  return reinterpret_cast<typename Fftw<Real>::Complex*>(data);
}
template <class Real>
auto as_std(Kokkos::complex<Real>* data) {
  return reinterpret_cast<std::complex<Real>*>(data);
}

// Members that take an execution space match those in cufft.hpp, so that host spaces can run device
// code.

/// `count` complex transforms in place, unscaled. In memory, successive values of a transform are
/// `stride` apart, and successive transforms are `distance` apart.
template <class Real>
class ComplexTransforms {
 public:
  ComplexTransforms(int length, int stride, int count, int distance)
      : forward_(plan(FFTW_FORWARD, length, stride, count, distance)),
        backward_(plan(FFTW_BACKWARD, length, stride, count, distance)) {}

  void forward(std::complex<Real>* data) const { run(forward_, data); }
  void backward(std::complex<Real>* data) const { run(backward_, data); }
  template <class Exec>
  void forward(Exec const&, Kokkos::complex<Real>* data) const {
    forward(as_std(data));
  }
  template <class Exec>
  void backward(Exec const&, Kokkos::complex<Real>* data) const {
    backward(as_std(data));
  }

 private:
  static FftwPlan<Real> plan(int direction, int length, int stride, int count, int distance) {
    return FftwPlan<Real>([&] {
      alignas(64) std::complex<Real> like;
      return Fftw<Real>::plan_complex(1, &length, count, as_fftw(&like), nullptr, stride, distance,
                                      as_fftw(&like), nullptr, stride, distance, direction,
                                      FFTW_ESTIMATE);
    });
  }
  static void run(FftwPlan<Real> const& plan, std::complex<Real>* data) {
    Fftw<Real>::run_complex(plan.get(), as_fftw(data), as_fftw(data));
  }

  FftwPlan<Real> forward_, backward_;
};

/// Unscaled transforms between `count` rows of real numbers and their wave numbers 0 .. length / 2.
/// The numbers of a row are adjacent in memory. So are the values of all rows at one wave number.
template <class Real>
class RowTransforms {
 public:
  RowTransforms(int length, int count)
      : forward_([&] {
          alignas(64) Real rows;
          alignas(64) std::complex<Real> waves;
          return Fftw<Real>::plan_forward(1, &length, count, &rows, nullptr, 1, length,
                                          as_fftw(&waves), nullptr, count, 1, FFTW_ESTIMATE);
        }),
        backward_([&] {
          alignas(64) Real rows;
          alignas(64) std::complex<Real> waves;
          return Fftw<Real>::plan_backward(1, &length, count, as_fftw(&waves), nullptr, count, 1,
                                           &rows, nullptr, 1, length, FFTW_ESTIMATE);
        }) {}

  void forward(Real* rows, std::complex<Real>* waves) const {
    Fftw<Real>::run_forward(forward_.get(), rows, as_fftw(waves));
  }
  /// Overwrites `waves`.
  void backward(std::complex<Real>* waves, Real* rows) const {
    Fftw<Real>::run_backward(backward_.get(), as_fftw(waves), rows);
  }
  template <class Exec>
  void forward(Exec const&, Real* rows, Kokkos::complex<Real>* waves) const {
    forward(rows, as_std(waves));
  }
  template <class Exec>
  void backward(Exec const&, Kokkos::complex<Real>* waves, Real* rows) const {
    backward(as_std(waves), rows);
  }

 private:
  FftwPlan<Real> forward_, backward_;
};

}  // namespace cayspin::inline v0_2::detail
