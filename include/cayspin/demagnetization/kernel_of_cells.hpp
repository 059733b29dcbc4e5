// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/demagnetization/interactions.hpp>
#include <cayspin/demagnetization/spectrum_of_interactions.hpp>
#include <cayspin/demagnetization/spectrum_of_parts.hpp>

#include <array>
#include <complex>
#include <cstddef>
#include <cstdint>

namespace cayspin::inline v0_2::detail {

/// Distances in memory from row to row and from plane to plane.
struct PlaneStrides {
  std::ptrdiff_t row;  // not int, because its product with a number of rows may exceed one
  std::size_t plane;
};

/// The Fourier transform of the interactions between cells. One octant of wave numbers is stored;
/// the others follow by symmetry.
template <class Real>
class KernelOfCells {
  using Complex = std::complex<Real>;

 public:
  using Interactions = InteractionsOfCells;

  KernelOfCells(Interactions const& interactions, Parts const& parts)
      : period_(interactions.period()),
        octant_{interactions.octant(0), interactions.octant(1), interactions.octant(2)},
        values_("cayspin::DemagnetizingField: interactions",
                std::size_t(numbers(interactions, parts.share(octant_[0], parts.index())))) {
    transform_interactions(interactions, parts, values_);
  }

  /// Returns how many real numbers are stored for `waves` wave numbers along x.
  static std::int64_t numbers(Interactions const& interactions, std::int64_t waves) {
    return 6 * waves * interactions.lines();
  }
  /// Returns how many complex values of scratch memory `multiply` needs directly behind the planes.
  std::size_t work_numbers() const { return 0; }

  /// Multiplies the planes of one wave number along x by the interactions. `k` counts from the
  /// first wave number of this part.
  void multiply(std::int64_t k, Complex* planes, PlaneStrides const& strides) const {
    for (int z = 0; z < period_[2]; ++z) {
      bool const beyond = z >= octant_[2];
      Real const* const kernel = values_.data() + std::size_t(k) * 6 * octant_plane() +
                                 std::size_t(beyond ? period_[2] - z : z) * std::size_t(octant_[1]);
      Complex* const row = planes + z * strides.row;
      Real const sign = beyond ? -1 : 1;
      multiply_row<1>(kernel, sign, row, strides.plane, 0, octant_[1]);
      multiply_row<-1>(kernel, sign, row, strides.plane, octant_[1], period_[1]);
    }
  }

 private:
  std::size_t octant_plane() const { return std::size_t(octant_[1]) * std::size_t(octant_[2]); }

  /// Multiplies the values begin .. end - 1 of a row. `Sign`: -1 if the interactions are stored
  /// only at the mirror images of these wave numbers along y, otherwise 1. `sign_of_z`: likewise
  /// along z.
  template <int Sign>
  void multiply_row(Real const* kernel, Real sign_of_z, Complex* row, std::size_t plane, int begin,
                    int end) const {
    std::size_t const next = octant_plane();
    Real const *const xx = kernel, *const yy = xx + next, *const zz = yy + next,
                      *const xy = zz + next, *const xz = xy + next, *const yz = xz + next;
    Complex *const mx = row, *const my = row + plane, *const mz = my + plane;
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

  std::array<int, 3> period_, octant_;
  Kokkos::View<Real*, Kokkos::HostSpace> values_;  // order: wave number, component, z, y of octants
};

}  // namespace cayspin::inline v0_2::detail
