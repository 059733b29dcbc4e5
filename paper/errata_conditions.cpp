// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "comparison.hpp"
#include "host_steps.hpp"
#include "measures.hpp"

namespace cayspin::paper {
namespace {

/// A function that returns d = xi_2 - A' for a method F = dt * A + dt^2 / 2 * (A' + d), where
/// A = -I^-1 m.
using Choose = Vector (*)(Body const&, Vector const& m);

// Returns a d that fulfils only the printed condition: <d, A> = 0, but d x m = A x m.
Vector fulfils_printed(Body const& body, Vector const& m) {
  Vector const a = default_generator(body, m), w = orthogonal_part(a, m);
  return multiply_add(-dot(w, w) / dot(a, m), m, w);
}

// Returns the d that makes A' + d equal to A' without its part along m. It fulfils only the
// corrected condition: d x m = 0, but <d, A> is not 0.
Vector fulfils_corrected(Body const& body, Vector const& m) {
  Vector const a = default_generator(body, m);
  Vector const rate = default_generator(body, cross(a, m));
  return -dot(rate, m) * m;
}

auto error_at_2(Choose choose) {
  return [=](double dt) {
    return [=](Body const& body) {
      auto const steps = std::llround(2 / dt);
      auto const end = take_steps(body, steps, [&](Vector const& m) {
                         Vector const a = default_generator(body, m);
                         Vector const rate = default_generator(body, cross(a, m));
                         return multiply_add(dt * dt / 2, rate + choose(body, m), Vector(dt * a));
                       }).end;
      auto const exact =
          take_steps(body, 64 * steps, [&](Vector const& m) {
            return heun_update([&](Vector const& n) { return default_generator(body, n); }, m,
                               dt / 64);
          }).end;
      return distance(end, exact);
    };
  };
}

double printed_condition(Choose choose, Body const& body) {
  auto const& m = body.start;
  return std::abs(dot(choose(body, m), default_generator(body, m)));
}
double corrected_condition(Choose choose, Body const& body) {
  auto const& m = body.start;
  return std::abs(dot(cross(choose(body, m), m), cross(default_generator(body, m), m)));
}

}  // namespace

void erratum_second_order_condition(Comparison& comparison) {
  comparison.begin(8, "Sec. 4.1, second_order, first condition",
                   "<xi_2 - A', A> = 0, which presumes that A is orthogonal to m",
                   "<(xi_2 - A') x m, A x m> = 0");
  auto const bodies = errata_bodies(comparison.context);
  auto const both = [&](std::string_view what, auto const& measure) {
    comparison.row(
        what, median_of(bodies, [&](Body const& body) { return measure(fulfils_printed, body); }),
        median_of(bodies, [&](Body const& body) { return measure(fulfils_corrected, body); }));
  };
  both("a method that fulfils the one condition, not the other: |printed|", printed_condition);
  both("... |corrected|", corrected_condition);
  comparison.row("... order of its trajectory, A = -I^-1 m",
                 median_order(bodies, error_at_2(fulfils_printed)),
                 median_order(bodies, error_at_2(fulfils_corrected)));
}

}  // namespace cayspin::paper
