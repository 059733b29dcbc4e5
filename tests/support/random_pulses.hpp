// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <numbers>
#include <random>
#include <string>
#include <vector>

namespace cayspin::test {

/// A part of a component of H: its text in a scene, its value, and its corners.
struct TimeShape {
  enum Kind { square, trapezoid, gaussian, sinc, step, train };
  static constexpr int kinds = 6;

  Kind kind;
  double height, middle, width;
  int pulses = 1;  // in a train; each is `width` wide, and they are five widths apart

  static std::string number(double x) {
    char text[32];
    std::snprintf(text, sizeof text, "(%.17g)", x);
    return text;
  }
  std::string x() const { return "((t-" + number(middle) + ")/" + number(width) + ")"; }
  double begin() const { return middle - 0.5 * width; }
  double end() const { return middle + 0.5 * width; }
  double period() const { return 5 * width; }
  double last() const { return middle + (pulses - 1) * period(); }

  std::string text() const {
    auto const h = number(height);
    switch (kind) {
      case square:
        return "(t>" + number(begin()) + " && t<" + number(end()) + " ? " + h + " : 0)";
      case trapezoid:
        return h + "*max(0,min(1,min((t-" + number(begin()) + "),(" + number(end()) + "-t))/" +
               number(0.25 * width) + "))";
      case gaussian:
        return h + "*exp(0-" + x() + "^2)";
      case sinc:
        return h + "*sin(" + x() + ")/" + x() + "*exp(0-(" + x() + "/10)^2)";
      case step:
        return h + "*0.5*(1+tanh(" + x() + "))";
      case train: {
        auto const n = "((t-" + number(middle) + ")/" + number(period()) + ")";
        return "(abs(" + n + "-rint(" + n + "))<0.1 && " + n + ">0-0.5 && " + n + "<" +
               number(pulses - 0.5) + " ? " + h + " : 0)";
      }
    }
    return "0";
  }

  double value(double t) const {
    double const s = (t - middle) / width;
    switch (kind) {
      case square:
        return t > begin() && t < end() ? height : 0;
      case trapezoid:
        return height *
               std::max(0.0, std::min(1.0, std::min(t - begin(), end() - t) / (0.25 * width)));
      case gaussian:
        return height * std::exp(-s * s);
      case sinc:
        return height * (s == 0 ? 1 : std::sin(s) / s) * std::exp(-s * s / 100);
      case step:
        return height * 0.5 * (1 + std::tanh(s));
      case train: {
        double const n = (t - middle) / period();
        return std::abs(n - std::rint(n)) < 0.1 && n > -0.5 && n < pulses - 0.5 ? height : 0;
      }
    }
    return 0;
  }

  /// Returns the times of corners in ascending order. Before the first and after the last, the
  /// value hardly changes.
  std::vector<double> corners() const {
    std::vector<double> all;
    switch (kind) {
      case square:
        return {begin(), end()};
      case trapezoid:
        return {begin(), begin() + 0.25 * width, end() - 0.25 * width, end()};
      case train:
        for (int i = 0; i < pulses; ++i)
          for (double const side : {-0.5, 0.5}) all.push_back(middle + i * period() + side * width);
        return all;
      default: {
        double const reach = (kind == gaussian ? 7 : kind == sinc ? 70 : 20) * width;
        return {middle - reach, middle, middle + reach};
      }
    }
  }
  bool is_smooth() const { return kind == gaussian || kind == sinc || kind == step; }
  /// Returns the pulse's width at half height; for a sinc a little more than that of its first side
  /// lobe.
  double width_at_half_height() const {
    if (kind == gaussian) return 2 * std::sqrt(std::numbers::ln2) * width;
    if (kind == sinc) return 2.5 * width;
    if (kind == trapezoid) return 0.75 * width;
    return width;
  }
};

/// One damped spin in a field with pulses and steps at random times, whose widths are at least 1e-6
/// of the run.
class RandomPulses {
 public:
  using Triple = std::array<double, 3>;

  RandomPulses(std::uint64_t seed, std::int64_t number)
      : engine_(seed * 1000003u + static_cast<std::uint64_t>(number)) {
    end = std::pow(10.0, between(0.5, 2.3));
    damping = between(0.05, 0.5);
    constant = {between(-0.3, 0.3), between(-0.3, 0.3), 1};
    start = below(2) == 0 ? constant : Triple{0.6, 0.2, 0.7};
    double const length = std::sqrt(dot(start, start));
    for (double& m : start) m /= length;
    int const count = 1 + below(2);
    for (int i = 0; i < count; ++i) shapes_[static_cast<std::size_t>(below(3))].push_back(shape());
  }

  double end, damping;
  Triple constant, start;

  Triple field(double t) const {
    auto h = constant;
    for (std::size_t c = 0; c < 3; ++c)
      for (auto const& shape : shapes_[c]) h[c] += shape.value(t);
    return h;
  }

  /// Returns all tables of the scene but [integrator].
  std::string tables() const {
    auto const number = TimeShape::number;
    auto const triple = [&](auto const& of) {
      std::string all;
      for (std::size_t c = 0; c < 3; ++c) all += (c == 0 ? "[" : ", ") + of(c);
      return all + "]";
    };
    auto const plain = [](double x) {
      char text[32];
      std::snprintf(text, sizeof text, "%.17g", x);
      return std::string(text);
    };
    return "system = { kind = \"llg\", damping = " + plain(damping) +
           " }\nlattice = { shape = [1] }\nfield = { applied = " + triple([&](std::size_t c) {
             auto text = "\"" + number(constant[c]);
             for (auto const& shape : shapes_[c]) text += " + " + shape.text();
             return text + "\"";
           }) +
           " }\ninitial = { uniform = " + triple([&](std::size_t c) { return plain(start[c]); }) +
           " }\n";
  }

  /// Returns the width of the shortest pulse that rises and falls within the run; infinity if there
  /// is none.
  double shortest() const {
    double least = std::numeric_limits<double>::infinity();
    for (auto const& shapes : shapes_)
      for (auto const& shape : shapes)
        if (is_within(shape)) least = std::min(least, shape.width_at_half_height());
    return least;
  }

  /// Returns true if two pulses overlap in one component. If one jumps on a flank of the other,
  /// their sum may have a pulse shorter than both.
  bool overlap() const {
    return std::ranges::any_of(shapes_, [](auto const& shapes) {
      if (shapes.size() < 2) return false;
      auto const a = shapes[0].corners(), b = shapes[1].corners();
      return a.front() < b.back() && b.front() < a.back();
    });
  }

  /// Returns the spin at the end, from classical Runge-Kutta steps, none of which crosses a corner.
  Triple exact() const {
    auto m = start;
    auto const all = corners();
    for (std::size_t i = 0; i + 1 < all.size(); ++i) {
      double const begin = all[i], length = all[i + 1] - begin;
      auto const steps = static_cast<std::int64_t>(std::ceil(length / longest_step(begin, length)));
      double const dt = length / static_cast<double>(steps);
      // At a jump of H, use the value on this interval's side.
      double const aside = 1e-4 * dt;
      for (std::int64_t n = 0; n < steps; ++n) {
        double const t = begin + static_cast<double>(n) * dt;
        auto const at = [&](double c) {
          return field(std::clamp(t + c * dt, begin + aside * (n == 0), all[i + 1] - aside));
        };
        auto const first = at(0), middle = at(0.5), last = at(1);
        auto const k1 = rate(m, first), k2 = rate(moved(m, 0.5 * dt, k1), middle);
        auto const k3 = rate(moved(m, 0.5 * dt, k2), middle), k4 = rate(moved(m, dt, k3), last);
        for (std::size_t c = 0; c < 3; ++c)
          m[c] += dt / 6 * (k1[c] + 2 * k2[c] + 2 * k3[c] + k4[c]);
      }
    }
    return m;
  }

 private:
  /// Returns true if a pulse of the shape rises and falls within the run. The shortest pulses of a
  /// sinc are its side lobes; the one after the main lobe has to be within the run.
  bool is_within(TimeShape const& shape) const {
    if (shape.kind == TimeShape::step) return false;
    if (shape.kind == TimeShape::sinc) return shape.middle + 5 * shape.width < end;
    return shape.middle > shape.width && shape.last() + shape.width < end;
  }
  double between(double a, double b) {
    return a + (b - a) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }
  int below(int count) { return static_cast<int>(between(0, count)); }

  TimeShape shape() {
    auto const kind = static_cast<TimeShape::Kind>(below(TimeShape::kinds));
    double width = end * std::pow(10.0, between(-6, 0));
    double const angle = std::pow(10.0, between(-1, 0.5));
    int pulses = 1;
    if (kind == TimeShape::train) {
      pulses = 2 + below(8);
      width = std::min(width, end / (5.0 * pulses));
    }
    double const height = kind == TimeShape::step ? between(0.2, 1.5)
                                                  : std::min(angle / width, 1e5) + between(0, 0.5);
    double const middle = between(0, end - 5 * width * (pulses - 1));
    return {kind, height, middle, width, pulses};
  }

  std::vector<double> corners() const {
    std::vector<double> all{0, end};
    for (auto const& shapes : shapes_)
      for (auto const& shape : shapes)
        for (double const t : shape.corners())
          if (t > 0 && t < end) all.push_back(t);
    std::ranges::sort(all);
    return all;
  }

  double longest_step(double begin, double length) const {
    double longest = std::min(length / 50, 0.01);
    double const middle = begin + 0.5 * length;
    for (auto const& shapes : shapes_)
      for (auto const& shape : shapes) {
        auto const corners = shape.corners();
        if (middle < corners.front() || middle > corners.back()) continue;
        longest = std::min(longest, 0.02 / std::abs(shape.height));
        if (shape.is_smooth()) longest = std::min(longest, shape.width / 40);
      }
    return longest;
  }

  static double dot(Triple const& a, Triple const& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  }
  static Triple moved(Triple m, double dt, Triple const& rate) {
    for (std::size_t c = 0; c < 3; ++c) m[c] += dt * rate[c];
    return m;
  }
  // Returns H x m + damping * (m x H) x m.
  Triple rate(Triple const& m, Triple const& h) const {
    Triple const turn{h[1] * m[2] - h[2] * m[1], h[2] * m[0] - h[0] * m[2],
                      h[0] * m[1] - h[1] * m[0]};
    double const along = dot(m, h), square = dot(m, m);
    Triple all;
    for (std::size_t c = 0; c < 3; ++c) all[c] = turn[c] + damping * (square * h[c] - along * m[c]);
    return all;
  }

  std::mt19937_64 engine_;
  std::array<std::vector<TimeShape>, 3> shapes_;
};

}  // namespace cayspin::test
