// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/minimizer/hessian.hpp>
#include <cayspin/minimizer/probe.hpp>
#include <cayspin/modes/pencil.hpp>
#include <cayspin/spin_field.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

// Spin waves with given wave vectors. If all cells of a periodic lattice are equal, these waves
// follow from small matrices.
namespace cayspin::inline v0_2::detail {

/// Division of a lattice's sites into cells along its periodic axes. Along the other axes, a cell
/// extends over the whole lattice.
class CellsOfLattice {
 public:
  using Cell = std::array<std::int64_t, 3>;

  explicit CellsOfLattice(Lattice const& lattice) : sites_(lattice.cell_sites) {
    Cell extents = lattice.shape;
    extents[2] /= sites_;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      bool const repeats = lattice.boundary[axis] == Boundary::periodic;
      cells[axis] = repeats ? extents[axis] : 1;
      folded_[axis] = repeats ? 1 : extents[axis];
    }
    extents_ = extents;
    parts = sites_ * folded_[0] * folded_[1] * folded_[2];
  }

  Cell cells{};            // count along each axis
  std::int64_t parts = 0;  // sites per cell, each of which is called a part

  std::int64_t sites() const { return sites_ * extents_[0] * extents_[1] * extents_[2]; }

  struct Place {
    Cell cell;
    std::size_t part;
  };
  /// Returns in which cell a site is, and which part of that cell it is. Sites are numbered as in
  /// copy_to_host.
  Place operator()(std::int64_t site) const {
    auto const plane = site / (extents_[0] * extents_[1]);
    Cell const at{site % extents_[0], site / extents_[0] % extents_[1], plane / sites_};
    Place place{{0, 0, 0}, static_cast<std::size_t>(plane % sites_)};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (cells[axis] > 1) place.cell[axis] = at[axis];
      auto const inside = folded_[axis] > 1 ? at[axis] : 0;
      place.part =
          place.part * static_cast<std::size_t>(folded_[axis]) + static_cast<std::size_t>(inside);
    }
    return place;
  }

  /// Returns the distance in cells from the first cell, the shorter way around.
  Cell distance(Cell cell) const {
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (2 * cell[axis] > cells[axis]) cell[axis] -= cells[axis];
    return cell;
  }

 private:
  std::int64_t sites_;
  Cell extents_{}, folded_{};
};

inline void require_periodic_along(std::vector<std::array<double, 3>> const& wave_vectors,
                                   Lattice const& lattice) {
  for (auto const& wave : wave_vectors)
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (wave[axis] != 0 && lattice.boundary[axis] != Boundary::periodic)
        throw std::invalid_argument(
            std::string("cayspin::bloch_modes: a wave vector has a component along ") +
            "xyz"[axis] + ", which is open; accepted: 0 there, or a periodic axis");
}

using Point = Eigen::Vector3d;

/// Returns two orthogonal unit vectors in the tangent plane of a spin.
inline std::array<Point, 2> tangent_axes(Point const& m) {
  Point const other = std::abs(m.x()) < 0.6 ? Point(1, 0, 0) : Point(0, 1, 0);
  Point const e = m.cross(other).normalized();
  return {e, m.cross(e)};
}

/// The linearised dynamics of a lattice of equal cells: the Hessian blocks between the first cell
/// and every cell, and the matrix `turning` of the operator G (vectors.hpp) in one cell. A
/// displacement v changes at the rate dv/dt = turning * Hessian * v.
class BlochProblem {
 public:
  struct Block {
    CellsOfLattice::Cell distance;
    Eigen::MatrixXd hessian;  // two rows and columns for each mobile part
  };
  std::vector<Block> blocks;
  Eigen::MatrixXd turning;
  std::array<bool, 3> reaches_around{};  // true if the interaction reaches half the lattice
  CellsOfLattice::Cell cells{};

  /// Returns the complex rates of waves with this wave vector (in cycles per cell): a wave grows as
  /// e^(rate * t). Only the half with the higher frequencies is returned, the lowest of these
  /// first. Rates that are real up to round-off count as frequency 0: of these, the ones that decay
  /// least are in that half, in order of increasing decay. Throws std::invalid_argument for a wave
  /// vector that is not finite, or that does not fit the lattice along an axis where the
  /// interaction reaches around.
  std::vector<std::complex<double>> rates(std::array<double, 3> const& wave) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double const around = wave[axis] * static_cast<double>(cells[axis]);
      if (!std::isfinite(around))
        throw std::invalid_argument("cayspin::bloch_modes: accepted: finite wave vectors");
      if (reaches_around[axis] && std::abs(around - std::round(around)) > 1e-9)
        throw std::invalid_argument(
            std::string("cayspin::bloch_modes: the interaction reaches around the lattice; "
                        "accepted: more cells along ") +
            "xyz"[axis] + ", or a wave vector with a whole number of waves in it");
    }
    Eigen::MatrixXcd sum = Eigen::MatrixXcd::Zero(turning.rows(), turning.cols());
    for (auto const& [distance, hessian] : blocks) {
      double turns = 0;
      for (std::size_t axis = 0; axis < 3; ++axis)
        turns += wave[axis] * static_cast<double>(distance[axis]);
      sum += std::polar(1.0, -2 * std::numbers::pi * turns) * hessian;
    }
    // Makes the sum Hermitian, as it would be without round-off of the Hessian. Only then are rates
    // without damping imaginary, and rates without precession real.
    sum = (0.5 * (sum + sum.adjoint())).eval();
    Eigen::VectorXcd const found = eigenvalues_of_product(turning, sum);
    // For a wave e^(i * (k.r - w * t)), the imaginary part of the rate is -w.
    std::vector<std::complex<double>> rates(found.begin(), found.end());
    double largest = 0;
    for (auto const& rate : rates) largest = std::max(largest, std::abs(rate));
    double const round_off = 1e3 * std::numeric_limits<double>::epsilon() * largest;
    auto const is_real = [&](auto const& rate) { return std::abs(rate.imag()) <= round_off; };
    std::ranges::sort(rates, {}, [&](auto const& rate) {
      return is_real(rate) ? std::pair(0.0, -rate.real()) : std::pair(rate.imag(), 0.0);
    });
    rates.resize(rates.size() / 2);
    std::ranges::reverse(rates);
    auto const first = std::ranges::find_if(rates, is_real);
    std::reverse(first, std::find_if_not(first, rates.end(), is_real));
    return rates;
  }
};

[[noreturn]] inline void throw_cells_differ() {
  throw std::invalid_argument(
      "cayspin::bloch_modes: the cells differ; accepted: a state and a field that are the same in "
      "all cells along periodic axes");
}

/// A site of the first cell.
struct PartOfCell {
  std::int64_t site = -1;
  Eigen::Index first = -1;  // first of its two rows, if mobile
  std::array<Point, 2> axes;
};

/// Compares the products of the Hessian with a random vector and with the same vector shifted by
/// one cell along each periodic axis. Throws std::invalid_argument if they differ by more than
/// round-off plus the effect of spins that differ by `spread` between cells.
template <class Hessian, class Spins, class Stops>
void require_equal_cells(Hessian& hessian, CellsOfLattice const& cells,
                         std::vector<PartOfCell> const& parts, Spins const& vector,
                         Spins const& product, double strongest_field, double spread,
                         Stops const& stops) {
  auto const [nx, ny, nz] = cells.cells;
  auto const number_of = [&, nx = nx, ny = ny](CellsOfLattice::Place const& place) {
    auto const cell = (place.cell[2] * ny + place.cell[1]) * nx + place.cell[0];
    return static_cast<std::size_t>(cell * cells.parts) + place.part;
  };
  auto const count = static_cast<std::size_t>(cells.sites());
  std::vector<std::size_t> site_of(count);
  std::vector<std::array<double, 2>> weights(count);
  std::minstd_rand random;
  for (std::size_t site = 0; site < count; ++site) {
    site_of[number_of(cells(static_cast<std::int64_t>(site)))] = site;
    for (double& weight : weights[site])
      weight = 2 * static_cast<double>(random()) / static_cast<double>(random.max()) - 1;
  }
  auto const shifted = [&](std::size_t site, CellsOfLattice::Cell const& shift) {
    auto place = cells(static_cast<std::int64_t>(site));
    for (std::size_t axis = 0; axis < 3; ++axis)
      place.cell[axis] = (place.cell[axis] + shift[axis]) % cells.cells[axis];
    return site_of[number_of(place)];
  };
  auto const product_with = [&](CellsOfLattice::Cell const& shift) {
    std::vector<double> numbers(3 * count);
    for (std::size_t site = 0; site < count; ++site) {
      auto const& part = parts[cells(static_cast<std::int64_t>(site)).part];
      if (part.first < 0) continue;
      auto const& [u, v] = weights[shifted(site, shift)];
      Point::Map(&numbers[3 * site]) = u * part.axes[0] + v * part.axes[1];
    }
    copy_from_host(numbers, vector);
    hessian.multiply(vector, product);
    auto const found = copy_to_host(product);
    return std::vector<double>(found.begin(), found.end());
  };

  std::vector<double> unshifted;
  double tolerance = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (cells.cells[axis] == 1) continue;
    if (unshifted.empty()) {
      if (stops()) return;
      unshifted = product_with({0, 0, 0});
      double strongest = strongest_field;
      for (double const number : unshifted) strongest = std::max(strongest, std::abs(number));
      tolerance = 100 * hessian.round_off(strongest) + 8 * spread * strongest;
    }
    if (stops()) return;
    CellsOfLattice::Cell shift{0, 0, 0};
    shift[axis] = 1;
    auto const now = product_with(shift);
    for (std::size_t site = 0; site < count; ++site) {
      auto const other = shifted(site, shift);
      Point const difference = Point::Map(&now[3 * site]) - Point::Map(&unshifted[3 * other]);
      if (difference.norm() > tolerance) throw_cells_differ();
    }
  }
}

/// Returns the problem, from products of the Hessian with the tangent axes of one cell. `stops`:
/// returns true to end early, with an incomplete problem. Throws std::invalid_argument if cells
/// differ in their spins, `precession`, `damping`, mobile sites or Hessian, or if the field is not
/// finite.
template <class Exec, class Field, class Spins, class Numbers, class Stops>
BlochProblem bloch_problem(Exec const& exec, Field const& field, double time, Spins const& spins,
                           Numbers const& precession, Numbers const& damping, Stops const& stops,
                           std::int64_t& evaluations) {
  using Real = typename Spins::value_type;
  auto const named = [&](char const* name) { return Spins(name, spins.lattice()); };
  ScalarField<Real, typename Spins::memory_space> const is_mobile("modes::is_mobile",
                                                                  spins.lattice());
  HessianArrays<Spins> const arrays{named("modes::shifted"), named("modes::at_rest"),
                                    named("modes::before")};
  auto const found = probe(exec, field, time, spins, arrays.shifted, is_mobile);
  Hessian hessian(exec, field, time, spins, is_mobile, arrays, HessianDifferences::of_four);
  CellsOfLattice const cells(spins.lattice());
  auto const m = copy_to_host(spins), moves = copy_to_host(is_mobile);
  auto const a = copy_to_host(precession), b = copy_to_host(damping);
  auto const at = [](auto const& numbers, std::int64_t site) {
    auto const* const first = &numbers[static_cast<std::size_t>(3 * site)];
    return Point(first[0], first[1], first[2]);
  };

  std::vector<PartOfCell> parts(static_cast<std::size_t>(cells.parts));
  Eigen::Index rows = 0;
  double spread = 0;  // largest difference between the spins of different cells
  double const alike = 100 * std::sqrt(std::numeric_limits<Real>::epsilon());
  for (std::int64_t site = 0; site < cells.sites(); ++site) {
    auto const place = cells(site);
    auto& part = parts[place.part];
    auto const number = static_cast<std::size_t>(site);
    if (part.site < 0) {
      part.site = site;
      part.axes = tangent_axes(at(m, site));
      if (moves[number] != 0) part.first = rows, rows += 2;
    }
    auto const first = static_cast<std::size_t>(part.site);
    double const apart = (at(m, site) - at(m, part.site)).norm();
    if (!(apart < alike) || a[number] != a[first] || b[number] != b[first] ||
        moves[number] != moves[first])
      throw_cells_differ();
    spread = std::max(spread, apart);
  }

  BlochProblem problem;
  problem.cells = cells.cells;
  problem.turning = Eigen::MatrixXd::Zero(rows, rows);
  evaluations = found.evaluations + hessian.evaluations();
  if (rows == 0) return problem;  // no spin moves
  Spins const vector = named("modes::vector"), product = named("modes::product");
  require_equal_cells(hessian, cells, parts, vector, product, found.strongest(), spread, stops);
  std::vector<Eigen::MatrixXd> blocks(
      static_cast<std::size_t>(cells.cells[0] * cells.cells[1] * cells.cells[2]),
      Eigen::MatrixXd::Zero(rows, rows));
  auto const block_of = [&](CellsOfLattice::Cell const& cell) {
    return static_cast<std::size_t>((cell[2] * cells.cells[1] + cell[1]) * cells.cells[0] +
                                    cell[0]);
  };
  for (auto const& part : parts) {
    if (part.first < 0) continue;
    auto const number = static_cast<std::size_t>(part.site);
    double const turn = a[number], decay = b[number];
    problem.turning.block<2, 2>(part.first, part.first) << -decay, -turn, turn, -decay;
    for (Eigen::Index axis = 0; axis < 2; ++axis) {
      if (stops()) return problem;
      auto const& e = part.axes[static_cast<std::size_t>(axis)];
      std::vector<double> unit(m.size());
      for (Eigen::Index c = 0; c < 3; ++c) unit[3 * number + static_cast<std::size_t>(c)] = e[c];
      copy_from_host(unit, vector);
      hessian.multiply(vector, product);
      auto const column = copy_to_host(product);
      for (std::int64_t site = 0; site < cells.sites(); ++site) {
        auto const place = cells(site);
        auto const& other = parts[place.part];
        if (other.first < 0) continue;
        for (Eigen::Index row = 0; row < 2; ++row)
          blocks[block_of(place.cell)](other.first + row, part.first + axis) =
              other.axes[static_cast<std::size_t>(row)].dot(at(column, site));
      }
    }
  }
  evaluations = found.evaluations + hessian.evaluations();

  double largest = 0;
  for (auto const& block : blocks) {
    if (!block.allFinite())
      throw std::invalid_argument(
          "cayspin::bloch_modes: the field is not finite; accepted: a field that is finite for "
          "spins near the state");
    largest = std::max(largest, block.cwiseAbs().maxCoeff());
  }
  double const least = 1e3 * std::numeric_limits<Real>::epsilon() * largest;
  auto const& [nx, ny, nz] = cells.cells;
  for (std::int64_t z = 0; z < nz; ++z)
    for (std::int64_t y = 0; y < ny; ++y)
      for (std::int64_t x = 0; x < nx; ++x) {
        auto& block = blocks[block_of({x, y, z})];
        auto const distance = cells.distance({x, y, z});
        bool const couples = block.cwiseAbs().maxCoeff() > least;
        for (std::size_t axis = 0; axis < 3 && couples; ++axis)
          if (distance[axis] != 0 && 2 * std::abs(distance[axis]) >= cells.cells[axis])
            problem.reaches_around[axis] = true;
        // Small blocks count, too: a dipolar field is the sum of many.
        problem.blocks.push_back({distance, std::move(block)});
      }
  return problem;
}

}  // namespace cayspin::inline v0_2::detail
