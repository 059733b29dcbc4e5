// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "choices.hpp"
#include "comparison.hpp"
#include "host_steps.hpp"
#include "measures.hpp"
#include "slab.hpp"

namespace cayspin::paper {
namespace {

constexpr double end_time = 10;

// Return <A', A x m> along the exact flow: the first for A = -I^-1 m, the second with A_o in place
// of A. The two values differ.
double default_product(Body const& body, Vector const& m) {
  Vector const x = cross(default_generator(body, m), m);
  return dot(default_generator(body, x), x);
}
double orthogonal_product(Body const& body, Vector const& m) {
  Vector const x = cross(default_generator(body, m), m);
  Vector const rate = default_generator(body, x) + (2 * body.energy(m)) * x;
  return dot(rate, x);
}

double square(Vector const& a) { return dot(a, a); }

/// A function that returns A + sigma * m, or A_o + sigma * m, with one choice of sigma.
using Form = Vector (*)(Body const&, Vector const& m);

Vector without_sigma(Body const& body, Vector const& m) { return orthogonal_generator(body, m); }
Vector corrected(Body const& body, Vector const& m) {
  double const sigma = -default_product(body, m) / square(orthogonal_generator(body, m));
  return multiply_add(sigma, m, default_generator(body, m));
}
Vector printed_on_default(Body const& body, Vector const& m) {
  double const sigma = default_product(body, m) / square(orthogonal_generator(body, m));
  return multiply_add(sigma, m, default_generator(body, m));
}
Vector printed_on_orthogonal(Body const& body, Vector const& m) {
  Vector const w = orthogonal_generator(body, m);
  return multiply_add(orthogonal_product(body, m) / square(w), m, w);
}
Vector printed_norm(Body const& body, Vector const& m) {
  Vector const a = default_generator(body, m);
  return multiply_add(-default_product(body, m) / square(a), m, a);
}

auto energy_error(Form form) {
  return [=](double dt) {
    return [=](Body const& body) {
      return take_steps(body, std::llround(end_time / dt),
                        [&](Vector const& m) { return dt * form(body, m); })
          .energy_error;
    };
  };
}

// Returns a function of a body: the magnitude of the component along A_o of the error of one step,
// divided by dt^2. With the right sigma, this quotient tends to zero as dt -> 0.
auto local_error(Form form, double dt) {
  return [=](Body const& body) {
    auto const& m = body.start;
    Vector const w = orthogonal_generator(body, m);
    auto const flow = [&](Vector const& at) {
      return heun_update([&](Vector const& n) { return orthogonal_generator(body, n); }, at,
                         dt / 16);
    };
    Vector const error =
        Cayley::rotate(Vector(dt * form(body, m)), m) - take_steps(body, 16, flow).end;
    return std::abs(dot(error, w)) / std::sqrt(square(w)) / (dt * dt);
  };
}

// Returns a function of a body: |s - sigma|, where s is sigma computed with a forward difference of
// A_o over dt.
auto remainder(double dt) {
  return [=](Body const& body) {
    auto const& m = body.start;
    Vector const w = orthogonal_generator(body, m);
    Vector const ahead = Cayley::rotate(Vector(dt * w), m);
    Vector const rate = (1 / dt) * (orthogonal_generator(body, ahead) - w);
    return std::abs(dot(rate, cross(w, m)) - orthogonal_product(body, m)) / square(w);
  };
}

// Returns a function that, called as f(dt)(body), measures the energy error of implicit Euler,
// xi = A(cay(dt * xi) m), with sigma * m added to xi, where sigma = sign * <A', A x m> / |A_o|^2.
auto implicit_energy_error(double sign) {
  return [=](double dt) {
    return [=](Body const& body) {
      return take_steps(body, std::llround(end_time / dt),
                        [&](Vector const& m) {
                          Vector xi = default_generator(body, m);
                          for (int i = 0; i < 30; ++i)
                            xi = default_generator(body, Cayley::rotate(Vector(dt * xi), m));
                          double const sigma = sign * default_product(body, m) /
                                               square(orthogonal_generator(body, m));
                          return dt * multiply_add(sigma, m, xi);
                        })
          .energy_error;
    };
  };
}

double order_of_slab_sigma() {
  auto const change = [](double dt) {
    auto const coarse = sigma_at_start(full, dt), fine = sigma_at_start(full, dt / 2);
    std::vector<double> changes;
    for (std::size_t i = 0; i < fine.size(); ++i) changes.push_back(std::abs(coarse[i] - fine[i]));
    return changes;
  };
  return quantile(orders(change(2e-3), change(1e-3), 2, order_round_off), 0.5);
}

void slab_rows(Comparison& comparison) {
  constexpr int looks = 400;
  auto const reference = run_slab(full, rkmk4_def, 0.0025, looks);
  auto const printed = run_slab_with_sigma(full, -1, 0.01, looks);
  auto const corrected =
      run_slab(full, choose("euler", Generator::standard, Isotropy::finite_difference_backward),
               0.01, looks);
  comparison.row("switching slab, dt = 0.01, backward differences: largest distance of a spin",
                 largest_distance(printed, reference), largest_distance(corrected, reference));
}

}  // namespace

void erratum_sigma(Comparison& comparison) {
  comparison.begin(2, "Sec. 4.1, movingsigma and second_order",
                   "sigma = <dA, A x m>/|A|^2 + O(dt^2)", "sigma = -<dA, A x m>/|A_o|^2 + O(dt)");
  auto const bodies = errata_bodies(comparison.context);
  struct Variant {
    char const* name;
    Form form;
  };
  Variant const variants[]{{"sign, on A", printed_on_default},
                           {"sign, on A_o", printed_on_orthogonal},
                           {"|A|^2, on A", printed_norm}};
  for (double const dt : {1e-2, 1e-3})
    for (auto const& [name, form] : variants)
      comparison.row(fmt::format("local error along A_o over dt^2, dt = {:g}: {}", dt, name),
                     median_of(bodies, local_error(form, dt)),
                     median_of(bodies, local_error(corrected, dt)));
  auto const library = [&](double dt) {
    return run_ensemble(bodies, euler_cor, dt, end_time).energy_errors;
  };
  auto const coarse = library(coarse_dt);
  double const order =
      quantile(orders(coarse, library(fine_dt), coarse_dt / fine_dt, order_round_off), 0.5);
  for (auto const& [name, form] : variants) {
    comparison.row(
        fmt::format("energy error over [0, {:g}], dt = {:g}: {}", end_time, coarse_dt, name),
        median_of(bodies, energy_error(form)(coarse_dt)), quantile(coarse, 0.5));
    comparison.row(fmt::format("energy order, dt {:g} to {:g}: {}", coarse_dt, fine_dt, name),
                   median_order(bodies, energy_error(form)), order);
  }
  auto const twice = [&](Body const& body) {
    return energy_error(printed_on_orthogonal)(fine_dt)(body) /
           energy_error(without_sigma)(fine_dt)(body);
  };
  comparison.row("energy error, sign, on A_o, over that of sigma = 0", median_of(bodies, twice),
                 not_a_number);
  comparison.row("order of the remainder of sigma by a forward difference: switching slab", 2,
                 order_of_slab_sigma());
  comparison.row("... rigid body, where sigma |A_o|^2 is conserved", 2,
                 median_order(bodies, remainder));
  comparison.row("implicit Euler, energy order: there the printed sign is right",
                 median_order(bodies, implicit_energy_error(1)),
                 median_order(bodies, implicit_energy_error(-1)));
  slab_rows(comparison);
}

}  // namespace cayspin::paper
