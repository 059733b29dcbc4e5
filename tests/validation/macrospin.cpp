// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// One spin, damped in a constant field and undamped in a rotating one: compares the end points of
// closed forms, and errors of the methods, with reference values.
#include "../support/figures.hpp"
#include "../support/landau_lifshitz.hpp"

#include <cayspin_paper/rkmk4_as_printed.hpp>

using namespace cayspin;
using namespace cayspin::test;

namespace {

constexpr double end_time = 10;
std::vector<double> const dts{0.1, 0.05, 0.025, 0.0125};

Slab constant_field() {
  return {.lattice = Lattice::chain(1), .applied = {0.3, -0.4, 1.2}, .damping = 0.1};
}

Vector unit(Vector const& v) { return (1 / length(v)) * v; }

// With the angle theta to the field, tan(theta/2) shrinks exponentially, and the azimuth turns
// right-handed about the field.
Vector damped_precession(Vector const& field, double damping, Vector const& start, double t) {
  double const h = length(field);
  Vector const n = unit(field), u = unit(start - dot(start, n) * n), w = cross(n, u);
  double const theta =
      2 * std::atan(std::tan(0.5 * std::acos(dot(start, n))) * std::exp(-damping * h * t));
  return std::cos(theta) * n + std::sin(theta) * (std::cos(h * t) * u + std::sin(h * t) * w);
}

Vector const start{0.8, 0.6, 0};
Vector const end{0.4491235198500131, 0.16853399742628344, 0.8774305417690065};

template <class Stepper, class Generator>
std::vector<double> errors(Generator const& generator, Vector const& from, Vector const& to) {
  auto const spins = make_spins(Lattice::chain(1), [&](auto, auto, auto) { return from; });
  std::vector<double> result;
  for (double const dt : dts) {
    auto const steps = std::llround(end_time / dt);
    result.push_back(length(spin(run<Stepper>(generator, spins, dt, steps), 0) - to));
  }
  return result;
}

void expect_errors(std::string const& method, std::vector<double> const& figures,
                   std::vector<std::string> const& references) {
  for (std::size_t i = 0; i < dts.size(); ++i)
    expect_figure(method + ", dt " + std::to_string(dts[i]).substr(0, 6), figures[i],
                  references[i]);
}

TEST(Macrospin, EndPointOfTheClosedForm) {
  EXPECT_LT(length(damped_precession({0.3, -0.4, 1.2}, 0.1, start, end_time) - end), 1e-15);
}

TEST(Macrospin, Euler) {
  expect_errors("Euler", errors<ClassicalEuler<Spins>>(constant_field().natural(), start, end),
                {"7.49e-1", "3.27e-1", "1.52e-1", "7.35e-2"});
}

/// Checks the errors of a method with each generator, in the constant field.
template <class Stepper>
void expect_errors(std::string const& method, std::vector<std::string> const& natural,
                   std::vector<std::string> const& orthogonal) {
  Slab const slab = constant_field();
  expect_errors(method + ", default", errors<Stepper>(slab.natural(), start, end), natural);
  expect_errors(method + ", orthogonal", errors<Stepper>(slab.orthogonal(), start, end),
                orthogonal);
}

TEST(Macrospin, GeometricEuler) {
  expect_errors<LieEuler<Spins>>("geometric Euler",
                                 {"1.319e-2", "8.909e-3", "5.038e-3", "2.665e-3"},
                                 {"2.262e-1", "1.144e-1", "5.703e-2", "2.840e-2"});
}

TEST(Macrospin, GeometricHeun) {
  expect_errors<LieHeun<Spins>>("geometric Heun", {"9.70e-3", "2.43e-3", "6.07e-4", "1.52e-4"},
                                {"9.3e-4", "3.5e-4", "1.03e-4", "2.75e-5"});
}

TEST(Macrospin, Rkmk4) {
  expect_errors<Rkmk4<Spins>>("rkmk4", {"1.009e-6", "6.204e-8", "3.841e-9", "2.388e-10"},
                              {"5.265e-6", "3.294e-7", "2.059e-8", "1.286e-9"});
}

TEST(Macrospin, Rkmk4AsPrinted) {
  expect_errors<Rkmk4AsPrinted<Spins>>("rkmk4 as printed",
                                       {"8.03e-6", "1.99e-6", "3.11e-7", "4.28e-8"},
                                       {"1.34e-4", "1.66e-5", "2.06e-6", "2.58e-7"});
}

TEST(Macrospin, RotatingField) {
  LandauLifshitz const generator{
      EffectiveField{TimeDependentZeeman{[](double t) {
        return Vector{0.7 * std::cos(1.3 * t), 0.7 * std::sin(1.3 * t), 0.9};
      }}},
      0.0};
  // In the frame that turns with the field, the spin precesses about a constant field.
  Vector const in_frame = damped_precession({0.7, 0, 0.9 - 1.3}, 0, {0.6, 0, 0.8}, end_time);
  double const c = std::cos(1.3 * end_time), s = std::sin(1.3 * end_time);
  Vector const exact{c * in_frame.x - s * in_frame.y, s * in_frame.x + c * in_frame.y, in_frame.z};
  EXPECT_LT(length(exact - Vector{.41326265, -.87850247, -.23968185}), 1e-8);
  expect_errors("rotating field, rkmk4", errors<Rkmk4<Spins>>(generator, {0.6, 0, 0.8}, exact),
                {"1.956e-6", "1.235e-7", "7.741e-9", "4.841e-10"});
  expect_errors("rotating field, geometric Heun",
                errors<LieHeun<Spins>>(generator, {0.6, 0, 0.8}, exact),
                {"1.857e-2", "4.654e-3", "1.164e-3", "2.911e-4"});
}

}  // namespace
