// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "../support/landau_lifshitz.hpp"

#include <array>
#include <cstdint>
#include <ostream>
#include <random>
#include <string>

namespace cayspin::test {

enum class Method { euler, heun, rkmk4, chart, ab2, projected_rk4, midpoint };
inline constexpr std::array<char const*, 7> method_names{
    "euler", "heun (exponential)", "rkmk4", "rk4 in the chart", "ab2", "projected_rk4", "midpoint"};

/// Random numbers that depend only on the seed, not on the standard library.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : engine_(seed) {}

  std::int64_t below(std::int64_t count) { return static_cast<std::int64_t>(unit() * count); }
  bool one_in(int count) { return below(count) == 0; }
  double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  double between(double least, double most) { return least + (most - least) * unit(); }
  double logarithmic(double least, double most) { return least * std::pow(most / least, unit()); }
  Vector direction() {
    double const z = between(-1, 1), angle = between(0, 6.283185307179586);
    double const r = std::sqrt(1 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
  }

 private:
  std::mt19937_64 engine_;
};

/// A random scene, determined by its seed and number.
struct RandomScene {
  std::uint64_t seed;
  std::int64_t number;
  Method method;
  bool single, orthogonal;
  Slab slab;
  /// dt / (stable dt). If the stable dt is 0, infinite or unknown: dt * rate. Without a field: dt.
  double share;
  int steps;
  unsigned start;

  static RandomScene drawn(std::uint64_t seed, std::int64_t number) {
    // Hashed so that adjacent seeds and numbers give unrelated scenes.
    Draw draw((seed + 1) * 0x9e3779b97f4a7c15u + static_cast<std::uint64_t>(number) * 1000003u);
    RandomScene scene{};
    scene.seed = seed;
    scene.number = number;
    scene.method = draw.one_in(4) ? Method::midpoint : Method(draw.below(7));
    scene.single = draw.one_in(2);
    scene.orthogonal = draw.one_in(2);
    Slab& slab = scene.slab;
    slab.lattice = lattice(draw);
    if (!draw.one_in(5)) slab.exchange = draw.logarithmic(0.01, 100) * (draw.one_in(4) ? -1 : 1);
    if (!draw.one_in(3)) slab.anisotropy = draw.between(-2, 2);
    slab.axis = draw.direction();
    if (draw.one_in(2)) slab.demag = draw.logarithmic(0.1, 10);
    if (!draw.one_in(3)) slab.applied = draw.logarithmic(0.01, 10) * draw.direction();
    if (draw.one_in(2)) slab.damping = draw.logarithmic(1e-3, 10);
    slab.precession = slab.damping == 0 || !draw.one_in(6);
    scene.share = draw.logarithmic(0.05, 1);
    scene.steps = static_cast<int>(5 + draw.below(20));
    scene.start = static_cast<unsigned>(draw.below(1 << 30));
    return scene;
  }

  friend std::ostream& operator<<(std::ostream& out, RandomScene const& scene) {
    auto const& [lattice, exchange, anisotropy, axis, demag, applied, damping, precession] =
        scene.slab;
    auto const vector = [](Vector const& v) {
      return std::to_string(v.x) + ' ' + std::to_string(v.y) + ' ' + std::to_string(v.z);
    };
    out << "CAYSPIN_SEED=" << scene.seed << " CAYSPIN_SCENE=" << scene.number << ": "
        << method_names[static_cast<std::size_t>(scene.method)]
        << (scene.single ? ", single" : ", double") << (scene.orthogonal ? ", orthogonal" : "");
    for (int a = 0; a < 3; ++a)
      out << (a == 0 ? ", lattice " : " x ") << lattice.shape[a]
          << (lattice.boundary[a] == Boundary::periodic ? " periodic" : " open") << " of "
          << lattice.spacing[a];
    return out << ", exchange " << exchange << ", anisotropy " << anisotropy << " along "
               << vector(axis) << ", demag " << demag << ", applied " << vector(applied)
               << ", damping " << damping << (precession ? "" : ", overdamped") << ", share "
               << scene.share << ", " << scene.steps << " steps from seed " << scene.start;
  }

 private:
  // One lattice in twelve is large enough to be divided among threads.
  static Lattice lattice(Draw& draw) {
    static constexpr std::array<std::int64_t, 3> large[] = {
        {2053, 1, 1}, {2, 1031, 1}, {53, 41, 1}, {1, 7, 307}, {13, 13, 13}};
    Lattice lattice;
    if (draw.one_in(12))
      lattice.shape = large[draw.below(5)];
    else
      for (int axis = 0, dimensions = int(1 + draw.below(3)); axis < dimensions; ++axis)
        lattice.shape[axis] = 1 + draw.below(9);
    for (int axis = 0; axis < 3; ++axis) {
      lattice.spacing[axis] = draw.between(0.5, 2);
      if (draw.one_in(2)) lattice.boundary[axis] = Boundary::periodic;
    }
    return lattice;
  }
};

}  // namespace cayspin::test
