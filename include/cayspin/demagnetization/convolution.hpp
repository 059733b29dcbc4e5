// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/demagnetization/fftw.hpp>
#include <cayspin/demagnetization/interactions.hpp>
#include <cayspin/demagnetization/spectrum_of_interactions.hpp>
#include <cayspin/demagnetization/workers.hpp>

#include <algorithm>
#include <array>
#include <complex>
#include <cstddef>
#include <cstdint>

namespace cayspin::inline v0_1::detail {

/// The field of interactions between cells. Rows along x are transformed by themselves, and each of
/// their wave numbers then along y and z in memory of one thread's own, where it meets the
/// interactions and comes back: no zero beyond the lattice is kept, and each number of the spectrum
/// is read and written once. The same bits for any number of threads.
template <class Real>
class Convolution {
  using Complex = std::complex<Real>;

 public:
  explicit Convolution(InteractionsOfCells const& interactions)
      : n_(interactions.cells()),
        period_(interactions.period()),
        octant_{interactions.octant(0), interactions.octant(1), interactions.octant(2)},
        rows_at_once_(std::min(n_[1], 8)),
        row_(row_of(period_[1], period_[2])),
        plane_(std::size_t(n_[1]) * std::size_t(n_[2])),
        padded_plane_(whole(std::size_t(row_) * std::size_t(period_[2]))),
        row_transforms_(period_[0], rows_at_once_),
        y_forward_(Transforms::forward, period_[1], 1, n_[2], row_),
        y_backward_(Transforms::backward, period_[1], 1, n_[2], row_),
        z_forward_(Transforms::forward, period_[2], row_, period_[1], 1),
        z_backward_(Transforms::backward, period_[2], row_, period_[1], 1),
        row_workers_("cayspin::DemagnetizingField: rows", blocks(),
                     whole(row_waves()) * 2 + std::size_t(rows_at_once_ * period_[0])),
        plane_workers_("cayspin::DemagnetizingField: planes", octant_[0], 3 * padded_plane_),
        spectrum_("cayspin::DemagnetizingField: spectrum", 3 * plane_ * std::size_t(octant_[0])),
        kernel_("cayspin::DemagnetizingField: interactions",
                6 * octant_plane() * std::size_t(octant_[0])) {
    find_kernel(interactions);
  }

  /// Less what each thread has of its own: three planes and some rows.
  static std::int64_t work_bytes(InteractionsOfCells const& interactions) {
    std::int64_t const ny = interactions.cells()[1], nz = interactions.cells()[2];
    std::int64_t const waves = interactions.octant(0);
    std::int64_t const octant = waves * interactions.octant(1) * interactions.octant(2);
    return (6 * waves * ny * nz + 6 * octant) * static_cast<std::int64_t>(sizeof(Real));
  }

  template <class HostSpins>
  void operator()(HostSpins const& spins, HostSpins const& field) const {
    auto const m = spins.array(), h = field.array();
    auto const& layout = spins.layout();
    row_workers_.run(blocks(), [&](std::int64_t block, Real* memory) {
      for_each_component(block, memory, [&](BlockOfRows const& rows, std::size_t c) {
        for (int y = 0; y < rows.count; ++y)
          std::copy_n(m.data + std::ptrdiff_t(c) * m.stride + rows.offset(layout, y), n_[0],
                      rows.numbers + y * period_[0]);
        row_transforms_.forward(rows.numbers, rows.waves);
        for (int k = 0; k < octant_[0]; ++k)
          std::copy_n(rows.waves + k * rows_at_once_, rows.count, in_spectrum(k, c, rows.first));
      });
    });
    plane_workers_.run(octant_[0],
                       [&](std::int64_t k, Complex* planes) { convolve(int(k), planes); });
    row_workers_.run(blocks(), [&](std::int64_t block, Real* memory) {
      for_each_component(block, memory, [&](BlockOfRows const& rows, std::size_t c) {
        for (int k = 0; k < octant_[0]; ++k) {
          Complex* const wave = rows.waves + k * rows_at_once_;
          std::copy_n(in_spectrum(k, c, rows.first), rows.count, wave);
          std::fill(wave + rows.count, wave + rows_at_once_, Complex(0));
        }
        row_transforms_.backward(rows.waves, rows.numbers);
        for (int y = 0; y < rows.count; ++y) {
          Real* const row = rows.numbers + y * period_[0];
          std::copy_n(row, n_[0], h.data + std::ptrdiff_t(c) * h.stride + rows.offset(layout, y));
          std::fill(row + n_[0], row + period_[0], Real(0));
        }
      });
    });
  }

 private:
  using Transforms = ComplexTransforms<Real>;

  /// Neighbouring rows of a plane, `first` the number of the first row among all.
  struct BlockOfRows {
    std::size_t first;
    int count;
    Complex* waves;
    Real* numbers;

    template <class Layout>
    std::ptrdiff_t offset(Layout const& layout, int y) const {
      return (std::ptrdiff_t(first) + y) * layout.pitch;
    }
  };

  /// From row to row of a plane: an odd number of cache lines, for columns that do not compete for
  /// the same cache sets.
  static int row_of(int ny, int nz) {
    constexpr int line = 64 / sizeof(Complex);
    return nz == 1 ? ny : ((ny + line - 1) / line | 1) * line;
  }
  static std::size_t whole(std::size_t count) { return Workers<Complex>::whole_lines(count); }
  std::size_t row_waves() const { return std::size_t(rows_at_once_) * std::size_t(octant_[0]); }
  std::size_t octant_plane() const { return std::size_t(octant_[1]) * std::size_t(octant_[2]); }
  std::int64_t blocks_of_plane() const { return (n_[1] + rows_at_once_ - 1) / rows_at_once_; }
  std::int64_t blocks() const { return blocks_of_plane() * n_[2]; }

  template <class Body>
  void for_each_component(std::int64_t block, Real* memory, Body const& body) const {
    auto const z = block / blocks_of_plane(), y = block % blocks_of_plane() * rows_at_once_;
    BlockOfRows const rows{std::size_t(z * n_[1] + y),
                           static_cast<int>(std::min<std::int64_t>(rows_at_once_, n_[1] - y)),
                           reinterpret_cast<Complex*>(memory), memory + 2 * whole(row_waves())};
    for (std::size_t c = 0; c < 3; ++c) body(rows, c);
  }

  Complex* in_spectrum(int k, std::size_t c, std::size_t row) const {
    return spectrum_.data() + (std::size_t(k) * 3 + c) * plane_ + row;
  }

  /// One wave number along x.
  void convolve(int k, Complex* planes) const {
    for (std::size_t c = 0; c < 3; ++c) {
      Complex *const plane = planes + c * padded_plane_, *const from = in_spectrum(k, c, 0);
      for (int z = 0; z < n_[2]; ++z) {
        Complex* const row = plane + z * row_;
        std::copy_n(from + z * n_[1], n_[1], row);
        std::fill(row + n_[1], row + period_[1], Complex(0));
      }
      std::fill(plane + n_[2] * row_, plane + period_[2] * row_, Complex(0));
      if (period_[1] > 1) y_forward_(plane);
      if (period_[2] > 1) z_forward_(plane);
    }
    multiply(k, planes);
    for (std::size_t c = 0; c < 3; ++c) {
      Complex *const plane = planes + c * padded_plane_, *const to = in_spectrum(k, c, 0);
      if (period_[2] > 1) z_backward_(plane);
      if (period_[1] > 1) y_backward_(plane);
      for (int z = 0; z < n_[2]; ++z) std::copy_n(plane + z * row_, n_[1], to + z * n_[1]);
    }
  }

  void multiply(int k, Complex* planes) const {
    for (int z = 0; z < period_[2]; ++z) {
      bool const beyond = z >= octant_[2];
      Real const* const kernel = kernel_.data() + std::size_t(k) * 6 * octant_plane() +
                                 std::size_t(beyond ? period_[2] - z : z) * std::size_t(octant_[1]);
      Complex* const row = planes + z * row_;
      Real const sign = beyond ? -1 : 1;
      multiply_row<1>(kernel, sign, row, 0, octant_[1]);
      multiply_row<-1>(kernel, sign, row, octant_[1], period_[1]);
    }
  }
  /// `Sign`: of y; `sign_of_z`: -1 where the distance's mirror image stands for it.
  template <int Sign>
  void multiply_row(Real const* kernel, Real sign_of_z, Complex* row, int begin, int end) const {
    std::size_t const next = octant_plane();
    Real const *const xx = kernel, *const yy = xx + next, *const zz = yy + next,
                      *const xy = zz + next, *const xz = xy + next, *const yz = xz + next;
    Complex *const mx = row, *const my = row + padded_plane_, *const mz = my + padded_plane_;
    Real const sign_yz = Sign * sign_of_z;
    for (int y = begin; y < end; ++y) {
      int const i = Sign > 0 ? y : period_[1] - y;
      Real const n_xy = Sign * xy[i], n_xz = sign_of_z * xz[i], n_yz = sign_yz * yz[i];
      Complex const x = mx[y], of_y = my[y], z = mz[y];
      mx[y] = xx[i] * x + n_xy * of_y + n_xz * z;
      my[y] = n_xy * x + yy[i] * of_y + n_yz * z;
      mz[y] = n_xz * x + n_yz * of_y + zz[i] * z;
    }
  }

  void find_kernel(InteractionsOfCells const& interactions) {
    auto const nx = std::size_t(octant_[0]);
    transform_interactions(interactions, [&](std::size_t c, std::size_t i, double value) {
      kernel_((i % nx * 6 + c) * octant_plane() + i / nx) = static_cast<Real>(value);
    });
  }

  std::array<int, 3> n_, period_, octant_;
  int rows_at_once_, row_;
  std::size_t plane_, padded_plane_;
  RowTransforms<Real> row_transforms_;
  Transforms y_forward_, y_backward_, z_forward_, z_backward_;
  Workers<Real> row_workers_;
  Workers<Complex> plane_workers_;
  Kokkos::View<Complex*, Kokkos::HostSpace> spectrum_;  // wave number along x, component, z, y
  Kokkos::View<Real*, Kokkos::HostSpace> kernel_;       // wave number, component, z, y of octants
};

}  // namespace cayspin::inline v0_1::detail
