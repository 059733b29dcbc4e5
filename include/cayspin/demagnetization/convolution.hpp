// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/demagnetization/fftw.hpp>
#include <cayspin/demagnetization/spectrum_of_parts.hpp>
#include <cayspin/demagnetization/workers.hpp>

#include <algorithm>
#include <array>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace cayspin::inline v0_2::detail {

/// The field of interactions between cells, by FFTs. Rows along x are transformed first. The values
/// at each wave number along x are then transformed along y and z in one thread's memory,
/// multiplied by the interactions and transformed back. So the spectrum needs no padding along y
/// and z, and each of its values is read and written only once between the transforms along x. Each
/// part of a lattice transforms its own rows and a share of the wave numbers; in between, the parts
/// exchange their spectra. The results are bitwise identical for any number of threads and parts.
///
/// `Kernel`: holds the transformed interactions, and multiplies the transforms of all sites of a
/// cell by them.
template <class Real, class Kernel>
class Convolution {
  using Complex = std::complex<Real>;
  using Interactions = typename Kernel::Interactions;

 public:
  /// Makes the convolution for a lattice, or a part of it, with the interactions of the whole
  /// lattice.
  Convolution(Lattice const& lattice, Interactions const& interactions)
      : parts_(lattice),
        rows_of_parts_(rows_of_parts(lattice)),
        own_(rows_of_parts_[parts_.index()]),
        n_(interactions.cells()),
        period_(interactions.period()),
        sites_(lattice.cell_sites),
        waves_(period_[0] / 2 + 1),
        rows_at_once_(std::min(n_[1], 8)),
        row_(row_of(period_[1], period_[2])),
        padded_plane_(whole(std::size_t(row_) * std::size_t(period_[2]))),
        row_transforms_(period_[0], rows_at_once_),
        along_y_(period_[1], 1, n_[2], static_cast<int>(row_)),
        along_z_(period_[2], static_cast<int>(row_), period_[1], 1),
        row_workers_("cayspin::DemagnetizingField: rows", blocks(),
                     whole(row_waves()) * 2 + std::size_t(rows_at_once_ * period_[0])),
        spectrum_("cayspin::DemagnetizingField: spectrum", parts_, waves_, lines_of_parts()),
        kernel_(interactions, parts_),
        plane_workers_("cayspin::DemagnetizingField: planes", spectrum_.own_waves(),
                       planes() * padded_plane_ + kernel_.work_numbers()) {}

  /// Returns the bytes of the spectrum and the interactions. The work memory of the threads is not
  /// included: each thread has three planes for each site of a cell, and some rows.
  static std::int64_t work_bytes(Lattice const& lattice, Interactions const& interactions) {
    Parts const parts(lattice);
    std::int64_t const ny = interactions.cells()[1];
    std::int64_t const nz = interactions.cells()[2] * lattice.cell_sites;
    std::int64_t const waves = interactions.period()[0] / 2 + 1;
    std::int64_t const spectrum =
        SpectrumOfParts<Complex>::numbers(parts, waves, 3 * own_rows(lattice).count(), 3 * ny * nz);
    std::int64_t const kernel = Kernel::numbers(interactions, parts.share(waves, parts.index()));
    return (2 * spectrum + kernel) * static_cast<std::int64_t>(sizeof(Real));
  }

  template <class HostSpins>
  void operator()(HostSpins const& spins, HostSpins const& field) const {
    auto const m = spins.array(), h = field.array();
    auto const& layout = spins.layout();
    row_workers_.run(blocks(), [&](std::int64_t block, Real* memory) {
      for_each_component(block, memory, [&](BlockOfRows const& rows, std::size_t c) {
        for (int y = 0; y < rows.count; ++y)
          std::copy_n(m.data + std::ptrdiff_t(c) * m.stride + rows.offset(layout, y), n_[0],
                      rows.numbers + (rows.slot + y) * period_[0]);
        row_transforms_.forward(rows.numbers, rows.waves);
        for (int k = 0; k < waves_; ++k)
          std::copy_n(rows.waves + k * rows_at_once_ + rows.slot, rows.count,
                      in_own_rows(k, c, rows));
      });
    });
    spectrum_.lines_to_waves();
    plane_workers_.run(spectrum_.own_waves(),
                       [&](std::int64_t k, Complex* planes) { convolve(k, planes); });
    spectrum_.waves_to_lines();
    row_workers_.run(blocks(), [&](std::int64_t block, Real* memory) {
      for_each_component(block, memory, [&](BlockOfRows const& rows, std::size_t c) {
        for (int k = 0; k < waves_; ++k) {
          Complex* const wave = rows.waves + k * rows_at_once_;
          std::fill(wave, wave + rows.slot, Complex(0));
          std::copy_n(in_own_rows(k, c, rows), rows.count, wave + rows.slot);
          std::fill(wave + rows.slot + rows.count, wave + rows_at_once_, Complex(0));
        }
        row_transforms_.backward(rows.waves, rows.numbers);
        for (int y = 0; y < rows.count; ++y) {
          Real* const row = rows.numbers + (rows.slot + y) * period_[0];
          std::copy_n(row, n_[0], h.data + std::ptrdiff_t(c) * h.stride + rows.offset(layout, y));
          std::fill(row + n_[0], row + period_[0], Real(0));
        }
      });
    });
  }

 private:
  /// Neighbouring rows of a plane, which are transformed together. `y`, `z`: indices of the first
  /// row within the part, without ghosts. `slot`: position of the first row among the rows of one
  /// transform. Each row is at the position that it would have on the whole lattice, because FFTW
  /// does not promise bitwise equal results at different positions.
  struct BlockOfRows {
    std::int64_t y, z;
    int slot, count;
    Complex* waves;
    Real* numbers;

    template <class Layout>
    std::ptrdiff_t offset(Layout const& layout, int of_row) const {
      return layout.row_offset(layout.own.y_begin + y + of_row, layout.own.z_begin + z);
    }
  };

  /// Returns the distance in memory from row to row of a plane. If there are several rows, it is an
  /// odd number of cache lines, so that the values of a column do not compete for the same cache
  /// sets.
  static int row_of(int ny, int nz) {
    constexpr int line = 64 / sizeof(Complex);
    return nz == 1 ? ny : ((ny + line - 1) / line | 1) * line;
  }
  static std::size_t whole(std::size_t count) { return Workers<Complex>::whole_lines(count); }
  std::size_t row_waves() const { return std::size_t(rows_at_once_) * std::size_t(waves_); }
  std::size_t planes() const { return 3 * std::size_t(sites_); }
  std::int64_t first_block() const { return own_.y / rows_at_once_; }
  std::int64_t blocks_of_plane() const {
    return (own_.y + own_.ny + rows_at_once_ - 1) / rows_at_once_ - first_block();
  }
  std::int64_t blocks() const { return blocks_of_plane() * own_.nz; }
  std::vector<std::int64_t> lines_of_parts() const {
    std::vector<std::int64_t> lines;
    for (RowsOfPart const& rows : rows_of_parts_) lines.push_back(3 * rows.count());
    return lines;
  }

  template <class Body>
  void for_each_component(std::int64_t block, Real* memory, Body const& body) const {
    std::int64_t const first = (first_block() + block % blocks_of_plane()) * rows_at_once_ - own_.y;
    std::int64_t const begin = std::max<std::int64_t>(first, 0),
                       end = std::min(first + rows_at_once_, own_.ny);
    BlockOfRows const rows{begin,
                           block / blocks_of_plane(),
                           static_cast<int>(begin - first),
                           static_cast<int>(end - begin),
                           reinterpret_cast<Complex*>(memory),
                           memory + 2 * whole(row_waves())};
    for (std::size_t c = 0; c < 3; ++c) body(rows, c);
  }

  Complex* in_own_rows(std::int64_t k, std::size_t c, BlockOfRows const& rows) const {
    return spectrum_.of_own_lines(k) + std::int64_t(c) * own_.count() + rows.z * own_.ny + rows.y;
  }

  /// Returns the plane that holds component c of site `site` of every cell.
  Complex* plane_of(Complex* planes, std::int64_t site, std::size_t c) const {
    return planes + (std::size_t(site) * 3 + c) * padded_plane_;
  }
  /// Calls body(row in its plane, row in the spectrum, length of the row) for all rows along y of
  /// one component, at one wave number along x.
  template <class Body>
  void for_each_row(std::int64_t k, std::size_t c, Complex* planes, Body const& body) const {
    for (std::size_t part = 0; part < rows_of_parts_.size(); ++part) {
      RowsOfPart const& rows = rows_of_parts_[part];
      Complex* in_spectrum = spectrum_.of_own_wave(k, part) + std::int64_t(c) * rows.count();
      for (std::int64_t z = rows.z; z < rows.z + rows.nz; ++z, in_spectrum += rows.ny)
        body(plane_of(planes, z % sites_, c) + z / sites_ * row_ + rows.y, in_spectrum, rows.ny);
    }
  }

  /// Convolves the planes of one wave number along x: transforms along y and z, multiplies, and
  /// transforms back.
  void convolve(std::int64_t k, Complex* planes) const {
    for (std::size_t c = 0; c < 3; ++c)
      for_each_row(k, c, planes, [](Complex* row, Complex const* from, std::int64_t count) {
        std::copy_n(from, count, row);
      });
    for (std::size_t i = 0; i < this->planes(); ++i) {
      Complex* const plane = planes + i * padded_plane_;
      for (int z = 0; z < n_[2]; ++z)
        std::fill(plane + z * row_ + n_[1], plane + z * row_ + period_[1], Complex(0));
      std::fill(plane + n_[2] * row_, plane + period_[2] * row_, Complex(0));
      if (period_[1] > 1) along_y_.forward(plane);
      if (period_[2] > 1) along_z_.forward(plane);
    }
    kernel_.multiply(k, planes, {row_, padded_plane_});
    for (std::size_t i = 0; i < this->planes(); ++i) {
      Complex* const plane = planes + i * padded_plane_;
      if (period_[2] > 1) along_z_.backward(plane);
      if (period_[1] > 1) along_y_.backward(plane);
    }
    for (std::size_t c = 0; c < 3; ++c)
      for_each_row(k, c, planes, [](Complex const* row, Complex* to, std::int64_t count) {
        std::copy_n(row, count, to);
      });
  }

  Parts parts_;
  std::vector<RowsOfPart> rows_of_parts_;
  RowsOfPart own_;
  std::array<int, 3> n_, period_;  // in cells
  std::int64_t sites_;             // per cell
  int waves_, rows_at_once_;
  std::ptrdiff_t row_;  // not int, because its product with a number of rows may exceed one
  std::size_t padded_plane_;
  RowTransforms<Real> row_transforms_;
  ComplexTransforms<Real> along_y_, along_z_;
  Workers<Real> row_workers_;
  SpectrumOfParts<Complex> spectrum_;  // order: wave number along x, component, z, y
  Kernel kernel_;
  Workers<Complex> plane_workers_;  // order: site of a cell, component, z, y
};

}  // namespace cayspin::inline v0_2::detail
