// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "tensor.hpp"

#include <cayspin/lattice.hpp>
#include <cayspin/vec3.hpp>

#include <fftw3.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <stdexcept>
#include <type_traits>
#include <vector>

/// The field H = -N m of all cells on all cells, for HostField: a convolution by FFTs over
/// twice the extents, so that the film does not see its periodic images. In units of Ms, for open
/// boundaries and cells that are as large as the lattice's spacings.
/// Throws std::invalid_argument for periodic boundaries. Copies share their work memory.
class DemagnetisingField {
 public:
  static constexpr int degree = 2;  // H is linear in m: E = -m.H/2

  DemagnetisingField(cayspin::Lattice const& lattice, TensorOfCells& tensor)
      : convolution_(std::make_shared<Convolution>(lattice, tensor)) {}

  template <class HostSpins>
  void operator()(HostSpins const& spins, HostSpins const& field, double /*t*/) const {
    using Real = typename HostSpins::value_type;
    auto& work = *convolution_;
    work.fill_with_zero();
    work.for_each_site([&](std::int64_t site, int x, int y, int z) {
      std::size_t const at = work.place(x, y, z);
      auto const m = spins.get(site);
      work.real(0)[at] = m.x;
      work.real(1)[at] = m.y;
      work.real(2)[at] = m.z;
    });
    work.convolve();
    work.for_each_site([&](std::int64_t site, int x, int y, int z) {
      std::size_t const at = work.place(x, y, z);
      field.set(site, {static_cast<Real>(work.real(0)[at]), static_cast<Real>(work.real(1)[at]),
                       static_cast<Real>(work.real(2)[at])});
    });
  }

 private:
  class Convolution {
   public:
    Convolution(cayspin::Lattice const& lattice, TensorOfCells& tensor) {
      lattice.validate();
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (lattice.boundary[axis] != cayspin::Boundary::open)
          throw std::invalid_argument("DemagnetisingField: the boundaries must be open");
        sites_[axis] = static_cast<int>(lattice.shape[axis]);
        extent_[axis] = sites_[axis] > 1 ? 2 * sites_[axis] : 1;
      }
      row_ = 2 * (static_cast<std::size_t>(extent_[0]) / 2 + 1);
      stride_ = (row_ * static_cast<std::size_t>(extent_[1] * extent_[2]) + 7) / 8 * 8;
      data_.reset(fftw_alloc_real(3 * stride_));
      if (!data_) throw std::bad_alloc();

      // FFTW_ESTIMATE takes the same plan each time, and with it the same bits. The plans serve all
      // three components, which are aligned alike.
      forward_.reset(fftw_plan_dft_r2c_3d(extent_[2], extent_[1], extent_[0], real(0), spectrum(0),
                                          FFTW_ESTIMATE));
      backward_.reset(fftw_plan_dft_c2r_3d(extent_[2], extent_[1], extent_[0], spectrum(0), real(0),
                                           FFTW_ESTIMATE));
      if (!forward_ || !backward_) throw std::runtime_error("DemagnetisingField: no plan of FFTW");
      find_kernel(lattice.spacing, tensor);
    }

    /// Component 0, 1 or 2: m, and H after convolve().
    double* real(std::size_t component) { return data_.get() + component * stride_; }

    void fill_with_zero() { std::fill_n(data_.get(), 3 * stride_, 0.0); }

    /// function(site, x, y, z)
    template <class Function>
    void for_each_site(Function const& function) const {
      std::int64_t site = 0;
      for (int z = 0; z < sites_[2]; ++z)
        for (int y = 0; y < sites_[1]; ++y)
          for (int x = 0; x < sites_[0]; ++x) function(site++, x, y, z);
    }
    /// Where the number of a site lies in real(component).
    std::size_t place(int x, int y, int z) const {
      return static_cast<std::size_t>(z * extent_[1] + y) * row_ + static_cast<std::size_t>(x);
    }

    void convolve() {
      transform();
      for (std::size_t i = 0; i < stride_ / 2; ++i) multiply(kernel_[i], i);
      for (std::size_t c = 0; c < 3; ++c)
        fftw_execute_dft_c2r(backward_.get(), spectrum(c), real(c));
    }

   private:
    struct Free {
      void operator()(double* data) const { fftw_free(data); }
      void operator()(fftw_plan plan) const { fftw_destroy_plan(plan); }
    };
    using Plan = std::unique_ptr<std::remove_pointer_t<fftw_plan>, Free>;

    fftw_complex* spectrum(std::size_t component) {
      return reinterpret_cast<fftw_complex*>(real(component));
    }
    void transform() {
      for (std::size_t c = 0; c < 3; ++c)
        fftw_execute_dft_r2c(forward_.get(), real(c), spectrum(c));
    }

    /// The spectrum of -N, which is real because N is even under inversion.
    void find_kernel(std::array<double, 3> const& size, TensorOfCells& tensor) {
      std::vector<Tensor> tensors;
      for_each_site([&](std::int64_t, int x, int y, int z) {
        tensors.push_back(tensor({x * size[0], y * size[1], z * size[2]}, size));
      });
      kernel_.resize(stride_ / 2);
      find_components(tensors, {&Tensor::xx, &Tensor::yy, &Tensor::zz});
      find_components(tensors, {&Tensor::xy, &Tensor::xz, &Tensor::yz});
    }
    void find_components(std::vector<Tensor> const& tensors,
                         std::array<double Tensor::*, 3> const& components) {
      double const scale = -1.0 / (static_cast<double>(extent_[0]) * extent_[1] * extent_[2]);
      fill_with_zero();
      for_each_site([&](std::int64_t site, int x, int y, int z) {
        for (int mirror = 0; mirror < 8; ++mirror) {
          int const sx = mirror & 1 ? -1 : 1, sy = mirror & 2 ? -1 : 1, sz = mirror & 4 ? -1 : 1;
          Tensor n = tensors[static_cast<std::size_t>(site)];
          n.xy *= sx * sy;
          n.xz *= sx * sz;
          n.yz *= sy * sz;
          for (std::size_t c = 0; c < 3; ++c)
            real(c)[place(wrapped(sx * x, 0), wrapped(sy * y, 1), wrapped(sz * z, 2))] =
                scale * (n.*components[c]);
        }
      });
      transform();
      for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t i = 0; i < stride_ / 2; ++i) kernel_[i].*components[c] = spectrum(c)[i][0];
    }
    int wrapped(int offset, std::size_t axis) const {
      return offset < 0 ? offset + extent_[axis] : offset;
    }

    void multiply(Tensor const& n, std::size_t i) {
      for (std::size_t part = 0; part < 2; ++part) {
        double& x = spectrum(0)[i][part];
        double& y = spectrum(1)[i][part];
        double& z = spectrum(2)[i][part];
        double const hx = n.xx * x + n.xy * y + n.xz * z;
        double const hy = n.xy * x + n.yy * y + n.yz * z;
        double const hz = n.xz * x + n.yz * y + n.zz * z;
        x = hx;
        y = hy;
        z = hz;
      }
    }

    std::array<int, 3> sites_{}, extent_{};
    std::size_t row_ = 0, stride_ = 0;  // in doubles
    std::unique_ptr<double, Free> data_;
    Plan forward_, backward_;
    std::vector<Tensor> kernel_;
  };

  std::shared_ptr<Convolution> convolution_;
};
