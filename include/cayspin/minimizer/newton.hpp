// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/minimizer/hessian.hpp>
#include <cayspin/stepper/field_algebra.hpp>

#include <cmath>

// Newton steps by preconditioned conjugate gradients, stopped early at negative curvature or when a
// spin turns too far (Nocedal and Wright 2006, Alg. 7.1 and 7.2).
namespace cayspin::inline v0_2::detail {

/// Work memory of `find_newton_step`.
template <class Spins>
struct NewtonArrays {
  Spins residual, preconditioned, direction, product;
};

struct NewtonOptions {
  double error = 0;              // relative error of the step
  double longest = 0;            // largest turn of a spin
  double residual = 0;           // stops when no site has a larger residual
  bool follows_negative = true;  // goes along negative curvature also after the first direction
};

struct NewtonStep {
  double slope = 0, longest = 0;  // g.p, and the largest |p| of a spin
  bool is_cut = false;            // by negative curvature or the longest turn
};

/// Writes p, an approximation of -H^-1 g with the Hessian H and the gradient g, into `step`. The
/// iteration ends at a direction along which the curvature is not positive. If this is the first
/// direction, or if options.follows_negative, the step first moves along it. Calls
/// `precondition(from, to)`.
template <class AnyHessian, class Exec, class Spins, class Precondition>
NewtonStep find_newton_step(AnyHessian& hessian, Exec const& exec, Spins const& gradient,
                            Spins const& step, NewtonArrays<Spins> const& arrays,
                            NewtonOptions const& options, Precondition const& precondition) {
  constexpr int most_products = 60;
  Spins const &r = arrays.residual, &z = arrays.preconditioned, &d = arrays.direction,
              &hd = arrays.product;
  NewtonStep found;
  combine(exec, 0, gradient, 0, gradient, step);
  combine(exec, -1, gradient, 0, gradient, r);
  auto const apply = [&] {
    precondition(r, z);
    hessian.keep_tangent(z);
    return inner_product(exec, r, z);
  };
  double rz = apply();
  double const first = rz;
  if (!(first > 0)) return found;
  combine(exec, 1, z, 0, z, d);
  for (int k = 0; k < most_products; ++k) {
    auto const [along, square] = hessian.multiply(d, hd);
    if (!(along > 0)) {
      found.is_cut = true;
      if (k > 0 && !options.follows_negative) break;
      double const factor = (options.longest + found.longest) / largest_length(exec, d);
      combine(exec, factor, d, 1, step, step);
      found.longest = largest_length(exec, step);
      break;
    }
    double const alpha = rz / along;
    combine(exec, alpha, d, 1, step, step);
    combine(exec, -alpha, hd, 1, r, r);
    found.longest = largest_length(exec, step);
    if (found.longest > options.longest) {
      found.is_cut = true;
      break;
    }
    if (largest_length(exec, r) < options.residual) break;
    double const before = rz;
    rz = apply();
    if (!(rz > options.error * options.error * first)) break;
    combine(exec, rz / before, d, 1, z, d);
  }
  if (found.longest > options.longest) {
    combine(exec, options.longest / found.longest, step, 0, step, step);
    found.longest = options.longest;
  }
  found.slope = inner_product(exec, gradient, step);
  return found;
}

}  // namespace cayspin::inline v0_2::detail
