// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <fftw3.h>

#include <complex>
#include <memory>
#include <stdexcept>
#include <type_traits>

// Transforms of a demagnetising field by FFTW, in both precisions. Plans come from FFTW_ESTIMATE,
// which takes the same one each time, and with it the same bits; it looks at no number. Arrays
// begin on a cache line, as Kokkos allocates them.
namespace cayspin::inline v0_1::detail {

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

template <class Real>
class FftwPlan {
 protected:
  using Complex = std::complex<Real>;
  using Functions = Fftw<Real>;

  explicit FftwPlan(typename Functions::Plan plan) : plan_(plan) {
    if (!plan_) throw std::runtime_error("cayspin::DemagnetizingField: FFTW has no plan");
  }
  static auto complex(Complex* data) {
    return reinterpret_cast<typename Functions::Complex*>(data);
  }

  struct Destroy {
    void operator()(typename Functions::Plan plan) const { Functions::destroy(plan); }
  };
  std::unique_ptr<std::remove_pointer_t<typename Functions::Plan>, Destroy> plan_;
};

/// Complex transforms in place, `count` of them, `distance` from one to the next. Unscaled.
template <class Real>
class ComplexTransforms : FftwPlan<Real> {
  using Base = FftwPlan<Real>;
  using typename Base::Complex, typename Base::Functions;

 public:
  enum Direction { forward = FFTW_FORWARD, backward = FFTW_BACKWARD };

  ComplexTransforms(Direction direction, int length, int stride, int count, int distance)
      : Base([&] {
          alignas(64) Complex like;
          auto* const data = Base::complex(&like);
          return Functions::plan_complex(1, &length, count, data, nullptr, stride, distance, data,
                                         nullptr, stride, distance, direction, FFTW_ESTIMATE);
        }()) {}
  void operator()(Complex* data) const {
    Functions::run_complex(this->plan_.get(), Base::complex(data), Base::complex(data));
  }
};

/// Transforms of `count` rows of real numbers, row after row, to and from wave numbers 0 .. length
/// / 2 of each row, those of one wave number side by side. Unscaled.
template <class Real>
class RowTransforms {
 public:
  RowTransforms(int length, int count) : forward_(length, count), backward_(length, count) {}

  void forward(Real* rows, std::complex<Real>* waves) const { forward_(rows, waves); }
  /// Overwrites `waves`.
  void backward(std::complex<Real>* waves, Real* rows) const { backward_(waves, rows); }

 private:
  struct Forward : FftwPlan<Real> {
    using Base = FftwPlan<Real>;
    using typename Base::Complex, typename Base::Functions;
    Forward(int length, int count)
        : Base([&] {
            alignas(64) Real rows;
            alignas(64) Complex waves;
            return Functions::plan_forward(1, &length, count, &rows, nullptr, 1, length,
                                           Base::complex(&waves), nullptr, count, 1, FFTW_ESTIMATE);
          }()) {}
    void operator()(Real* rows, Complex* waves) const {
      Functions::run_forward(this->plan_.get(), rows, Base::complex(waves));
    }
  };
  struct Backward : FftwPlan<Real> {
    using Base = FftwPlan<Real>;
    using typename Base::Complex, typename Base::Functions;
    Backward(int length, int count)
        : Base([&] {
            alignas(64) Real rows;
            alignas(64) Complex waves;
            return Functions::plan_backward(1, &length, count, Base::complex(&waves), nullptr,
                                            count, 1, &rows, nullptr, 1, length, FFTW_ESTIMATE);
          }()) {}
    void operator()(Complex* waves, Real* rows) const {
      Functions::run_backward(this->plan_.get(), Base::complex(waves), rows);
    }
  };
  Forward forward_;
  Backward backward_;
};

}  // namespace cayspin::inline v0_1::detail
