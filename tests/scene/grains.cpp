// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The functions grain and random of expressions.
#include "io/scene.hpp"
#include "scene/random_bits.hpp"
#include "scene_file.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace cayspin::inline v0_2::io::test {
namespace {

Scene with_lattice(std::string const& lattice) {
  return scene_of(replaced(plain_scene, "shape = [4, 3, 2]", lattice));
}

std::vector<double> values(Scene const& scene, std::string const& expression, SiteBox const& box) {
  SiteNumbers numbers;
  numbers.expression = expression;
  return numbers_of_sites(scene, numbers, "values", box);
}
std::vector<double> values(Scene const& scene, std::string const& expression) {
  return values(scene, expression, whole(scene));
}

/// Finds grains by brute force: each tile has one seed at a random place, and a point belongs to
/// the nearest of all seeds and their images.
class NearestOfAll {
 public:
  NearestOfAll(Scene const& scene, std::array<int, 3> tiles, std::uint64_t seed)
      : lattice_(scene.lattice), tiles_(tiles) {
    auto const start = detail::random_bits(seed, 0);
    std::array<int, 3> images;
    for (std::size_t axis = 0; axis < 3; ++axis)
      images[axis] = lattice_.boundary[axis] == BoundaryKind::periodic && tiles[axis] > 1 ? 4 : 0;
    for (int a = -images[0]; a <= images[0]; ++a)
      for (int b = -images[1]; b <= images[1]; ++b)
        for (int c = -images[2]; c <= images[2]; ++c)
          for (int grain = 0; grain < tiles[0] * tiles[1] * tiles[2]; ++grain) {
            std::array<int, 3> const tile{grain % tiles[0], grain / tiles[0] % tiles[1],
                                          grain / tiles[0] / tiles[1]};
            std::array<int, 3> const image{a, b, c};
            Triple at{};
            for (std::size_t axis = 0; axis < 3; ++axis)
              at[axis] = image[axis] +
                         (tile[axis] + detail::random_number(
                                           start, 3 * static_cast<std::uint64_t>(grain) + axis)) /
                             tiles[axis];
            seeds_.push_back({grain, at});
          }
  }

  int at(Triple const& point) const {
    auto const nearest = std::ranges::min_element(
        seeds_, {}, [&](auto const& seed) { return distance(seed.second, point); });
    return nearest->first;
  }

 private:
  // Distances do not count along an axis with one tile.
  double distance(Triple const& a, Triple const& b) const {
    auto const sites = static_cast<std::int64_t>(lattice_.basis.size());
    Triple away{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (tiles_[axis] == 1) continue;
      auto const cells = static_cast<double>(lattice_.shape[axis] / (axis == 2 ? sites : 1));
      for (std::size_t c = 0; c < 3; ++c)
        away[c] += (a[axis] - b[axis]) * cells * lattice_.cell[axis][c] * lattice_.spacing[c];
    }
    return std::hypot(away[0], away[1], away[2]);
  }

  Lattice const& lattice_;
  std::array<int, 3> tiles_;
  std::vector<std::pair<int, Triple>> seeds_;
};

struct GrainsOf {
  char const *name, *lattice, *function;
  std::array<int, 3> tiles;
};

GrainsOf const all_grains[] = {
    {"film",
     "shape = [60, 48]\nspacing = [0.5, 1]\nboundary = ['periodic', 'open']",
     "grain(6, 3)",
     {5, 8, 1}},
    {"columns", "shape = [24, 20, 4]\nboundary = 'periodic'", "grain(5, 0)", {5, 4, 1}},
    {"chain of columns", "shape = [30, 4]\nboundary = 'periodic'", "grain(4, 8)", {8, 1, 1}},
    {"volume",
     "shape = [14, 12, 9]\nboundary = ['periodic', 'open', 'periodic']",
     "grain(4, 9)",
     {4, 3, 2}},
    {"honeycomb",
     "shape = [24, 18]\ncrystal = 'honeycomb'\nboundary = 'periodic'",
     "grain(4, 1)",
     {6, 5, 1}},
    {"skewed",
     "shape = [20, 20]\ncell = [[1, 0, 0], [3, 1, 0], [0, 0, 1]]\nboundary = 'periodic'",
     "grain(7, 2)",
     {3, 9, 1}},
    {"two tiles", "shape = [8, 9]\nboundary = 'periodic'", "grain(4, 4)", {2, 2, 1}},
    {"single grain", "shape = [8, 9]", "grain(50, 4)", {1, 1, 1}}};

TEST(Grains, AreThoseOfTheNearestSeed) {
  for (auto const& [name, lattice, function, tiles] : all_grains) {
    SCOPED_TRACE(name);
    auto const scene = with_lattice(lattice);
    auto const seed = static_cast<std::uint64_t>(function[std::string(function).size() - 2] - '0');
    NearestOfAll const nearest(scene, tiles, seed);
    auto const found = values(scene, function), x = values(scene, "x"), y = values(scene, "y"),
               z = values(scene, "z");
    std::size_t wrong = 0;
    for (std::size_t site = 0; site < found.size(); ++site)
      wrong += found[site] != nearest.at({x[site], y[site], z[site]});
    EXPECT_EQ(wrong, 0U);
    // If a tile has dozens of sites, every grain has some.
    auto const count = static_cast<std::size_t>(tiles[0] * tiles[1] * tiles[2]);
    if (found.size() > 50 * count) {
      EXPECT_EQ(std::set<double>(found.begin(), found.end()).size(), count);
    }
  }
}

TEST(Grains, AreTheSameInAnyPart) {
  auto const scene = with_lattice("shape = [14, 12, 9]\ncrystal = 'bcc'");
  auto const text = "grain(3, 1) + random(grain(3, 1), 7)";
  SiteBox const part{{3, 2, 5}, {7, 4, 6}};
  EXPECT_EQ(values(scene, text, part),
            numbers_in(part, scene.lattice.shape, 1, values(scene, text)));
}

TEST(Grains, OfAFilmInMetresHaveTheirSizeInMetres) {
  auto const reduced = with_lattice("shape = [32, 16]\nspacing = 2");
  auto scene = reduced;
  scene.units.si = true;
  scene.units.length = 1e-9;
  EXPECT_EQ(values(scene, "grain(8e-9, 3)"), values(reduced, "grain(8, 3)"));
}

TEST(RandomNumbers, AreUniformAndOfOneGrain) {
  auto const scene = with_lattice("shape = [200, 100]");
  auto const grains = values(scene, "grain(10, 1)"),
             first = values(scene, "random(grain(10, 1), 1)"),
             other = values(scene, "random(grain(10, 1), 2)");
  std::vector<double> of_grain(200, -1);
  for (std::size_t site = 0; site < grains.size(); ++site) {
    auto& known = of_grain.at(static_cast<std::size_t>(grains[site]));
    if (known < 0) known = first[site];
    EXPECT_EQ(first[site], known);
    EXPECT_NE(first[site], other[site]);
  }
  EXPECT_EQ(std::set<double>(of_grain.begin(), of_grain.end()).size(), 200U);
  auto const noise = values(scene, "random(i + 200*j, 5)"),
             more = values(scene, "random(i + 200*j, 6)");
  double mean = 0, square = 0, product = 0;
  for (std::size_t site = 0; site < noise.size(); ++site) {
    EXPECT_GE(noise[site], 0);
    EXPECT_LT(noise[site], 1);
    mean += noise[site] / 20000;
    square += noise[site] * noise[site] / 20000;
    product += noise[site] * more[site] / 20000;
  }
  // The limits are four standard errors.
  EXPECT_NEAR(mean, 0.5, 4 / std::sqrt(12 * 20000.0));
  EXPECT_NEAR(square, 1 / 3.0, 4 * std::sqrt(4 / 45.0 / 20000));
  EXPECT_NEAR(product, 0.25, 4 * std::sqrt((1 / 9.0 - 1 / 16.0) / 20000));
  EXPECT_EQ(values(scene, "random(0, 1) == random(-0, 1)")[0], 1);
}

TEST(Grains, ThatAreWrongAreRefusedInOneLine) {
  for (auto const& [text, what] :
       {std::pair{"grain(0, 1)", "grain of size 0; accepted: a size > 0"},
        {"grain(-i, 1)", "grain of size -0; accepted: a size > 0"},
        {"grain(1/0, 1)", "grain of size inf; accepted: a size > 0"},
        {"grain(1e-15, 1)", "more than 2^53 grains; accepted: a larger size"},
        {"grain(3, -1)", "grain of seed -1; accepted: a whole number >= 0"},
        {"grain(3, 1.5)", "grain of seed 1.5; accepted: a whole number >= 0"},
        {"random(1, 0.5)", "random of seed 0.5; accepted: a whole number >= 0"},
        {"random(1/0, 1)", "random of a number that is not finite"},
        {"grain(3)", "Too few parameters"},
        {"grain(3, 1, 2)", "Too many parameters"}}) {
    SCOPED_TRACE(text);
    auto const message = refusal([&] {
      auto const scene = with_lattice("shape = [40, 30]\noccupied = '" + std::string(text) + "'");
      check_files(scene);
      occupied(scene, whole(scene));
    });
    EXPECT_TRUE(message.starts_with("scene.toml:6: lattice.occupied: expression \"")) << message;
    expect_holds(message, what);
  }
}

}  // namespace
}  // namespace cayspin::inline v0_2::io::test
