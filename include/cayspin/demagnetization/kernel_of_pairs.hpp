// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/demagnetization/dipole_interactions.hpp>
#include <cayspin/demagnetization/fftw.hpp>
#include <cayspin/demagnetization/kernel_of_cells.hpp>
#include <cayspin/demagnetization/spectrum_of_parts.hpp>
#include <cayspin/demagnetization/workers.hpp>
#include <cayspin/detail/execution.hpp>

#include <algorithm>
#include <array>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace cayspin::inline v0_2::detail {

/// The Fourier transform of the interactions between the sites of a crystal's cells. For a site and
/// the same site of other cells, the transform is real; for different sites a and b, it is complex.
/// The transform from a to b is the conjugate of that from b to a, so only one of the two is
/// stored.
template <class Real>
class KernelOfPairs {
  using Complex = std::complex<Real>;

 public:
  using Interactions = InteractionsOfDipoles;

  KernelOfPairs(Interactions const& interactions, Parts const& parts)
      : period_(interactions.period()),
        sites_(interactions.sites()),
        values_(
            "cayspin::DipolarField: interactions",
            std::size_t(numbers(interactions, parts.share(period_[0] / 2 + 1, parts.index())))) {
    for (std::size_t a = 0; a < sites_; ++a)
      for (std::size_t b = a; b < sites_; ++b) transform(interactions, parts, a, b);
  }

  /// Returns how many real numbers are stored for `waves` wave numbers along x.
  static std::int64_t numbers(Interactions const& interactions, std::int64_t waves) {
    auto const sites = static_cast<std::int64_t>(interactions.sites());
    return waves * interactions.period()[2] * 6 * sites * sites * interactions.period()[1];
  }
  /// Returns how many complex values of scratch memory `multiply` needs directly behind the planes.
  std::size_t work_numbers() const { return 3 * sites_ * row_length(); }

  /// Multiplies the planes of one wave number along x by the interactions. `k` counts from the
  /// first wave number of this part.
  void multiply(std::int64_t k, Complex* planes, PlaneStrides const& strides) const {
    Complex* const sum = planes + 3 * sites_ * strides.plane;
    for (int z = 0; z < period_[2]; ++z) {
      Complex* const row = planes + z * strides.row;
      std::fill_n(sum, work_numbers(), Complex(0));
      Vectors const to{sum, row_length()}, from{row, strides.plane};
      for (std::size_t a = 0; a < sites_; ++a) {
        multiply_itself(entries(k, z, a, a), from.of_site(a), to.of_site(a));
        for (std::size_t b = a + 1; b < sites_; ++b) {
          Real const* const pair = entries(k, z, a, b);
          multiply_other<1>(pair, from.of_site(b), to.of_site(a));
          multiply_other<-1>(pair, from.of_site(a), to.of_site(b));
        }
      }
      for (std::size_t i = 0; i < 3 * sites_; ++i)
        std::copy_n(sum + i * row_length(), row_length(), row + i * strides.plane);
    }
  }

 private:
  /// Vectors stored as one row for each component. `next`: distance in memory from one row to the
  /// next.
  struct Vectors {
    Complex* data;
    std::size_t next;

    Vectors of_site(std::size_t site) const { return {data + 3 * site * next, next}; }
    Complex* operator[](std::size_t c) const { return data + c * next; }
  };

  std::size_t row_length() const { return std::size_t(period_[1]); }
  /// Returns where the rows xx, yy, zz, xy, xz, yz of a pair of sites a <= b begin. For two
  /// different sites, each of these rows has real parts and is followed by a row of imaginary
  /// parts.
  std::size_t place(std::int64_t k, int z, std::size_t a, std::size_t b) const {
    std::size_t const sites_before = a * (2 * sites_ - a - 1) / 2 * 12 + 6 * a;
    std::size_t const in_pairs = sites_before + (b == a ? 0 : 6 + 12 * (b - a - 1));
    return ((std::size_t(k) * std::size_t(period_[2]) + std::size_t(z)) * 6 * sites_ * sites_ +
            in_pairs) *
           row_length();
  }
  Real const* entries(std::int64_t k, int z, std::size_t a, std::size_t b) const {
    return values_.data() + place(k, z, a, b);
  }

  void multiply_itself(Real const* n, Vectors const& m, Vectors const& h) const {
    std::size_t const next = row_length();
    Real const *const xx = n, *const yy = xx + next, *const zz = yy + next, *const xy = zz + next,
                      *const xz = xy + next, *const yz = xz + next;
    for (std::size_t y = 0; y < next; ++y) {
      Complex const mx = m[0][y], my = m[1][y], mz = m[2][y];
      h[0][y] += xx[y] * mx + xy[y] * my + xz[y] * mz;
      h[1][y] += xy[y] * mx + yy[y] * my + yz[y] * mz;
      h[2][y] += xz[y] * mx + yz[y] * my + zz[y] * mz;
    }
  }
  /// `Sign`: -1 for the conjugate of the stored interactions.
  template <int Sign>
  void multiply_other(Real const* n, Vectors const& m, Vectors const& h) const {
    constexpr std::size_t in_matrix[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};
    std::size_t const next = row_length();
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) {
        Real const *const real = n + 2 * in_matrix[i][j] * next, *const imaginary = real + next;
        Complex const* const from = m[j];
        Complex* const to = h[i];
        for (std::size_t y = 0; y < next; ++y) {
          Real const re = real[y], im = Sign * imaginary[y];
          to[y] += Complex(re * from[y].real() - im * from[y].imag(),
                           re * from[y].imag() + im * from[y].real());
        }
      }
  }

  struct Find {
    Interactions const& of;
    std::int64_t first_line;
    std::size_t a, b;
    DipoleTensor* found;

    void operator()(std::int64_t i) const {
      auto const& [nx, ny, nz] = of.period();
      std::int64_t const line = first_line + i / nx;
      found[i] = of.between({int(i % nx), int(line % ny), int(line / ny)}, a, b);
    }
  };

  /// Computes, transforms and stores the interactions of a pair of sites. Threads divide the lines
  /// along x among themselves and, after the transform along x, the wave numbers.
  void transform(Interactions const& interactions, Parts const& parts, std::size_t a,
                 std::size_t b) {
    auto const [nx, ny, nz] = period_;
    std::int64_t const lines = std::int64_t{ny} * nz;
    std::vector<std::int64_t> of_parts;
    for (std::size_t part = 0; part < parts.count(); ++part)
      of_parts.push_back(parts.share(lines, part));
    std::int64_t const own = of_parts[parts.index()];
    std::vector<DipoleTensor> tensors(std::size_t(own) * std::size_t(nx));
    Kokkos::parallel_for(
        "cayspin::DipolarField: tensors",
        Kokkos::RangePolicy<Kokkos::DefaultHostExecutionSpace, TaskIndex,
                            Kokkos::Schedule<Kokkos::Dynamic>>(0, std::int64_t(tensors.size()),
                                                               Kokkos::ChunkSize(64)),
        Find{interactions, parts.begin_of_share(lines, parts.index()), a, b, tensors.data()});
    Kokkos::DefaultHostExecutionSpace().fence("cayspin::DipolarField: tensors");

    using Numbers = std::complex<double>;
    SpectrumOfParts<Numbers> const spectrum("cayspin::DipolarField: spectrum of interactions",
                                            parts, nx / 2 + 1, of_parts);
    RowTransforms<double> const along_x(nx, 1);
    ComplexTransforms<double> const along_y(ny, 1, nz, ny), along_z(nz, ny, ny, 1);
    auto const waves = std::size_t(nx / 2 + 1);
    Workers<Numbers> const rows("cayspin::DipolarField: lines", own,
                                Workers<Numbers>::whole_lines(waves) + std::size_t(nx / 2 + 1));
    Workers<Numbers> const planes("cayspin::DipolarField: planes", spectrum.own_waves(),
                                  std::size_t(lines));
    double const scale = 1.0 / (double(nx) * ny * nz);
    std::size_t c = 0;
    for (auto const component : {&DipoleTensor::xx, &DipoleTensor::yy, &DipoleTensor::zz,
                                 &DipoleTensor::xy, &DipoleTensor::xz, &DipoleTensor::yz}) {
      rows.run(own, [&](std::int64_t line, Numbers* memory) {
        auto* const row = reinterpret_cast<double*>(memory + Workers<Numbers>::whole_lines(waves));
        for (int x = 0; x < nx; ++x)
          row[x] = tensors[std::size_t(line) * std::size_t(nx) + std::size_t(x)].*component;
        along_x.forward(row, memory);
        for (std::size_t k = 0; k < waves; ++k)
          spectrum.of_own_lines(std::int64_t(k))[line] = memory[k];
      });
      spectrum.lines_to_waves();
      planes.run(spectrum.own_waves(), [&](std::int64_t k, Numbers* plane) {
        Numbers* to = plane;
        for (std::size_t part = 0; part < parts.count(); ++part)
          to = std::copy_n(spectrum.of_own_wave(k, part), of_parts[part], to);
        if (ny > 1) along_y.forward(plane);
        if (nz > 1) along_z.forward(plane);
        for (int z = 0; z < nz; ++z) {
          Numbers const* const row = plane + std::int64_t{z} * ny;
          Real* const kept = values_.data() + place(k, z, a, b);
          for (std::size_t y = 0; y < row_length(); ++y)
            if (a == b) {
              kept[c * row_length() + y] = static_cast<Real>(scale * row[y].real());
            } else {
              kept[2 * c * row_length() + y] = static_cast<Real>(scale * row[y].real());
              kept[(2 * c + 1) * row_length() + y] = static_cast<Real>(scale * row[y].imag());
            }
        }
      });
      ++c;
    }
  }

  std::array<int, 3> period_;
  std::size_t sites_;
  Kokkos::View<Real*, Kokkos::HostSpace> values_;  // order: wave number, z, pair, component, y
};

}  // namespace cayspin::inline v0_2::detail
