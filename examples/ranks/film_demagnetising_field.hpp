// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/demagnetization/tensor.hpp>
#include <cayspin/mpi/domain.hpp>

#include <fftw3.h>
#include <mpi.h>

#include <algorithm>
#include <array>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <type_traits>
#include <vector>

/// A solver for HostField: the demagnetising field H = -N m, in units of Ms, of a film of one layer
/// with open boundaries, which is divided among the ranks along y. Each rank transforms its rows
/// along x, and then its share of the columns along y. Rows and columns are padded to twice the
/// extents, so that the film does not see its periodic images. Each transform is that of a single
/// row or column, so the field is bitwise identical on any number of ranks.
class FilmDemagnetisingField {
 public:
  static constexpr int degree = 2;  // H is linear in m: E = -m.H/2

  FilmDemagnetisingField(cayspin::mpi::Domain const& domain, cayspin::TensorOfCells& tensor)
      : film_(std::make_shared<Film>(domain, tensor)) {}

  template <class HostSpins>
  void operator()(HostSpins const& spins, HostSpins const& field, double /*t*/) const {
    using Real = typename HostSpins::value_type;
    auto& film = *film_;
    film.transform([&](double* row, std::size_t c, std::size_t y) {
      for (std::size_t x = 0; x < film.nx(); ++x) {
        auto const m = spins.get(static_cast<std::int64_t>(y * film.nx() + x));
        row[x] = c == 0 ? m.x : c == 1 ? m.y : m.z;
      }
    });
    film.multiply_by_kernel();
    film.transform_back();
    for (std::size_t site = 0; site < film.rows() * film.nx(); ++site)
      field.set(static_cast<std::int64_t>(site),
                {static_cast<Real>(film.result(0, site)), static_cast<Real>(film.result(1, site)),
                 static_cast<Real>(film.result(2, site))});
  }

 private:
  using Complex = std::complex<double>;

  /// Division of 0 .. extent - 1 among the ranks.
  struct Shares {
    std::vector<std::size_t> begin;
    std::size_t of(std::size_t rank) const { return begin[rank + 1] - begin[rank]; }
  };

  class Film {
   public:
    Film(cayspin::mpi::Domain const& domain, cayspin::TensorOfCells& tensor)
        : comm_(domain.comm()), rank_(static_cast<std::size_t>(domain.rank())) {
      auto const& film = domain.whole();
      auto const open = cayspin::Boundary::open;
      if (film.shape[2] != 1 || film.boundary[0] != open || film.boundary[1] != open)
        throw std::invalid_argument("FilmDemagnetisingField: one layer with open boundaries");
      nx_ = static_cast<std::size_t>(film.shape[0]);
      ny_ = static_cast<std::size_t>(film.shape[1]);
      auto const ranks = static_cast<std::size_t>(domain.division().y);
      for (std::size_t rank = 0; rank <= ranks; ++rank) {
        y_.begin.push_back(ny_ * rank / ranks);  // divided like the domain
        k_.begin.push_back((nx_ + 1) * rank / ranks);
      }
      row_.resize(2 * nx_);
      row_spectrum_.resize(nx_ + 1);
      of_rows_.resize(3 * rows() * (nx_ + 1));
      of_columns_.resize(3 * ny_ * columns());
      column_.resize(3 * columns() * 2 * ny_);
      results_.resize(3 * rows() * nx_);
      make_plans();
      find_kernel(film, tensor);
    }

    std::size_t nx() const { return nx_; }
    std::size_t rows() const { return y_.of(rank_); }
    double result(std::size_t c, std::size_t site) const {
      return results_[c * rows() * nx_ + site];
    }

    /// Calls fill(row, component, y) to fill each padded row along x; y counts this rank's rows.
    /// Afterwards column_ holds the spectra of this rank's columns.
    template <class Fill>
    void transform(Fill const& fill) {
      for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t y = 0; y < rows(); ++y) {
          std::ranges::fill(row_, 0.0);
          fill(row_.data(), c, y);
          fftw_execute_dft_r2c(forward_x_.get(), row_.data(), as_fftw(row_spectrum_.data()));
          for_each_share(k_, [&](std::size_t rank, std::size_t begin, std::size_t count) {
            std::copy_n(row_spectrum_.data() + begin, count, in_rows(c, y, rank));
          });
        }
      exchange(of_rows_, rows(), k_, of_columns_, columns(), y_);
      std::ranges::fill(column_, Complex(0));
      for_each_number([&](Complex& in_column, Complex& in_message) { in_column = in_message; });
      for_each_column(
          [&](fftw_complex* column) { fftw_execute_dft(forward_y_.get(), column, column); });
    }

    void multiply_by_kernel() {
      std::size_t const component = columns() * 2 * ny_;
      for (std::size_t i = 0; i < component; ++i) {
        cayspin::DemagnetizingTensor const& n = kernel_[i];
        Complex const x = column_[i], y = column_[component + i], z = column_[2 * component + i];
        column_[i] = n.xx * x + n.xy * y;  // N_xz and N_yz are 0 within a layer
        column_[component + i] = n.xy * x + n.yy * y;
        column_[2 * component + i] = n.zz * z;
      }
    }

    void transform_back() {
      for_each_column(
          [&](fftw_complex* column) { fftw_execute_dft(backward_y_.get(), column, column); });
      for_each_number([&](Complex& in_column, Complex& in_message) { in_message = in_column; });
      exchange(of_columns_, columns(), y_, of_rows_, rows(), k_);
      for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t y = 0; y < rows(); ++y) {
          for_each_share(k_, [&](std::size_t rank, std::size_t begin, std::size_t count) {
            std::copy_n(in_rows(c, y, rank), count, row_spectrum_.data() + begin);
          });
          fftw_execute_dft_c2r(backward_x_.get(), as_fftw(row_spectrum_.data()), row_.data());
          std::copy_n(row_.data(), nx_, &results_[(c * rows() + y) * nx_]);
        }
    }

   private:
    struct Free {
      void operator()(fftw_plan plan) const { fftw_destroy_plan(plan); }
    };
    using Plan = std::unique_ptr<std::remove_pointer_t<fftw_plan>, Free>;

    static fftw_complex* as_fftw(Complex* numbers) {
      return reinterpret_cast<fftw_complex*>(numbers);
    }
    std::size_t columns() const { return k_.of(rank_); }
    /// For component c of this rank's row y, returns where of_rows_ holds the part of the spectrum
    /// that goes to rank `rank`. That part may be empty.
    Complex* in_rows(std::size_t c, std::size_t y, std::size_t rank) {
      return of_rows_.data() + 3 * rows() * k_.begin[rank] + (c * rows() + y) * k_.of(rank);
    }

    // With FFTW_ESTIMATE and FFTW_UNALIGNED all rows on all ranks have the same plan, so that
    // results are bitwise identical.
    void make_plans() {
      constexpr unsigned flags = FFTW_ESTIMATE | FFTW_UNALIGNED;
      auto const x = static_cast<int>(2 * nx_), y = static_cast<int>(2 * ny_);
      std::vector<Complex> column(2 * ny_);
      auto* const one = as_fftw(column.data());
      auto* const spectrum = as_fftw(row_spectrum_.data());
      forward_x_.reset(fftw_plan_dft_r2c_1d(x, row_.data(), spectrum, flags));
      backward_x_.reset(fftw_plan_dft_c2r_1d(x, spectrum, row_.data(), flags));
      forward_y_.reset(fftw_plan_dft_1d(y, one, one, FFTW_FORWARD, flags));
      backward_y_.reset(fftw_plan_dft_1d(y, one, one, FFTW_BACKWARD, flags));
    }

    template <class Work>
    static void for_each_share(Shares const& shares, Work const& work) {
      for (std::size_t rank = 0; rank + 1 < shares.begin.size(); ++rank)
        work(rank, shares.begin[rank], shares.of(rank));
    }

    // Calls work(value in column_, its place in of_columns_) for all values of this rank's columns.
    // of_columns_ consists of one message for each rank's rows; within a message the order is
    // (component, row, column).
    template <class Work>
    void for_each_number(Work const& work) {
      for_each_share(y_, [&](std::size_t, std::size_t begin, std::size_t count) {
        Complex* in_message = of_columns_.data() + 3 * columns() * begin;
        for (std::size_t c = 0; c < 3; ++c)
          for (std::size_t y = begin; y < begin + count; ++y)
            for (std::size_t k = 0; k < columns(); ++k)
              work(column_[(c * columns() + k) * 2 * ny_ + y], *in_message++);
      });
    }
    template <class Work>
    void for_each_column(Work const& work) {
      for (std::size_t i = 0; i < 3 * columns(); ++i) work(as_fftw(&column_[i * 2 * ny_]));
    }

    // `from` holds `lines` rows or columns of this rank. Sends to every rank its share of these
    // lines, and receives in `to` this rank's share of the lines of every rank.
    void exchange(std::vector<Complex> const& from, std::size_t lines, Shares const& shares,
                  std::vector<Complex>& to, std::size_t lines_there, Shares const& shares_there) {
      auto const counts = [](std::size_t of_line, Shares const& of_ranks) {
        std::array<std::vector<int>, 2> counts_and_places;
        for_each_share(of_ranks, [&](std::size_t, std::size_t begin, std::size_t count) {
          counts_and_places[0].push_back(static_cast<int>(3 * of_line * count));
          counts_and_places[1].push_back(static_cast<int>(3 * of_line * begin));
        });
        return counts_and_places;
      };
      auto const sent = counts(lines, shares), received = counts(lines_there, shares_there);
      MPI_Alltoallv(from.data(), sent[0].data(), sent[1].data(), MPI_C_DOUBLE_COMPLEX, to.data(),
                    received[0].data(), received[1].data(), MPI_C_DOUBLE_COMPLEX, comm_);
    }

    /// Computes the spectrum of -N. It is real, because N_xx, N_yy and N_zz are even along x and
    /// along y, and N_xy is odd along both.
    void find_kernel(cayspin::Lattice const& film, cayspin::TensorOfCells& tensor) {
      kernel_.resize(columns() * 2 * ny_);
      for (bool const odd : {false, true}) {
        transform_tensors(film, tensor, odd);
        for (std::size_t k = 0; k < columns(); ++k) {
          for (std::size_t c = 0; c < 3; ++c) mirror(&column_[(c * columns() + k) * 2 * ny_], odd);
          for (std::size_t y = 0; y < 2 * ny_; ++y) {
            auto const at = [&](std::size_t c) {
              return column_[(c * columns() + k) * 2 * ny_ + y].real();
            };
            cayspin::DemagnetizingTensor& n = kernel_[k * 2 * ny_ + y];
            n = odd ? cayspin::DemagnetizingTensor{n.xx, n.yy, n.zz, at(0), 0, 0}
                    : cayspin::DemagnetizingTensor{at(0), at(1), at(2), 0, 0, 0};
          }
        }
      }
    }
    void transform_tensors(cayspin::Lattice const& film, cayspin::TensorOfCells& tensor, bool odd) {
      double const scale = -1.0 / static_cast<double>(4 * nx_ * ny_);
      auto const& size = film.spacing;
      transform([&](double* row, std::size_t c, std::size_t y) {
        for (std::size_t x = 0; x < nx_; ++x) {
          double const distance = static_cast<double>(y_.begin[rank_] + y) * size[1];
          cayspin::DemagnetizingTensor const n =
              tensor({static_cast<double>(x) * size[0], distance, 0}, size);
          row[x] = scale * (odd ? n.xy : c == 0 ? n.xx : c == 1 ? n.yy : n.zz);
          if (x > 0) row[2 * nx_ - x] = odd ? -row[x] : row[x];
        }
      });
    }
    // Replaces the spectrum of a column by that of the column with its even or odd mirror image in
    // place of the padding.
    void mirror(Complex* column, bool odd) {
      fftw_execute_dft(backward_y_.get(), as_fftw(column), as_fftw(column));
      for (std::size_t y = 0; y < ny_; ++y) column[y] /= static_cast<double>(2 * ny_);
      column[ny_] = 0;
      for (std::size_t y = 1; y < ny_; ++y) column[2 * ny_ - y] = odd ? -column[y] : column[y];
      fftw_execute_dft(forward_y_.get(), as_fftw(column), as_fftw(column));
    }

    MPI_Comm comm_;
    std::size_t rank_, nx_ = 0, ny_ = 0;
    Shares y_, k_;  // rows, and columns of the spectrum, of each rank
    std::vector<double> row_, results_;
    std::vector<Complex> row_spectrum_, of_rows_, of_columns_, column_;
    Plan forward_x_, backward_x_, forward_y_, backward_y_;
    std::vector<cayspin::DemagnetizingTensor> kernel_;
  };

  std::shared_ptr<Film> film_;
};
