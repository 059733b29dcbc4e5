// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "random_bodies.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace cayspin::paper {
namespace {

constexpr double flattening = 0.15;
using Shape = Law::Shape;

// The standard library's engines give the same numbers on all platforms, unlike its distributions.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : engine_(seed) {}

  double uniform(double from, double to) {
    return from + (to - from) * std::ldexp(static_cast<double>(engine_() >> 11U), -53);
  }
  Vector on_sphere() {
    double const z = uniform(-1, 1), azimuth = uniform(0, 2 * std::numbers::pi);
    double const radius = std::sqrt((1 - z) * (1 + z));
    return {radius * std::cos(azimuth), radius * std::sin(azimuth), z};
  }
  // Returns axes distributed uniformly over all orientations: the first uniform on the sphere, the
  // second rotated about it by a uniform angle.
  std::array<Vector, 3> frame() {
    Vector const first = on_sphere();
    Vector const helper = std::abs(first.x) < 0.6 ? Vector{1, 0, 0} : Vector{0, 1, 0};
    Vector const raw = cross(first, helper);
    Vector const second = (1 / std::sqrt(dot(raw, raw))) * raw;
    double const turn = uniform(0, 2 * std::numbers::pi);
    Vector const turned =
        multiply_add(std::cos(turn), second, Vector(std::sin(turn) * cross(first, second)));
    return {first, turned, cross(first, turned)};
  }

 private:
  std::mt19937_64 engine_;
};

bool can_be(std::array<double, 3> const& moments) {
  auto const [a, b, c] = moments;
  return a < b + c && b < c + a && c < a + b;
}

std::array<double, 3> draw_moments(Law const& law, Dice& dice) {
  auto const moment = [&] { return dice.uniform(law.least, law.largest); };
  if (law.shape == Shape::nearly_spherical) {
    double const equal = moment();
    return {equal, equal, equal * (1 + dice.uniform(-flattening, flattening))};
  }
  std::array<double, 3> moments;
  do {
    moments = {moment(), moment(), moment()};
    if (law.shape == Shape::axisymmetric) moments[1] = moments[0];
  } while (!can_be(moments));
  return moments;
}

// Returns a random point of the great circles H(m) = 1 / (2 * I_middle), on which the ratio of <m,
// e_least> and <m, e_largest> is fixed up to its sign.
Vector on_separatrix(Body const& body, Dice& dice) {
  std::array<std::size_t, 3> order{0, 1, 2};
  std::ranges::sort(order, {}, [&](std::size_t i) { return body.moments[i]; });
  auto const [least, middle, most] = order;
  auto const inverse = [&](std::size_t i) { return 1 / body.moments[i]; };
  double const across = std::atan2(std::sqrt(inverse(least) - inverse(middle)),
                                   std::sqrt(inverse(middle) - inverse(most)));
  double const side = dice.uniform(0, 1) < 0.5 ? -1 : 1;
  double const along = dice.uniform(0, 2 * std::numbers::pi);
  Vector const great = multiply_add(side * std::sin(across), body.axes[most],
                                    Vector(std::cos(across) * body.axes[least]));
  return multiply_add(std::cos(along), body.axes[middle], Vector(std::sin(along) * great));
}

cayspin::detail::SymmetricMatrix<double> inverse(std::array<double, 3> const& moments,
                                                 std::array<Vector, 3> const& axes) {
  cayspin::detail::SymmetricMatrix<double> b{};
  for (std::size_t i = 0; i < 3; ++i) {
    auto const& e = axes[i];
    b.xx += e.x * e.x / moments[i], b.yy += e.y * e.y / moments[i];
    b.zz += e.z * e.z / moments[i], b.xy += e.x * e.y / moments[i];
    b.xz += e.x * e.z / moments[i], b.yz += e.y * e.z / moments[i];
  }
  return b;
}

}  // namespace

std::string describe(Law const& law) {
  auto const interval = fmt::format("[{:g}, {:g}]", law.least, law.largest);
  std::string const moments =
      law.shape == Shape::nearly_spherical
          ? fmt::format("two equal moments uniform in {}, the third within {:g} % of them",
                        interval, 100 * flattening)
          : fmt::format("{} uniform in {} under the triangle inequality",
                        law.shape == Shape::axisymmetric ? "two equal moments and a third"
                                                         : "three moments of inertia",
                        interval);
  return fmt::format("{}; axes uniform; starts uniform on the {}", moments,
                     law.shape == Shape::separatrix ? "separatrix" : "sphere");
}

std::vector<Body> draw_bodies(Law const& law, std::int64_t count, std::uint64_t seed) {
  Dice dice(seed);
  std::vector<Body> bodies(static_cast<std::size_t>(count));
  for (auto& body : bodies) {
    body.moments = draw_moments(law, dice);
    body.axes = dice.frame();
    body.inverse_inertia = inverse(body.moments, body.axes);
    body.start = law.shape == Shape::separatrix ? on_separatrix(body, dice) : dice.on_sphere();
  }
  return bodies;
}

Body principal_body(std::array<double, 3> const& moments, Vector const& start) {
  std::array<Vector, 3> const axes{Vector{1, 0, 0}, Vector{0, 1, 0}, Vector{0, 0, 1}};
  return {moments, axes, start, inverse(moments, axes)};
}

}  // namespace cayspin::paper
