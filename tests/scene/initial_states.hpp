// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "scene_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace cayspin::inline v0_2::io::test {

inline void expect_near(Triple const& m, Triple const& expected, double tolerance = 2e-14) {
  for (std::size_t c = 0; c < 3; ++c)
    EXPECT_NEAR(m[c], expected[c], tolerance) << fmt::format(
        "({}, {}, {}), not ({}, {}, {})", m[0], m[1], m[2], expected[0], expected[1], expected[2]);
}

/// The initial spins of a scene with box-shaped cells.
struct InitialSpins {
  Lattice lattice;
  std::vector<double> spins;

  Triple at(std::int64_t i, std::int64_t j, std::int64_t k = 0) const {
    auto const& shape = lattice.shape;
    auto const* const m =
        &spins.at(static_cast<std::size_t>(3 * ((k * shape[1] + j) * shape[0] + i)));
    return {m[0], m[1], m[2]};
  }

  /// Calls test(position, spin).
  template <class Test>
  void for_each(Test const& test) const {
    auto const& [nx, ny, nz] = lattice.shape;
    auto const& [dx, dy, dz] = lattice.spacing;
    for (std::int64_t k = 0; k < nz; ++k)
      for (std::int64_t j = 0; j < ny; ++j)
        for (std::int64_t i = 0; i < nx; ++i)
          test(Triple{(static_cast<double>(i) + 0.5) * dx, (static_cast<double>(j) + 0.5) * dy,
                      (static_cast<double>(k) + 0.5) * dz},
               at(i, j, k));
  }

  /// Returns the topological charge of the plane k = 0 with periodic boundaries: the sum of the
  /// solid angles of its triangles, divided by 4 pi (Berg and Luescher 1981).
  double charge() const {
    auto const& [nx, ny, nz] = lattice.shape;
    double angle = 0;
    for (std::int64_t j = 0; j < ny; ++j)
      for (std::int64_t i = 0; i < nx; ++i) {
        auto const right = (i + 1) % nx, up = (j + 1) % ny;
        angle += solid_angle(at(i, j), at(right, j), at(right, up));
        angle += solid_angle(at(i, j), at(right, up), at(i, up));
      }
    return angle / (4 * std::numbers::pi);
  }

 private:
  static double dot(Triple const& a, Triple const& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  }
  static double solid_angle(Triple const& a, Triple const& b, Triple const& c) {
    Triple const across{b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2],
                        b[0] * c[1] - b[1] * c[0]};
    return 2 * std::atan2(dot(a, across), 1 + dot(a, b) + dot(b, c) + dot(c, a));
  }
};

/// Returns the initial spins for these keys of [initial], by default on a small lattice.
inline InitialSpins state_of(std::string const& keys,
                             std::vector<std::string> overrides = {"lattice={shape=[6, 5, 4]}"}) {
  overrides.push_back("initial={" + keys + "}");
  auto const scene = scene_of(plain_scene, overrides);
  return {scene.lattice, initial_spins(scene)};
}

}  // namespace cayspin::inline v0_2::io::test
