// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/minimizer/probe.hpp>
#include <cayspin/modes/pencil.hpp>
#include <cayspin/modes/vectors.hpp>
#include <cayspin/step.hpp>
#include <cayspin/stepper/field_algebra.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

// Solves B v = rate * G^-1 v, with the Hessian B and the operator G by which spins turn
// (vectors.hpp). The subspace of the solution is extended by preconditioned residuals (Davidson
// 1975; Morgan and Scott 1986). When the subspace is full, the search restarts with the current
// approximate modes and those of the previous step (Stathopoulos 2007).
namespace cayspin::inline v0_2::detail {

// Errors of vectors are relative to their energies. Energies below this part of
// ModeSearchOptions::scale count as this part, since those of zero modes are only round-off.
constexpr double least_energy = 1e-4;

struct ModeSearchOptions {
  std::size_t count = 8;
  double tolerance = 1e-9;  // largest error of a vector
  double round_off = 0;     // of products with the Hessian, relative to scale
  std::int64_t evaluations = 0;
  double scale = 1;  // strength of the field without exchange
  double shift = 0;  // least_shift of slowest_modes
  bool is_undamped = false;
  bool is_symmetric = false;  // G^-1 = 1: eigenvectors of the Hessian
  std::function<Next()> poll = {};
};

template <class Exec, class Spins, class AnyHessian, class Precondition>
class ModeSearch {
  using Real = typename Spins::value_type;
  using Memory = typename Spins::memory_space;
  using Problem = Pencil<double>;
  using Residuals = ResidualsOfModes<Real, VectorTable<Spins>, Kokkos::View<Real*, Memory>>;
  static constexpr std::size_t block = 4;  // modes improved at once

 public:
  enum class End { converged, stagnated, evaluation_limit, interrupted };

  ModeSearch(Exec const& exec, Spins const& spins, AnyHessian& hessian,
             InverseTurning<Real> const& inverse, Precondition const& precondition,
             ModeSearchOptions const& options)
      : exec_(exec),
        spins_(spins),
        hessian_(hessian),
        inverse_(inverse),
        precondition_(precondition),
        options_(options),
        kept_(options.count + 2),
        capacity_(columns_of_mode() * (kept_ + 4 * block)) {
    for (std::size_t i = 0; i < 2 * block; ++i) scratch_.push_back(vector("residual"));
  }

  End run() {
    if (!start()) return End::interrupted;
    double least = std::numeric_limits<double>::infinity();
    for (int since = 0;; ++since) {
      find_modes();
      if (size() > 0 && modes_.empty()) return End::stagnated;  // no eigenvalues were found
      if (2 * block + size() > capacity_) restart();
      std::size_t const converged = first_;
      std::size_t const added = add_residuals();
      if (added == 0) return End::converged;
      if (stops()) return End::interrupted;
      if (hessian_.evaluations() >= options_.evaluations) return End::evaluation_limit;
      double const error = errors_[first_];
      if (first_ > converged || error < 0.5 * least) least = error, since = 0;
      if (since > 60) return is_as_good_as_products() ? End::converged : End::stagnated;
      before_ = Problem::columns_of(modes_, kept_, rows());
      if (extend(added)) continue;
      if (is_stopped_) return End::interrupted;
      return is_as_good_as_products() ? End::converged : End::stagnated;
    }
  }

  /// Returns the modes found, the wanted ones first.
  Problem::Modes const& modes() const { return modes_; }
  std::size_t count() const { return std::min(options_.count, modes_.size()); }
  double error(std::size_t mode) const { return mode < errors_.size() ? errors_[mode] : 0; }

  /// Writes the real and the imaginary part of a mode.
  void write(std::size_t mode, Spins const& real, Spins const& imaginary) const {
    Eigen::MatrixXd columns(rows(), 2);
    columns.col(0) = modes_[mode].coefficients.real();
    columns.col(1) = modes_[mode].coefficients.imag();
    std::vector<Spins> const to{real, imaginary};
    combine_vectors<Exec, Spins>(exec_, vectors(), columns, to);
  }

 private:
  // Errors due to products with the Hessian are mostly below this bound, 10 * sqrt(epsilon).
  static constexpr double error_of_products = std::is_same_v<Real, double> ? 1.5e-7 : 3.5e-3;

  // Many modes of a large lattice take seconds between two steps of the search, so it polls also
  // within a step.
  bool stops() {
    return is_stopped_ = is_stopped_ || (options_.poll && options_.poll() == Next::stop);
  }

  // Called when no residual extends the subspace, or none has helped for long. The errors left may
  // be those of products with the Hessian, which no search can reduce: returns true if all are that
  // small.
  bool is_as_good_as_products() const {
    for (std::size_t mode = 0; mode < errors_.size(); ++mode)
      if (!(errors_[mode] < std::max(error_of_products, tolerances_[mode]))) return false;
    return true;
  }

  // Returns the error below which a unit vector of this energy has converged. The bound on
  // round-off is coarse where exchange is strong, and must not let wrong modes pass. The energy of
  // zero modes is itself round-off, so that their errors may be larger.
  double tolerance_of(double energy) const {
    double const soft = std::sqrt(std::max(1.0, 1e-2 * options_.scale / energy));
    return std::max(options_.tolerance, std::min(options_.round_off, error_of_products * soft));
  }

  std::size_t columns_of_mode() const { return options_.is_symmetric ? 1 : 2; }
  std::size_t size() const { return static_cast<std::size_t>(pencil_.size()); }
  Eigen::Index rows() const { return pencil_.size(); }
  std::span<Spins const> vectors() const { return {vectors_.data(), size()}; }
  std::span<Spins const> products() const { return {products_.data(), size()}; }
  Spins vector(char const* name) const {
    return Spins(std::string("modes::") + name, spins_.lattice());
  }
  void make_room(std::size_t count) {
    while (vectors_.size() < count) {
      vectors_.push_back(vector("vector"));
      products_.push_back(vector("product"));
    }
  }

  /// Returns false if it was stopped.
  bool start() {
    std::size_t const first = columns_of_mode() * kept_;
    make_room(first);
    auto const& shape = spins_.lattice().shape;
    for (std::size_t i = 0; i < first; ++i) {
      if (stops()) return false;
      for_each_site<Real>(exec_, "cayspin::modes::start", spins_.layout(),
                          RandomSigns<Real>{shape[0], shape[1], static_cast<std::int64_t>(i + 1), 1,
                                            scratch_[0].output(false)});
      hessian_.keep_tangent(scratch_[0]);
      precondition_(scratch_[0], vectors_[i]);
      hessian_.keep_tangent(vectors_[i]);
    }
    extend(first);
    return !is_stopped_;
  }

  void find_modes() {
    if (size() == 0) return;  // no spin moves
    modes_ = options_.is_symmetric ? pencil_.lowest_modes()
                                   : pencil_.slowest_modes(options_.is_undamped, options_.shift);
    errors_.resize(std::max(errors_.size(), count()), std::numeric_limits<double>::infinity());
    tolerances_.resize(errors_.size(), options_.tolerance);
  }

  void restart() {
    Eigen::MatrixXd const now = Problem::columns_of(modes_, kept_, rows());
    Eigen::MatrixXd const then = before_.leftCols(
        std::min<Eigen::Index>(before_.cols(), static_cast<Eigen::Index>(2 * block)));
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(rows(), now.cols() + then.cols());
    all.leftCols(now.cols()) = now;
    all.rightCols(then.cols()).topRows(then.rows()) = then;
    Eigen::MatrixXd const q = Problem::orthonormal(all);
    auto const fewer = static_cast<std::size_t>(q.cols());
    for (auto* const fields : {&vectors_, &products_})
      combine_vectors<Exec, Spins>(exec_, std::span<Spins const>(fields->data(), size()), q,
                                   std::span<Spins const>(fields->data(), fewer));
    pencil_.change_basis(q);
    for (auto& mode : modes_) mode.coefficients = (q.transpose() * mode.coefficients).eval();
  }

  /// Appends preconditioned residuals of the first unconverged modes to the vectors; returns how
  /// many vectors were appended.
  std::size_t add_residuals() {
    std::size_t added = 0;
    std::size_t const from = first_;
    first_ = improve_modes(from, added);
    // The order of the modes may have changed.
    if (added == 0 && from > 0) first_ = improve_modes(0, added);
    return added;
  }

  /// Appends preconditioned residuals of unconverged modes from `first` on. Returns the first
  /// unconverged mode, or count() if there is none.
  std::size_t improve_modes(std::size_t first, std::size_t& added) {
    std::size_t unconverged = count();
    for (std::size_t mode = first; mode < count() && added < most_added(); mode += block) {
      std::size_t const last = std::min(mode + block, count());
      find_residuals(mode, last);
      for (std::size_t i = mode; i < last; ++i)
        if (improve(i, i - mode, added)) unconverged = std::min(unconverged, i);
    }
    return unconverged;
  }
  std::size_t most_added() const { return columns_of_mode() * block; }

  /// Writes residuals of the modes first .. last - 1 to scratch_.
  void find_residuals(std::size_t first, std::size_t last) {
    auto const count = static_cast<Eigen::Index>(last - first);
    Eigen::MatrixXd columns(rows(), 2 * count);
    Kokkos::Array<Kokkos::complex<double>, Residuals::most> rates{};
    for (Eigen::Index i = 0; i < count; ++i) {
      auto const& mode = modes_[first + static_cast<std::size_t>(i)];
      columns.col(2 * i) = mode.coefficients.real();
      columns.col(2 * i + 1) = mode.coefficients.imag();
      rates[static_cast<std::size_t>(i)] =
          Kokkos::complex<double>(mode.rate.real(), mode.rate.imag());
    }
    static std::string const label = "cayspin::modes::residuals";
    std::span<Spins const> const to(scratch_.data(), 2 * (last - first));
    for_each_site<Real>(
        exec_, label, spins_.layout(),
        Residuals{table_of_vectors(vectors()), table_of_vectors(products()), table_of_vectors(to),
                  table_of_numbers<Real, Memory>(columns), inverse_, spins_.array(), rates});
    exec_.fence(label);
  }

  /// Computes the error of a mode from its residual. If the error is too large and `added` is below
  /// most_added(), appends the preconditioned residual to the vectors and returns true.
  bool improve(std::size_t mode, std::size_t place, std::size_t& added) {
    auto const& found = modes_[mode];
    std::size_t const parts = found.is_real() ? 1 : 2;
    make_room(size() + added + parts);
    double square = 0;
    for (std::size_t part = 0; part < parts; ++part) {
      auto const &r = scratch_[2 * place + part], &z = vectors_[size() + added + part];
      hessian_.keep_tangent(r);
      precondition_(r, z);
      hessian_.keep_tangent(z);
      square += inner_product(exec_, r, z);
    }
    auto const& c = found.coefficients;
    double const energy = std::abs(c.dot(pencil_.hessian.cast<std::complex<double>>() * c));
    double const size = c.squaredNorm();
    double const of_error = std::max(energy, least_energy * options_.scale * size);
    errors_[mode] = std::sqrt(std::max(square, 0.0) / of_error);
    tolerances_[mode] = tolerance_of(of_error / size);
    if (errors_[mode] < tolerances_[mode] || added >= most_added()) return false;
    added += parts;
    return true;
  }

  /// Adds the appended vectors to the subspace. Returns false, and adds nothing, if all of them are
  /// in it already or if it was stopped.
  bool extend(std::size_t added) {
    std::size_t const old = size();
    std::size_t const fresh = make_orthonormal(added);
    if (fresh == 0) return false;
    for (std::size_t i = old; i < old + fresh; ++i) {
      if (stops()) return false;
      hessian_.keep_tangent(vectors_[i]);
      hessian_.multiply(vectors_[i], products_[i]);
    }
    auto const n = static_cast<Eigen::Index>(old + fresh), k = static_cast<Eigen::Index>(fresh);
    std::span<Spins const> const all(vectors_.data(), old + fresh);
    Eigen::MatrixXd const hessian = inner_products<Exec, Spins>(
        exec_, all, std::span<Spins const>(products_.data() + old, fresh));
    pencil_.hessian.conservativeResize(n, n);
    pencil_.hessian.rightCols(k) = hessian;
    pencil_.hessian.bottomRows(k) = hessian.transpose();
    Eigen::MatrixXd const corner = hessian.bottomRows(k);
    pencil_.hessian.bottomRightCorner(k, k) = 0.5 * (corner + corner.transpose());
    pencil_.turning.conservativeResize(n, n);
    if (options_.is_symmetric)
      pencil_.turning.setIdentity();
    else
      extend_turning(all, old);
    return true;
  }

  void extend_turning(std::span<Spins const> all, std::size_t old) {
    static std::string const label = "cayspin::modes::turn_back";
    for (std::size_t i = old; i < all.size(); i += block) {
      std::size_t const count = std::min(block, all.size() - i);
      for (std::size_t k = 0; k < count; ++k)
        for_each_site<Real>(
            exec_, label, spins_.layout(),
            TurnBack<Real>{inverse_, spins_.array(), all[i + k].array(), scratch_[k].output(false),
                           scratch_[block + k].output(false)});
      Eigen::MatrixXd const skew =
          inner_products<Exec, Spins>(exec_, all, std::span<Spins const>(scratch_.data(), count));
      Eigen::MatrixXd symmetric = Eigen::MatrixXd::Zero(skew.rows(), skew.cols());
      if (!options_.is_undamped)
        symmetric = inner_products<Exec, Spins>(
            exec_, all, std::span<Spins const>(scratch_.data() + block, count));
      auto const at = static_cast<Eigen::Index>(i), k = static_cast<Eigen::Index>(count);
      pencil_.turning.middleCols(at, k) = skew + symmetric;
      pencil_.turning.middleRows(at, k) = (symmetric - skew).transpose();
      Eigen::MatrixXd const s = skew.middleRows(at, k), t = symmetric.middleRows(at, k);
      pencil_.turning.block(at, at, k, k) = 0.5 * (s - s.transpose() + t + t.transpose());
    }
  }

  /// Makes the appended vectors orthonormal among themselves and to the subspace, and returns how
  /// many are left. Makes two passes, since the first leaves round-off of the components that it
  /// removes, and a third one if the first leaves less than 1e6 * epsilon of the square of a
  /// vector.
  std::size_t make_orthonormal(std::size_t added) {
    constexpr double epsilon = std::numeric_limits<Real>::epsilon();
    int rounds = 2;
    for (int round = 0; round < rounds && added > 0; ++round) {
      std::span<Spins const> const fresh(vectors_.data() + size(), added);
      Eigen::MatrixXd const across = inner_products<Exec, Spins>(exec_, vectors(), fresh);
      Eigen::MatrixXd products = inner_products<Exec, Spins>(exec_, fresh, fresh);
      Eigen::VectorXd const before = products.diagonal();
      products -= across.transpose() * across;
      for (Eigen::Index i = 0; i < products.rows(); ++i) {
        double const left = before[i] > 0 ? products(i, i) / before[i] : 0;
        if (round == 0 && left < 1e6 * epsilon) rounds = 3;
        if (!(left > 1e3 * epsilon)) products.row(i).setZero(), products.col(i).setZero();
      }
      Eigen::MatrixXd const change = Problem::orthonormalizing(products, 1e4 * epsilon);
      Eigen::MatrixXd coefficients(across.rows() + products.rows(), change.cols());
      coefficients << -across * change, change;
      added = static_cast<std::size_t>(change.cols());
      combine_vectors<Exec, Spins>(exec_,
                                   std::span<Spins const>(vectors_.data(), size() + fresh.size()),
                                   coefficients, fresh.first(added));
    }
    return added;
  }

  Exec const& exec_;
  Spins const& spins_;
  AnyHessian& hessian_;
  InverseTurning<Real> inverse_;
  Precondition const& precondition_;
  ModeSearchOptions options_;
  std::size_t kept_, capacity_;
  std::vector<Spins> vectors_, products_, scratch_;
  Problem pencil_;
  Problem::Modes modes_;
  std::vector<double> errors_, tolerances_;
  Eigen::MatrixXd before_;
  std::size_t first_ = 0;
  bool is_stopped_ = false;
};

}  // namespace cayspin::inline v0_2::detail
