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
/// Eigenvalues below this fraction of a bound on the largest one may be those of zero modes.
constexpr double zero = 1e-5;
/// Relative errors of torques and of curvatures. Demagnetising tensors are accurate to 1e-10.
constexpr double error_of_torques = 1e-9, error_of_curvatures = 1e-8;

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
  /// `unstable`: approximate lowest curvature of a saddle; 0 for minima. Calls poll() before each
  /// factorisation. Throws NumbersFailed if
  /// another curvature is negative, and for zero modes of unknown volume.
  State(StateHessian const& state, char const* name, double unstable, io::Lattice const& lattice,
        std::function<void()> const& poll)
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
      poll();
      Eigen::PartialPivLU<Matrix> const inverse(hessian_ -
                                                1.001 * unstable * Matrix::Identity(n, n));
      mode_ = near_vectors(hessian_, inverse, 1).first;
      rest += (largest - mode_.dot(hessian_ * mode_)) * mode_ * mode_.transpose();
    }
    double const bound = zero * largest;
    poll();
    Eigen::LLT<Matrix> factors(rest + bound * Matrix::Identity(n, n));
    if (factors.info() != Eigen::Success)
      throw NumbersFailed(fmt::format("rates: {} has {} negative curvature", name,
                                      unstable < 0 ? "a second" : "a"));
    auto const [vectors, values] = near_vectors(rest, factors, std::min(n, most_zeros));
    auto const count = (values.array() <= bound).count();
    zeros_ = vectors.leftCols(count);
    Vector const soft = values.head(count);
    rest += zeros_ * (largest - soft.array()).matrix().asDiagonal() * zeros_.transpose();
    poll();
    factors.compute(rest);
    // The modes that are left out have the eigenvalue `largest` in `rest`.
    double const in_place = static_cast<double>(count) + (unstable < 0 ? 1 : 0);
    log_determinant_ =
        2 * factors.matrixLLT().diagonal().array().log().sum() - in_place * std::log(largest);
    if (count > 0) find_volume(lattice, soft, largest);
  }

  Matrix const& hessian() const { return hessian_; }
  /// Returns the unstable mode of a saddle.
  Vector const& mode() const { return mode_; }
  std::int64_t zero_modes() const { return zeros_.cols(); }
  /// Returns the sum of the logarithms of the positive eigenvalues, without those of zero modes.
  double log_determinant() const { return log_determinant_; }

  /// Returns the contribution of the zero modes: the volume of all states to which they lead.
  double zero_volume() const { return zero_volume_; }

 private:
  /// Finds the volume of the modes `zeros_`, with the curvatures `soft`. Modes that no symmetry
  /// explains are no zero modes if they are stiffer than errors of the Hessian.
  void find_volume(io::Lattice const& lattice, Vector const& soft, double largest) {
    auto const count = zero_modes();
    auto const along_zeros = [&](Vector const& v) {
      return (zeros_.transpose() * v).norm() > 0.9 * v.norm() && v.norm() > 1e-6;
    };
    std::vector<Vector> translations;
    bool drifts = false;  // along an open axis, where the volume is unknown
    for (std::size_t axis = 0; axis < 3; ++axis) {
      auto const [centred, whole] = translation(lattice, axis);
      if (!along_zeros(centred)) continue;
      if (lattice.boundary[axis] == io::BoundaryKind::periodic)
        translations.push_back(whole.norm() / centred.norm() * centred);
      else
        drifts = true;
    }
    if (std::ssize(translations) == count) {
      zero_volume_ = volume_of(translations);
      return;
    }
    auto const rotated = rotations();
    // If a state is not quite at rest, its Hessian has an error of about its torque.
    double const error = error_of_curvatures * largest + 10 * state_.torque;
    bool const may_be_stiff = translations.empty() && !drifts;
    if (std::ssize(rotated) != count && !(may_be_stiff && keep_only(rotated, soft, error)))
      throw NumbersFailed(
          fmt::format("rates: {} has {}{}; accepted: none, translations along periodic axes, or "
                      "rotations of all spins",
                      name_, count == most_zeros && hessian_.rows() > most_zeros ? "at least " : "",
                      counted(count, "zero mode")));
    constexpr std::array volumes{1.0, 2 * pi, 4 * pi, 8 * pi * pi};  // of all angles
    zero_volume_ = volumes[rotated.size()] * (rotated.empty() ? 1 : volume_of(rotated));
  }

  /// Restricts the zero modes to `rotated`, and adds the other modes to the determinant. Returns
  /// false, and changes nothing, if the curvature of one of the others is not above `error`.
  bool keep_only(std::vector<Vector> const& rotated, Vector const& soft, double error) {
    auto const kept = static_cast<Eigen::Index>(rotated.size()), others = zero_modes() - kept;
    Matrix parts(zero_modes(), kept);
    for (Eigen::Index i = 0; i < kept; ++i)
      parts.col(i) = zeros_.transpose() * rotated[static_cast<std::size_t>(i)];
    Matrix const axes = kept == 0 ? Matrix(Matrix::Identity(zero_modes(), zero_modes()))
                                  : Matrix(Eigen::HouseholderQR<Matrix>(parts).householderQ());
    Matrix const beside = axes.rightCols(others);
    Eigen::SelfAdjointEigenSolver<Matrix> const found(beside.transpose() * soft.asDiagonal() *
                                                      beside);
    if (!(found.eigenvalues().minCoeff() > error)) return false;
    log_determinant_ += found.eigenvalues().array().log().sum();
    zeros_ = (zeros_ * axes.leftCols(kept)).eval();
    return true;
  }

  /// Returns the `count` eigenvectors of `matrix` to which inverse iteration converges, and their
  /// eigenvalues, in ascending order. `inverse`: factors of the matrix, or of the shifted matrix.
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
  /// zero for a single cell. Spins at open ends have a neighbour on one side only.
  std::pair<Vector, Vector> translation(io::Lattice const& lattice, std::size_t axis) const {
    Vector const none = Vector::Zero(static_cast<Eigen::Index>(state_.size()));
    auto shape = lattice.shape;
    auto const cell_sites = std::ssize(lattice.basis);
    shape[2] /= cell_sites;
    if (shape[axis] < 2) return {none, none};
    bool const repeats = lattice.boundary[axis] == io::BoundaryKind::periodic;
    auto const moved = [&](std::size_t site, std::int64_t by) {
      auto const n = static_cast<std::int64_t>(site);
      std::array<std::int64_t, 3> place{n % shape[0], n / shape[0] % shape[1],
                                        n / (shape[0] * shape[1])};
      auto const of_cell = place[2] % cell_sites;
      place[2] /= cell_sites;
      auto const next = place[axis] + by;
      place[axis] = repeats ? (next + shape[axis]) % shape[axis]
                            : std::clamp<std::int64_t>(next, 0, shape[axis] - 1);
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
    Eigen::Matrix3d const axes = axes_of_symmetry(turned);
    std::vector<Vector> found;
    for (Eigen::Index i = 0; i < 3; ++i) {
      Vector const v = turned * axes.col(i);
      bool const moves = v.norm() > 1e-3 * turned.norm();
      if (moves && (beside * axes.col(i)).norm() < 1e-2 * v.norm()) found.push_back(v);
    }
    return found;
  }

  /// Returns orthogonal axes about which the energy is symmetric, as columns: none, one, or three
  /// if the energy is isotropic. The other columns are zero. `turned`: rotations about x, y and z.
  /// The axes are found from state_.torques, because the zero modes do not determine them if all
  /// spins are collinear: adding a rotation about the common direction gives the same modes.
  Eigen::Matrix3d axes_of_symmetry(Matrix const& turned) const {
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    for (auto const& torque : state_.torques) {
      Eigen::Map<Eigen::Vector3d const> const t(torque.data());
      squares += t * t.transpose();
    }
    double const none = error_of_torques * state_.torque_scale;
    if (squares.trace() <= none * none)
      return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(turned.transpose() * turned)
          .eigenvectors();
    Eigen::Vector3d const axis =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(squares).eigenvectors().col(0);
    double along = 0;  // the eigenvalue is less accurate: its round-off is that of the largest
    for (auto const& torque : state_.torques)
      along = std::hypot(along, axis.dot(Eigen::Map<Eigen::Vector3d const>(torque.data())));
    Eigen::Matrix3d found = Eigen::Matrix3d::Zero();
    if (along <= none) found.col(0) = axis;
    return found;
  }

  StateHessian const& state_;
  char const* name_;
  Matrix hessian_;
  Matrix zeros_;
  Vector mode_;
  double log_determinant_ = 0, zero_volume_ = 1;
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

void StateHessian::set_torque(std::vector<double> const& field) {
  torque = 0;
  for (auto const site : sites)
    torque = std::max(torque, at(spins, site).cross(at(field, site)).norm());
}

std::vector<double> StateHessian::far_state(unsigned sample) const {
  std::mt19937 generator(sample);
  auto const number = [&] {
    return 2 * static_cast<double>(generator()) / static_cast<double>(std::mt19937::max()) - 1;
  };
  // With NullaryExpr(number), GCC 12 draws the numbers of a site only once at -O3.
  Eigen::Vector4d const coefficients{number(), number(), number(), number()};
  Eigen::Quaterniond const turn(coefficients.normalized());
  auto state = spins;
  for (auto const site : sites) {
    Eigen::Map<Eigen::Vector3d> m(&state[3 * site]);
    Eigen::Vector3d const change{number(), number(), number()};
    m = (turn * m + 0.5 * change).normalized();
  }
  return state;
}

void StateHessian::add_torque(std::vector<double> const& state, std::vector<double> const& field) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (auto const site : sites) {
    Eigen::Vector3d const of_spin = at(state, site).cross(at(field, site));
    sum += of_spin;
    torque_scale += of_spin.norm();
  }
  torques.push_back({sum.x(), sum.y(), sum.z()});
}

io::RatesOfPath rates_between(io::Scene const& scene, StateHessian const& start,
                              StateHessian const& saddle, StateHessian const& end,
                              double saddle_curvature, std::function<void()> const& poll) {
  if (!(saddle_curvature < 0))
    throw NumbersFailed("rates: the energy does not fall from the saddle: it is a plateau");
  State const of_saddle(saddle, "the saddle", saddle_curvature, scene.lattice, poll);
  // Round-off may make a square of 0 negative.
  double const velocity =
      std::sqrt(std::max(square_of_velocity(of_saddle, mobilities(scene, saddle)), 0.0)) / (2 * pi);
  auto const saddle_modes = of_saddle.zero_modes();
  double const saddle_volume = of_saddle.zero_volume();

  io::RatesOfPath rates;
  rates.zero_modes[1] = saddle_modes;
  rates.volumes[1] = saddle_volume;
  bool const gilbert = scene.material && scene.material->gilbert && !scene.system.dampings.there();
  double const alpha = gilbert ? scene.material->alpha : 0;
  double const per_time = (1 + alpha * alpha) / scene.units.time;
  double const thermal = scene.units.si ? boltzmann / scene.units.energy : 1;
  double const growth = growth_rate(scene, saddle, of_saddle.hessian(), of_saddle.mode(), poll);
  double const curvature = of_saddle.mode().dot(of_saddle.hessian() * of_saddle.mode());
  double const langer = growth / (2 * pi * std::sqrt(-curvature) * scene.units.time);
  // Computes the prefactor without the flux.
  auto const factor = [&](StateHessian const& minimum, char const* name, std::size_t place) {
    State const state(minimum, name, 0, scene.lattice, poll);
    auto const modes = rates.zero_modes[place] = state.zero_modes();
    double const volume = rates.volumes[place] = state.zero_volume();
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
