// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "random_bodies.hpp"

#include <cayspin/rotation/cayley.hpp>

#include <cmath>
#include <cstdint>

/// Steps m <- cay(F(m)) m of one rigid body in plain host code, for the paper's wrong formulas,
/// which the library does not have.
namespace cayspin::paper {

/// Returns A without its part along m.
inline Vector orthogonal_part(Vector const& a, Vector const& m) {
  return multiply_add(-dot(a, m), m, a);
}

/// Return A = -I^-1 m, and this A without its part along m.
inline Vector default_generator(Body const& body, Vector const& m) {
  return -1.0 * body.velocity(m);
}
inline Vector orthogonal_generator(Body const& body, Vector const& m) {
  return orthogonal_part(default_generator(body, m), m);
}

/// Result for one body.
struct HostRun {
  Vector end;
  double energy_error;  // max over all steps of |H - H(start)|
};

/// Takes steps of one body. `update(m)` returns F, with dt included.
template <class Update>
HostRun take_steps(Body const& body, std::int64_t steps, Update const& update) {
  HostRun run{body.start, 0};
  double const first = body.energy(body.start);
  for (std::int64_t n = 0; n < steps; ++n) {
    run.end = Cayley::rotate(Vector(update(run.end)), run.end);
    run.energy_error = std::max(run.energy_error, std::abs(body.energy(run.end) - first));
  }
  return run;
}

/// Returns Heun's F for a generator A(m).
template <class Generator>
Vector heun_update(Generator const& generator, Vector const& m, double dt) {
  Vector const a = generator(m);
  return (0.5 * dt) * (a + generator(Cayley::rotate(Vector(dt * a), m)));
}

inline double distance(Vector const& a, Vector const& b) {
  Vector const d = a - b;
  return std::sqrt(dot(d, d));
}

}  // namespace cayspin::paper
