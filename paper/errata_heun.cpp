// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "choices.hpp"
#include "comparison.hpp"
#include "host_steps.hpp"
#include "measures.hpp"

namespace cayspin::paper {
namespace {

constexpr double end = 10;

// Returns sigma_def of Sec. 5.2, as printed: <J^n, u>/<J^d, u>.
double printed_sigma_def(Body const& body, Vector const& m) {
  auto const& moment = body.moments;
  double above = 0, below = 0;
  for (std::size_t j = 0; j < 3; ++j) {
    auto const k = (j + 1) % 3, l = (j + 2) % 3;
    double const product = dot(body.axes[k], m) * dot(body.axes[l], m);
    double const difference = moment[k] - moment[l];
    double const both = product * product * difference * difference;
    above -= moment[j] * (moment[k] + moment[l]) * both;
    below += 4 * moment[0] * moment[1] * moment[2] * moment[j] * moment[j] * both;
  }
  return above / below;
}

// Returns the correct sigma_def for A = -I^-1 m: <BV, (t - B) BV>/(4 |V|^2), where V = m x Bm,
// B = I^-1, and t is the trace of B.
double invariant_sigma_def(Body const& body, Vector const& m) {
  Vector const v = cross(m, body.velocity(m)), bv = body.velocity(v);
  auto const& b = body.inverse_inertia;
  double const trace = b.xx + b.yy + b.zz;
  return dot(bv, trace * bv - body.velocity(bv)) / (4 * dot(v, v));
}

/// Returns a function that, called as f(dt)(body), measures the energy error. The method is Heun on
/// A = -I^-1 m, with factor * dt^power * sigma_def * m added to F, where sigma_def is the printed
/// one.
auto energy_error(double factor, int power) {
  return [=](double dt) {
    return [=](Body const& body) {
      return take_steps(
                 body, std::llround(end / dt),
                 [&](Vector const& m) {
                   auto const a = [&](Vector const& n) { return default_generator(body, n); };
                   double const sigma = factor * std::pow(dt, power) * printed_sigma_def(body, m);
                   return multiply_add(sigma, m, heun_update(a, m, dt));
                 })
          .energy_error;
    };
  };
}

struct Library {
  double error, order;
};
Library library(std::vector<Body> const& bodies, MethodChoice const& choice) {
  auto const coarse = run_ensemble(bodies, choice, coarse_dt, end).energy_errors;
  auto const fine = run_ensemble(bodies, choice, fine_dt, end).energy_errors;
  return {quantile(coarse, 0.5),
          quantile(orders(coarse, fine, coarse_dt / fine_dt, order_round_off), 0.5)};
}

void row_pair(Comparison& comparison, std::vector<Body> const& bodies, std::string_view name,
              double factor, int power, Library const& right) {
  auto const printed = energy_error(factor, power);
  comparison.row(fmt::format("energy error over [0, {:g}], dt = {:g}{}", end, coarse_dt, name),
                 median_of(bodies, printed(coarse_dt)), right.error);
  comparison.row(fmt::format("energy order, dt {:g} to {:g}{}", coarse_dt, fine_dt, name),
                 median_order(bodies, printed), right.order);
}

}  // namespace

void erratum_power_of_dt(Comparison& comparison) {
  comparison.begin(4, "Sec. 4.3, F^RK2_dcor (and method1: F without the dt that gen_update needs)",
                   "F + dt^2 sigma_def m (Sec. 4.3), F + dt^3 sigma_def m (Sec. 5.2)",
                   "F + dt^3 sigma_def m, with dt inside F");
  auto const bodies = errata_bodies(comparison.context);
  row_pair(comparison, bodies, "", -1, 2, library(bodies, heun_dcor));
  auto const plain = library(bodies, heun_def);
  comparison.row("energy error without any correction", not_a_number, plain.error);
  comparison.row("energy order without any correction", not_a_number, plain.order);
}

void erratum_heun_correction(Comparison& comparison) {
  comparison.begin(5, "Sec. 5.2, sigma_def of Heun", "right for A = +I^-1 m",
                   "for A = -I^-1 m the other sign");
  auto const bodies = errata_bodies(comparison.context);
  auto const difference = [](double sign) {
    return [=](Body const& body) {
      return std::abs(
          sign * printed_sigma_def(body, body.start) / invariant_sigma_def(body, body.start) - 1);
    };
  };
  comparison.row("|sigma_def / sigma of the invariants - 1|, largest",
                 quantile(of_each(bodies, difference(1)), 1),
                 quantile(of_each(bodies, difference(-1)), 1));
  row_pair(comparison, bodies, ", A = -I^-1 m", 1, 3, library(bodies, heun_dcor));
}

}  // namespace cayspin::paper
