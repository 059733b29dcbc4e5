// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/coupling.hpp>
#include <cayspin/lattice.hpp>
#include <cayspin/vec3.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace cayspin::simulation::test {

/// The constants of a composition's terms, 0 for terms that are missing. Vectors of numbers have an
/// element for each site, or are empty.
struct CompositionNumbers {
  Lattice lattice;
  double exchange = 0, interfacial = 0, bulk = 0, cubic = 0, moment = 1, gyromagnetic = 1;
  double cubic2 = 0, hexagonal = 0, slab = 0;
  double exchange_in_time = 0, anisotropy_in_time = 0, dmi_in_time = 0;  // a in 1 + a * sin(5*t)
  double constant[2] = {}, damping_like = 0, field_like = 0, nonadiabaticity = 0, damping = 0;
  Vec3<double> axis[2] = {{0, 0, 1}, {0, 0, 1}}, axis_of_sites{0, 0, 1}, normal_of_slab{0, 0, 1},
               applied{0, 0, 0}, velocity{0, 0, 0};
  std::vector<double> exchange_of_sites, constant_of_sites, occupied, frozen, damping_of_sites;
  std::vector<double> moment_of_sites, source_of_sites;  // source along x
  double source_along_y = 0, largest_moment = 1;
  std::vector<double> gyromagnetic_of_sites, damping_like_of_sites;
  double largest_gyromagnetic = 1, lambda = 1;
  double along_x = 0;  // polarization along (along_x * i, 0.6, 0.8)
  std::vector<Coupling> couplings, d2d;
  double scale = 0;  // bound on |H| times the gyromagnetic ratio
};

/// A random composition of terms, shape and site-dependent values, both as the text of a scene and
/// as numbers.
class Composition {
 public:
  explicit Composition(unsigned seed) : engine_(seed) {
    choose_lattice(seed);
    choose_bonds();
    choose_anisotropies();
    choose_slab(seed);
    choose_applied();
    choose_torques();
    choose_damping();
    text = fmt::format("{}[lattice]\n{}[field]\n{}{}[initial]\nrandom = {{ seed = {} }}\n", system_,
                       lattice_, field_, torques_, seed);
  }

  CompositionNumbers numbers;
  std::string text;  // without [integrator]

  bool chance(double probability) { return uniform(0, 1) < probability; }
  template <class List>
  auto const& one_of(List const& list) {
    return list[engine_() % std::size(list)];
  }

 private:
  double uniform(double least, double most) { return least + (most - least) * engine_() * 0x1p-32; }
  /// Returns a number rounded to four decimal places, like the numbers in the scene's text.
  double number(double least, double most) { return std::round(1e4 * uniform(least, most)) / 1e4; }
  Vec3<double> vector(double size) {
    return {number(-size, size), number(-size, size), number(0.1 * size, size)};
  }
  static std::string text_of(Vec3<double> const& v) {
    return fmt::format("[{:.4f}, {:.4f}, {:.4f}]", v.x, v.y, v.z);
  }
  /// Returns a + b * i for each site.
  std::vector<double> linear_along_x(double a, double b) const {
    std::vector<double> values(static_cast<std::size_t>(numbers.lattice.sites()));
    for (std::size_t site = 0; site < values.size(); ++site)
      values[site] =
          a + b * static_cast<double>(static_cast<std::int64_t>(site) % numbers.lattice.shape[0]);
    return values;
  }
  static std::string text_of(double a, double b) {
    return fmt::format("'{:.4f} + {:.4f}*i'", a, b);
  }

  void choose_lattice(unsigned seed) {
    static constexpr std::int64_t extents[] = {1, 2, 3, 5, 8, 16, 19};
    auto& shape = numbers.lattice.shape;
    shape = {one_of(extents), one_of(extents), one_of(extents)};
    if (chance(0.1)) shape = {one_of(std::to_array<std::int64_t>({256, 271, 600})), 3, 2};
    if (seed % 97 == 5) shape = {70, 50, 30};  // exceeds the caches, so steps are sweeps
    if (shape[0] * shape[1] * shape[2] == 1) shape[0] = 7;
    auto const open = [&] { return chance(0.5); };
    for (auto& boundary : numbers.lattice.boundary)
      boundary = open() ? Boundary::open : Boundary::periodic;
    for (auto& spacing : numbers.lattice.spacing) spacing = chance(0.3) ? number(0.7, 1.3) : 1;
    auto const word = [&](std::size_t axis) {
      return numbers.lattice.boundary[axis] == Boundary::open ? "open" : "periodic";
    };
    lattice_ = fmt::format(
        "shape = [{}, {}, {}]\nspacing = [{}, {}, {}]\nboundary = ['{}', '{}', '{}']\n", shape[0],
        shape[1], shape[2], numbers.lattice.spacing[0], numbers.lattice.spacing[1],
        numbers.lattice.spacing[2], word(0), word(1), word(2));
    if (chance(0.3)) {
      numbers.moment = numbers.largest_moment = number(0.5, 2);
      numbers.gyromagnetic = number(0.5, 2);
      lattice_ += fmt::format("moments = [{}]\ngyromagnetic = [{}]\n", numbers.moment,
                              numbers.gyromagnetic);
    } else if (chance(0.25)) {
      double const slope = number(0, 0.1);
      numbers.moment = number(0.5, 1.5);
      numbers.moment_of_sites = linear_along_x(numbers.moment, slope);
      numbers.largest_moment = numbers.moment + 600 * slope;
      bool const has_holes = chance(0.3) && shape[0] > 2;
      for (std::size_t i = 1; has_holes && i < numbers.moment_of_sites.size();
           i += static_cast<std::size_t>(shape[0]))
        numbers.moment_of_sites[i] = 0;
      lattice_ += fmt::format("moments = '{}{:.4f} + {:.4f}*i'\n", has_holes ? "i == 1 ? 0 : " : "",
                              numbers.moment, slope);
    }
    if (numbers.gyromagnetic == 1 && chance(0.2)) {
      double const ratio = number(0.5, 2), slope = number(0, 0.01);
      numbers.gyromagnetic_of_sites = linear_along_x(ratio, slope);
      numbers.largest_gyromagnetic = ratio + 600 * slope;
      lattice_ += "gyromagnetic = " + text_of(ratio, slope) + "\n";
    }
    if (chance(0.35)) {
      auto const at = number(0.1, 0.9);
      lattice_ += fmt::format("occupied = 'random(i+{0}*j+{1}*k, 3) > {2:.4f} || i == 0'\n",
                              shape[0], shape[0] * shape[1], at);
    }
    if (chance(0.2)) lattice_ += "frozen = 'j == 0'\n";
  }

  void choose_bonds() {
    double square = 0, first = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (numbers.lattice.shape[axis] == 1) continue;
      square += 4 / (numbers.lattice.spacing[axis] * numbers.lattice.spacing[axis]);
      first += 2 / numbers.lattice.spacing[axis];
    }
    if (double const A = number(0.2, 1.5); chance(0.2)) {
      double const slope = number(0, 0.05);
      numbers.exchange_of_sites = linear_along_x(A, slope);
      numbers.scale += square * (A + 600 * slope);
      field_ += "exchange = " + text_of(A, slope) + "\n";
    } else if (chance(0.8)) {
      numbers.exchange = A;
      numbers.scale += square * A;
      field_ += fmt::format("exchange = {:.4f}\n", A);
    }
    double const D = number(-0.5, 0.5);
    if (chance(0.25)) {
      numbers.bulk = D;
      field_ += fmt::format("dmi = {{ bulk = {:.4f} }}\n", D);
    } else if (chance(0.3)) {
      numbers.interfacial = D;
      field_ += fmt::format("dmi = {{ interfacial = {:.4f}, normal = [0, 0, 1] }}\n", D);
    } else if (chance(0.3)) {
      for (std::size_t axis = 0; axis < 2; ++axis) {
        if (numbers.lattice.shape[axis] == 1) continue;
        std::array<int, 3> offset{};
        std::array<double, 3> of_bond{};
        offset[axis] = 1;
        of_bond[axis] = (axis == 0 ? -D : D) / numbers.lattice.spacing[axis];
        numbers.d2d.push_back(Coupling::of({0, 0}, offset, 0, of_bond));
      }
      field_ += fmt::format("dmi = {{ d2d = {:.4f} }}\n", D);
    }
    numbers.scale += first * std::abs(D);
    if (chance(0.2)) {
      double const J = number(-0.5, 0.5), B = chance(0.3) ? number(-0.2, 0.2) : 0;
      std::array<double, 3> const D_of_pair{0, 0, number(-0.3, 0.3)};
      std::array<int, 3> offset{};
      for (std::size_t axis = 0; axis < 3; ++axis)
        if (numbers.lattice.shape[axis] > 3) offset[axis] = static_cast<int>(engine_() % 3) - 1;
      if (offset == std::array{0, 0, 0}) return;
      numbers.couplings.push_back(Coupling::of({0, 0}, offset, J, D_of_pair));
      numbers.couplings[0].biquadratic = B;
      numbers.scale += 2 * (std::abs(J) + 2 * std::abs(B) + std::abs(D_of_pair[2]));
      field_ += fmt::format(
          "couplings = [{{ offset = [{}, {}, {}], J = {:.4f}, D = [0, 0, {:.4f}], biquadratic = "
          "{:.4f} }}]\n",
          offset[0], offset[1], offset[2], J, D_of_pair[2], B);
    }
  }

  void choose_anisotropies() {
    std::string axes;
    for (int i = 0; i < 2; ++i) {
      if (!chance(0.4)) continue;
      numbers.constant[i] = number(-1, 1);
      numbers.axis[i] = chance(0.5) ? Vec3<double>{0, 0, 1} : vector(1);
      numbers.scale += std::abs(numbers.constant[i]);
      axes += fmt::format("{{ constant = {:.4f}, axis = {} }}, ", numbers.constant[i],
                          text_of(numbers.axis[i]));
    }
    if (chance(0.3)) {
      double const K = number(-1, 1), slope = number(-0.02, 0.02);
      numbers.constant_of_sites = linear_along_x(K, slope);
      numbers.axis_of_sites = vector(1);
      numbers.scale += std::abs(K) + 600 * std::abs(slope);
      axes += fmt::format("{{ constant = {}, axis = {} }}, ", text_of(K, slope),
                          text_of(numbers.axis_of_sites));
    }
    if (chance(0.3)) {
      numbers.cubic = number(-1, 1);
      numbers.scale += 2 * std::abs(numbers.cubic);
      if (chance(0.4)) numbers.cubic2 = number(-3, 3);
      numbers.scale += std::abs(numbers.cubic2);
      axes +=
          fmt::format("{{ cubic = {:.4f}, axes = [[1, 0, 0], [0, 1, 0]]{} }}, ", numbers.cubic,
                      numbers.cubic2 == 0 ? std::string()
                                          : fmt::format(", constant2 = {:.4f}", numbers.cubic2));
    }
    if (chance(0.15)) {
      numbers.hexagonal = number(-0.1, 0.1);
      numbers.scale += 36 * std::abs(numbers.hexagonal);
      axes += fmt::format("{{ hexagonal = {:.4f}, axis = [0, 0, 1], in_plane = [0, 1, 0] }}, ",
                          numbers.hexagonal);
    }
    if (!axes.empty()) field_ += "anisotropy = [" + axes + "]\n";
    choose_factors(!axes.empty());
  }

  /// Draws from an engine of its own, on which the other terms do not depend.
  void choose_slab(unsigned seed) {
    auto const engine_of_others = std::exchange(engine_, std::mt19937(seed + 1'000'000));
    if (chance(0.3)) {
      numbers.slab = number(0.1, 0.8);
      numbers.normal_of_slab = chance(0.5) ? Vec3<double>{0, 0, 1} : vector(1);
      // H is proportional to the moments if they differ. choose_applied divides by one of them.
      auto const& moments = numbers.moment_of_sites;
      double const most = moments.empty() ? 1 : *std::ranges::max_element(moments) * numbers.moment;
      numbers.scale += numbers.slab * most;
      field_ += fmt::format("slab_demag = {{ normal = {}, strength = {:.4f} }}\n",
                            text_of(numbers.normal_of_slab), numbers.slab);
    }
    engine_ = engine_of_others;
  }

  void choose_applied() {
    if (chance(0.6)) {
      numbers.applied = vector(0.5);
      field_ += "applied = " + text_of(numbers.applied) + "\n";
    }
    numbers.scale = numbers.scale / numbers.moment + 1;
    if (chance(0.2)) {
      double const h = number(-0.5, 0.5), slope = number(-0.01, 0.01);
      numbers.source_of_sites = linear_along_x(h, slope);
      numbers.source_along_y = number(-0.5, 0.5);
      numbers.scale += 1 + 600 * std::abs(slope);
      field_ += fmt::format("sources = [{{ profile = [{}, {:.4f}, 0], time = 'cos(3*t)' }}]\n",
                            text_of(h, slope), numbers.source_along_y);
    }
    numbers.scale *= numbers.gyromagnetic * numbers.largest_gyromagnetic;
  }

  /// Chooses how much the constants of the existing terms change in time.
  void choose_factors(bool has_axes) {
    if (!chance(0.25)) return;
    std::string factors;
    auto const choose = [&](bool there, char const* key, double& part) {
      if (!there || !chance(0.6)) return;
      part = number(-0.5, 0.5);
      factors += fmt::format("{} = '1 + {:.4f}*sin(5*t)', ", key, part);
    };
    choose(numbers.exchange != 0 || !numbers.exchange_of_sites.empty(), "exchange",
           numbers.exchange_in_time);
    choose(has_axes, "anisotropy", numbers.anisotropy_in_time);
    choose(field_.find("dmi") != field_.npos, "dmi", numbers.dmi_in_time);
    numbers.scale *= 1.5;
    if (factors.empty()) return;
    factors.resize(factors.size() - 2);  // the comma after the last one
    field_ += "in_time = { " + factors + " }\n";
  }

  void choose_torques() {
    if (chance(0.15)) {
      numbers.velocity = vector(0.5);
      numbers.nonadiabaticity = number(0, 0.2);
      numbers.scale += 3;
      torques_ += fmt::format("[torque.zhang_li]\nvelocity = {}\nnonadiabaticity = {:.4f}\n",
                              text_of(numbers.velocity), numbers.nonadiabaticity);
    }
    if (chance(0.15)) {
      numbers.damping_like = number(-0.4, 0.4);
      numbers.field_like = number(-0.4, 0.4);
      numbers.scale += 1;
      torques_ += fmt::format(
          "[torque.slonczewski]\ndamping_like = {:.4f}\nfield_like = {:.4f}\n"
          "polarization = [0, 0.6, 0.8]\n",
          numbers.damping_like, numbers.field_like);
    } else if (chance(0.15)) {
      double const a = number(-0.4, 0.4), slope = number(-0.001, 0.001);
      numbers.damping_like_of_sites = linear_along_x(a, slope);
      numbers.field_like = number(-0.4, 0.4);
      numbers.lambda = chance(0.7) ? number(1, 1.5) : 1;
      numbers.along_x = number(-0.1, 0.1);
      numbers.scale += 4;
      torques_ += fmt::format(
          "[torque.slonczewski]\ndamping_like = {{ profile = {}, time = 'cos(2*t)' }}\nfield_like = "
          "{:.4f}\nlambda = {:.4f}\npolarization = ['{:.4f}*i', 0.6, 0.8]\n",
          text_of(a, slope), numbers.field_like, numbers.lambda, numbers.along_x);
    }
  }

  void choose_damping() {
    if (chance(0.2)) {
      double const alpha = number(0, 0.3), slope = number(0, 0.001);
      numbers.damping_of_sites = linear_along_x(alpha, slope);
      system_ = "system = { kind = 'llg', damping = " + text_of(alpha, slope) + " }\n";
    } else {
      numbers.damping = chance(0.3) ? 0 : number(0.01, 0.4);
      system_ = fmt::format("system = {{ kind = 'llg', damping = {:.4f} }}\n", numbers.damping);
    }
  }

  std::mt19937 engine_;
  std::string lattice_, field_, system_, torques_;
};

}  // namespace cayspin::simulation::test
