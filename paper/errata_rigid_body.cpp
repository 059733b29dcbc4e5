// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "choices.hpp"
#include "comparison.hpp"
#include "host_steps.hpp"
#include "measures.hpp"

namespace cayspin::paper {
namespace {

// Returns sigma in the second form of F^Eul_cor, up to its sign: the sum of the u_i divided by
// the sum of the I_i * u_i, with u_i = (I_j - I_k)^2 * I_i * (m_j * m_k)^power.
double second_form(Body const& body, Vector const& m, int power) {
  auto const& moment = body.moments;
  double above = 0, below = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    auto const j = (i + 1) % 3, k = (i + 2) % 3;
    double const product = dot(body.axes[j], m) * dot(body.axes[k], m);
    double const difference = moment[j] - moment[k];
    double const u =
        difference * difference * moment[i] * (power == 2 ? product * product : product);
    above += u, below += moment[i] * u;
  }
  return above / below;
}

// Returns <X, I^-1 X>/|X|^2 with X = m x I^-1 m.
double first_form(Body const& body, Vector const& m) {
  Vector const x = cross(m, body.velocity(m));
  return dot(x, body.velocity(x)) / dot(x, x);
}

}  // namespace

void erratum_sign_of_rigid_body(Comparison& comparison) {
  comparison.begin(1, "Sec. 5, rigid_body: X = m x I^-1 m is not A x m for the A that follows",
                   "A = I^-1 m", "A = -I^-1 m");
  auto const bodies = errata_bodies(comparison.context);
  auto const solution = run_ensemble(bodies, rkmk4_def, 0.01, 10).ends;
  auto const corrected = run_ensemble(bodies, euler_def, 0.01, 10);
  std::vector<double> printed_distances, distances;
  std::vector<double> printed_errors, differences;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    auto body = bodies[i];
    auto const step = [&](Vector const& m) { return 0.01 * body.velocity(m); };
    printed_distances.push_back(distance(take_steps(body, 1000, step).end, solution[i]));
    distances.push_back(distance(corrected.ends[i], solution[i]));
    body.start = -1.0 * body.start;
    printed_errors.push_back(take_steps(body, 1000, step).energy_error);
    differences.push_back(std::abs(printed_errors[i] - corrected.energy_errors[i]));
  }
  comparison.row("distance from m' = m x I^-1 m at t = 10, geometric Euler, dt = 0.01",
                 quantile(printed_distances, 0.5), quantile(distances, 0.5));
  comparison.row("largest energy error over [0, 10]; the printed one from -m",
                 quantile(printed_errors, 0.5), quantile(corrected.energy_errors, 0.5));
  comparison.row("... largest difference of the two over all bodies", not_a_number,
                 quantile(differences, 1));
  comparison.note("The tables are not touched: m -> -m turns one into the other.");
}

void erratum_euler_correction(Comparison& comparison) {
  comparison.begin(3, "Sec. 5.1, F^Eul_cor, second form (for A = +I^-1 m)",
                   "+ tau(u)/tau(I u) m, u_i = (I_j - I_k)^2 I_i m_j m_k",
                   "- tau(u)/tau(I u) m, u_i = (I_j - I_k)^2 I_i (m_j m_k)^2");
  auto const bodies = errata_bodies(comparison.context);
  auto const difference = [&](int power, double sign) {
    return [=](Body const& body) {
      double const first = -first_form(body, body.start);
      return std::abs(sign * second_form(body, body.start, power) / first - 1);
    };
  };
  comparison.row("|second form / first form - 1|", median_of(bodies, difference(1, 1)),
                 median_of(bodies, difference(2, -1)));
  comparison.row("... only the sign corrected", median_of(bodies, difference(1, -1)), not_a_number);
  comparison.row("... only the power corrected", median_of(bodies, difference(2, 1)), not_a_number);
  auto const energy_error = [](int power, double sign, double dt) {
    return [=](Body const& body) {
      return take_steps(body, std::llround(10 / dt),
                        [&](Vector const& m) {
                          double const sigma = sign * second_form(body, m, power);
                          return dt * multiply_add(sigma, m, body.velocity(m));
                        })
          .energy_error;
    };
  };
  comparison.row("energy order of geometric Euler with the second form",
                 median_order(bodies, [&](double dt) { return energy_error(1, 1, dt); }),
                 median_order(bodies, [&](double dt) { return energy_error(2, -1, dt); }));
}

}  // namespace cayspin::paper
