// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "transition_rates.hpp"

#include "failure.hpp"
#include "growth_rate.hpp"
#include "text.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>

// Harmonic transition state theory for spins: Bessarab, Uzdin and Jonsson, Phys. Rev. B 85, 184409
// (2012). The rate is the flux by precession across the dividing plane at the saddle, divided by
// the partition function of the minimum; damping does not enter. A mode without stiffness
// contributes its whole volume, a translation only that of one cell. In Langer's theory, Ann. Phys.
// 54, 258 (1969), the flux is that of the mode that grows at the saddle, with damping.
namespace cayspin::simulation {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;
using Numbers = std::vector<double>;

constexpr double pi = std::numbers::pi;
constexpr double boltzmann = 1.380649e-23;  // J/K
constexpr Eigen::Index most_zeros = 8;      // zero modes that are counted
/// Eigenvalues below this fraction of a bound on the largest one count as zero.
constexpr double zero = 1e-5;

Eigen::Map<Eigen::Vector3d const> at(Numbers const& spins, std::size_t site) {
  return Eigen::Map<Eigen::Vector3d const>(&spins[3 * site]);
}

Eigen::Vector3d way_between(Eigen::Vector3d const& m, Eigen::Vector3d const& p) {
  Eigen::Vector3d const axis = m.cross(p);
  double const sine = axis.norm();
  if (sine == 0) return Eigen::Vector3d::Zero();
  return std::atan2(sine, m.dot(p)) / sine * axis.cross(m);
}

class State {
 public:
  /// `unstable`: approximate lowest curvature of a saddle; 0 for minima. Throws NumbersFailed if
  /// another curvature is negative.
  State(StateHessian const& state, char const* name, double unstable)
      : state_(state),
        name_(name),
        hessian_(Eigen::Map<
                 Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> const>(
            state.numbers.data(), static_cast<Eigen::Index>(state.size()),
            static_cast<Eigen::Index>(state.size()))) {
    hessian_ = (0.5 * (hessian_ + hessian_.transpose())).eval();
    auto const n = hessian_.rows();
    // An upper bound on the eigenvalues.
    double const largest = hessian_.cwiseAbs().rowwise().sum().maxCoeff();
    Matrix rest = hessian_;
    if (unstable < 0) {
      Eigen::PartialPivLU<Matrix> const inverse(hessian_ -
                                                1.001 * unstable * Matrix::Identity(n, n));
      mode_ = near_vectors(hessian_, inverse, 1).first;
      rest += (largest - mode_.dot(hessian_ * mode_)) * mode_ * mode_.transpose();
    }
    double const bound = zero * largest;
    Eigen::LLT<Matrix> factors(rest + bound * Matrix::Identity(n, n));
    if (factors.info() != Eigen::Success)
      throw NumbersFailed(fmt::format("rates: {} has {} negative curvature", name,
                                      unstable < 0 ? "a second" : "a"));
    auto const [vectors, values] = near_vectors(rest, factors, std::min(n, most_zeros));
    auto const count = (values.array() <= bound).count();
    zeros_ = vectors.leftCols(count);
    rest += largest * zeros_ * zeros_.transpose();
    factors.compute(rest);
    // The modes that are left out have the eigenvalue `largest` in `rest`.
    double const in_place = static_cast<double>(count) + (unstable < 0 ? 1 : 0);
    log_determinant_ =
        2 * factors.matrixLLT().diagonal().array().log().sum() - in_place * std::log(largest);
  }

  Matrix const& hessian() const { return hessian_; }
  /// Returns the unstable mode of a saddle.
  Vector const& mode() const { return mode_; }
  std::int64_t zero_modes() const { return zeros_.cols(); }
  /// Returns the sum of the logarithms of the positive eigenvalues.
  double log_determinant() const { return log_determinant_; }

  /// Returns the contribution of the zero modes: the volume of all states to which they lead.
  double zero_volume(io::Lattice const& lattice) const {
    auto const count = zero_modes();
    if (count == 0) return 1;
    auto const along_zeros = [&](Vector const& v) {
      return (zeros_.transpose() * v).norm() > 0.9 * v.norm() && v.norm() > 1e-6;
    };
    std::vector<Vector> translations;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      auto const [centred, whole] = translation(lattice, axis);
      if (along_zeros(centred)) translations.push_back(whole.norm() / centred.norm() * centred);
    }
    if (std::ssize(translations) == count) return volume_of(translations);
    auto const rotated = rotations();
    if (std::ssize(rotated) != count)
      throw NumbersFailed(
          fmt::format("rates: {} has {}{}; accepted: none, translations along periodic axes, or "
                      "rotations of all spins",
                      name_, count == most_zeros && hessian_.rows() > most_zeros ? "at least " : "",
                      counted(count, "zero mode")));
    // Volumes of all rotations about one, two and three axes.
    constexpr std::array volumes{2 * pi, 4 * pi, 8 * pi * pi};
    return volumes[rotated.size() - 1] * volume_of(rotated);
  }

 private:
  /// Returns the `count` eigenvectors of `matrix` to which inverse iteration converges, and their
  /// eigenvalues in ascending order. `inverse`: a factorisation of `matrix` plus a multiple of the
  /// identity.
  static std::pair<Matrix, Vector> near_vectors(Matrix const& matrix, auto const& inverse,
                                                Eigen::Index count) {
    auto const n = matrix.rows();
    Matrix vectors = Matrix::NullaryExpr(n, count, [](Eigen::Index row, Eigen::Index column) {
      return std::sin(1.0 + 1.7 * static_cast<double>(row + 1) * static_cast<double>(column + 1));
    });
    for (int step = 0; step < 12; ++step) {
      vectors = inverse.solve(vectors).eval();
      vectors = (Eigen::HouseholderQR<Matrix>(vectors).householderQ() * Matrix::Identity(n, count))
                    .eval();
    }
    Eigen::SelfAdjointEigenSolver<Matrix> const ritz(vectors.transpose() * matrix * vectors);
    return {vectors * ritz.eigenvectors(), ritz.eigenvalues()};
  }

  static double volume_of(std::vector<Vector> const& vectors) {
    auto const count = static_cast<Eigen::Index>(vectors.size());
    Matrix const products = Matrix::NullaryExpr(count, count, [&](auto i, auto j) {
      return vectors[static_cast<std::size_t>(i)].dot(vectors[static_cast<std::size_t>(j)]);
    });
    return std::sqrt(products.determinant());
  }

  Vector coordinates(auto const& vector_of_site) const {
    Vector found(static_cast<Eigen::Index>(state_.size()));
    for (std::size_t i = 0; i < state_.size(); ++i)
      found[static_cast<Eigen::Index>(i)] =
          vector_of_site(state_.sites[i / 2])
              .dot(Eigen::Map<Eigen::Vector3d const>(state_.vector(i)));
    return found;
  }

  /// Returns the translation by a cell along an axis, from centred and from one-sided differences;
  /// zero unless the axis is periodic.
  std::pair<Vector, Vector> translation(io::Lattice const& lattice, std::size_t axis) const {
    Vector const none = Vector::Zero(static_cast<Eigen::Index>(state_.size()));
    auto shape = lattice.shape;
    auto const cell_sites = std::ssize(lattice.basis);
    shape[2] /= cell_sites;
    if (lattice.boundary[axis] != io::BoundaryKind::periodic || shape[axis] < 2)
      return {none, none};
    auto const moved = [&](std::size_t site, std::int64_t by) {
      auto const n = static_cast<std::int64_t>(site);
      std::array<std::int64_t, 3> place{n % shape[0], n / shape[0] % shape[1],
                                        n / (shape[0] * shape[1])};
      auto const of_cell = place[2] % cell_sites;
      place[2] /= cell_sites;
      place[axis] = (place[axis] + by + shape[axis]) % shape[axis];
      return static_cast<std::size_t>(
          ((place[2] * cell_sites + of_cell) * shape[1] + place[1]) * shape[0] + place[0]);
    };
    auto const way = [&](std::size_t site, std::int64_t by) {
      return way_between(at(state_.spins, site), at(state_.spins, moved(site, by)));
    };
    return {coordinates([&](std::size_t site) -> Eigen::Vector3d {
              return 0.5 * (way(site, 1) - way(site, -1));
            }),
            coordinates([&](std::size_t site) { return way(site, 1); })};
  }

  /// Returns rotations of all spins by a radian, about those of three orthogonal axes for which
  /// such a rotation is a zero mode.
  std::vector<Vector> rotations() const {
    Matrix turned(static_cast<Eigen::Index>(state_.size()), 3);
    for (Eigen::Index axis = 0; axis < 3; ++axis)
      turned.col(axis) = coordinates([&](std::size_t site) -> Eigen::Vector3d {
        return Eigen::Vector3d::Unit(axis).cross(at(state_.spins, site));
      });
    Matrix const beside = turned - zeros_ * (zeros_.transpose() * turned);
    // Axes in order of the part of the rotation that is not a zero mode, smallest first. If all
    // rotations are zero modes, `beside` is only round-off, and axes that move no spin come last.
    // For a single zero mode: only the axis of symmetry, if there is one.
    Eigen::Matrix3d const axes =
        zero_modes() == 1 ? axes_of_symmetry()
                          : Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(
                                beside.transpose() * beside - 1e-6 * turned.transpose() * turned)
                                .eigenvectors();
    std::vector<Vector> found;
    for (Eigen::Index i = 0; i < 3; ++i) {
      Vector const v = turned * axes.col(i);
      bool const moves = v.norm() > 1e-3 * turned.norm();
      if (moves && (beside * axes.col(i)).norm() < 1e-2 * v.norm()) found.push_back(v);
    }
    return found;
  }

  /// Returns the axis about which the energy is symmetric, as the first column, and zeros
  /// elsewhere; only zeros if there is none. If all spins are collinear, the zero mode does not
  /// determine the axis: adding a rotation about their common direction gives the same mode.
  Eigen::Matrix3d axes_of_symmetry() const {
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    for (auto const& torque : state_.torques) {
      Eigen::Map<Eigen::Vector3d const> const t(torque.data());
      squares += t * t.transpose();
    }
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> const axes(squares);
    Eigen::Matrix3d found = Eigen::Matrix3d::Zero();
    if (axes.eigenvalues()[0] < 1e-4 * axes.eigenvalues()[1])
      found.col(0) = axes.eigenvectors().col(0);
    return found;
  }

  StateHessian const& state_;
  char const* name_;
  Matrix hessian_;
  Matrix zeros_;
  Vector mode_;
  double log_determinant_ = 0;
};

/// Returns the gyromagnetic ratio divided by the moment, in reduced units, for each site of
/// state.sites; 0 without precession.
Numbers mobilities(io::Scene const& scene, StateHessian const& state) {
  if (!scene.system.precession) return Numbers(state.sites.size(), 0.0);
  auto const& lattice = scene.lattice;
  io::SiteBox const box{{0, 0, 0}, lattice.shape};
  auto const moments = io::moments_of_sites(scene, box),
             ratios = io::gyromagnetic_of_sites(scene, box);
  auto const cell_sites = lattice.basis.size();
  auto const plane = static_cast<std::size_t>(lattice.shape[0] * lattice.shape[1]);
  Numbers found;
  for (auto const site : state.sites) {
    auto const of_cell = site / plane % cell_sites;
    double const ratio =
        ratios.empty() ? io::of_cell_site(lattice.gyromagnetic, of_cell) : ratios[site];
    found.push_back(moments.empty() ? io::over_moment(lattice, of_cell, ratio)
                                    : ratio / moments[site]);
  }
  return found;
}

/// Returns the mean square of the velocity of precession along the unstable mode, divided by kT.
double square_of_velocity(State const& saddle, Numbers const& mobilities) {
  Vector const& mode = saddle.mode();
  Vector turned(mode.size());
  for (Eigen::Index i = 0; i < mode.size(); i += 2) {
    double const mobility = mobilities[static_cast<std::size_t>(i / 2)];
    turned[i] = mobility * mode[i + 1];
    turned[i + 1] = -mobility * mode[i];
  }
  return turned.dot(saddle.hessian() * turned);
}

}  // namespace

std::vector<double> StateHessian::far_state(unsigned sample) const {
  std::mt19937 generator(sample);
  auto const number = [&] {
    return 2 * static_cast<double>(generator()) / static_cast<double>(std::mt19937::max()) - 1;
  };
  Eigen::Quaterniond const turn(Eigen::Vector4d::NullaryExpr(number).normalized());
  auto state = spins;
  for (auto const site : sites) {
    Eigen::Map<Eigen::Vector3d> m(&state[3 * site]);
    m = (turn * m + 0.5 * Eigen::Vector3d::NullaryExpr(number)).normalized();
  }
  return state;
}

void StateHessian::add_torque(std::vector<double> const& state, std::vector<double> const& field) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (auto const site : sites) sum += at(state, site).cross(at(field, site));
  torques.push_back({sum.x(), sum.y(), sum.z()});
}

io::RatesOfPath rates_between(io::Scene const& scene, StateHessian const& start,
                              StateHessian const& saddle, StateHessian const& end,
                              double saddle_curvature) {
  if (!(saddle_curvature < 0))
    throw NumbersFailed("rates: the energy does not fall from the saddle: it is a plateau");
  State const of_saddle(saddle, "the saddle", saddle_curvature);
  // Round-off may make a square of 0 negative.
  double const velocity =
      std::sqrt(std::max(square_of_velocity(of_saddle, mobilities(scene, saddle)), 0.0)) / (2 * pi);
  auto const saddle_modes = of_saddle.zero_modes();
  double const saddle_volume = of_saddle.zero_volume(scene.lattice);

  io::RatesOfPath rates;
  rates.zero_modes[1] = saddle_modes;
  rates.volumes[1] = saddle_volume;
  bool const gilbert = scene.material && scene.material->gilbert && !scene.system.dampings.there();
  double const alpha = gilbert ? scene.material->alpha : 0;
  double const per_time = (1 + alpha * alpha) / scene.units.time;
  double const thermal = scene.units.si ? boltzmann / scene.units.energy : 1;
  double const growth = growth_rate(scene, saddle, of_saddle.hessian(), of_saddle.mode());
  double const curvature = of_saddle.mode().dot(of_saddle.hessian() * of_saddle.mode());
  double const langer = growth / (2 * pi * std::sqrt(-curvature) * scene.units.time);
  // Computes the prefactor without the flux.
  auto const factor = [&](StateHessian const& minimum, char const* name, std::size_t place) {
    State const state(minimum, name, 0);
    auto const modes = rates.zero_modes[place] = state.zero_modes();
    double const volume = rates.volumes[place] = state.zero_volume(scene.lattice);
    double const power = 0.5 * static_cast<double>(modes - saddle_modes);
    return saddle_volume / volume * std::pow(2 * pi * thermal, power) *
           std::exp(0.5 * (state.log_determinant() - of_saddle.log_determinant()));
  };
  double const forward = factor(start, "the start", 0), backward = factor(end, "the end", 2);
  rates.prefactor_forward = per_time * velocity * forward;
  rates.prefactor_backward = per_time * velocity * backward;
  rates.langer_forward = langer * forward;
  rates.langer_backward = langer * backward;
  return rates;
}

}  // namespace cayspin::simulation
