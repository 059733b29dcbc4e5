// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/cayspin.hpp>
#include <cayspin/demagnetization/demagnetizing_field.hpp>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

/// Standard problem 4: a film of permalloy, 500 x 125 x 3 nm, in nx x ny x 1 cells. Reduced units:
/// lengths in nm, fields in Ms, times in (1 + alpha^2) / (gamma0 Ms).
class StandardProblem4 {
 public:
  using Vector = cayspin::Vec3<double>;
  using Exec = Kokkos::DefaultExecutionSpace;
  static constexpr double nanosecond_of(double damping) {
    return 1e-9 * gamma0 * saturation / (1 + damping * damping);
  }

  StandardProblem4(std::int64_t nx, std::int64_t ny,
                   cayspin::TensorOfCells& tensor = cayspin::demagnetizing_tensor)
      : film_{.shape = {nx, ny, 1},
              .spacing = {500. / static_cast<double>(nx), 125. / static_cast<double>(ny), 3}},
        spins_("spins", film_),
        demag_(spins_, cayspin::DemagnetizingField<double>(film_, {.tensor = &tensor})) {}

  /// Relaxes to the S state: from (1, 0.1, 0), without precession, until |m'| < torque everywhere.
  Vector relax(double torque) {
    std::vector<double> start;
    for (std::int64_t site = 0; site < film_.sites(); ++site)
      start.insert(start.end(), {1, 0.1, 0});
    cayspin::copy_from_host(start, spins_);
    cayspin::normalize(exec_, spins_);

    cayspin::LandauLifshitz const generator(
        cayspin::EffectiveField(cayspin::Exchange(film_, exchange), demag_), 1.0, false);
    cayspin::LieEuler stepper(spins_);
    double const bound = cayspin::exchange_bound(film_, exchange) + 1;
    double const dt =
        0.95 * cayspin::largest_stable_step<decltype(stepper)>(bound, 1.0, {.precession = false});
    auto const until_rest = [&](auto const& exec, cayspin::Step const& step, auto const& spins) {
      return cayspin::largest_rate(exec, generator, spins, step.time) < torque
                 ? cayspin::Next::stop
                 : cayspin::Next::proceed;
    };
    cayspin::integrate(exec_, stepper, generator, spins_, {0, dt, 100000},
                       cayspin::Every(100, until_rest));
    at_rest_ = cayspin::copy_to_host(spins_);
    return cayspin::magnetization(exec_, spins_);
  }

  /// For programs that continue from the S state themselves: the film, its S state, its
  /// demagnetising field, a nanosecond in reduced units, and the equation of motion.
  cayspin::Lattice const& film() const { return film_; }
  std::vector<double> const& at_rest() const { return at_rest_; }
  auto const& demag() const { return demag_; }
  static double nanosecond() { return nanosecond_of(alpha); }
  template <class Demag>
  auto generator(Demag const& demag, Vector const& millitesla) const {
    return cayspin::LandauLifshitz(
        cayspin::EffectiveField(cayspin::Exchange(film_, exchange), demag,
                                cayspin::Zeeman{(1e-3 / (mu0 * saturation)) * millitesla}),
        alpha);
  }

  struct Reversal {
    Vector m;             // after a nanosecond
    double crossing = 0;  // the first time at which <m_x> is zero, in ns
  };
  /// Reverses the S state by a field in mT.
  Reversal reverse(Vector const& millitesla, int steps) {
    cayspin::copy_from_host(at_rest_, spins_);
    auto const of_film = generator(demag_, millitesla);
    cayspin::Rkmk4 stepper(spins_);
    Reversal reversal;
    double before = 1;
    auto const watch = [&](auto const& exec, cayspin::Step const& step, auto const& spins) {
      reversal.m = cayspin::magnetization(exec, spins);
      double const now = reversal.m.x;
      if (reversal.crossing == 0 && now <= 0)
        reversal.crossing = (step.time - step.dt * now / (now - before)) / nanosecond_of(alpha);
      before = now;
    };
    cayspin::integrate(exec_, stepper, of_film, spins_, {0, nanosecond() / steps, steps}, watch);
    return reversal;
  }

 private:
  using Spins = cayspin::SpinField<double>;

  static constexpr double mu0 = 4e-7 * std::numbers::pi, gamma0 = 2.211e5;  // m/(A s)
  static constexpr double saturation = 8e5, stiffness = 1.3e-11;            // A/m, J/m
  static constexpr double alpha = 0.02;
  static constexpr double exchange = 2 * stiffness / (mu0 * saturation * saturation) * 1e18;

  Exec exec_;
  cayspin::Lattice film_;
  Spins spins_;
  cayspin::HostField<Spins, cayspin::DemagnetizingField<double>> demag_;
  std::vector<double> at_rest_;
};
