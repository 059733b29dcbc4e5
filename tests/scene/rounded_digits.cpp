// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Vectors typed with a few digits.
#include "scene_file.hpp"

#include <cayspin/shells.hpp>

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <random>

namespace cayspin::inline v0_2::io::test {
namespace {

std::string const single = R"toml([system]
kind = "llg"
damping = 0.1
[lattice]
shape = [3]
[field]
[initial]
uniform = [0, 0, 1]
[integrator]
method = "heun"
dt = 0.1
steps = 1
)toml";

std::string typed(Triple const& v, int digits) {
  return fmt::format("[{:.{}f},{:.{}f},{:.{}f}]", v[0], digits, v[1], digits, v[2], digits);
}

TEST(RoundedDigits, OfCubicAxesAreTaken) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  EXPECT_EQ(refusal([&] {
              scene_of(single, {"field.anisotropy={cubic=1,axes=[[0.577350,0.577350,0.577350],"
                                "[0.408248,0.408248,-0.816497]]}"});
            }),
            "accepted");
  for (int round = 0; round < 200; ++round) {
    Triple const a{normal(random), normal(random), normal(random)};
    Triple const other{normal(random), normal(random), normal(random)};
    auto const unit = [](Triple v) {
      double const length = std::hypot(v[0], v[1], v[2]);
      for (double& x : v) x /= length;
      return v;
    };
    auto const first = unit(a), second = unit(detail::vector_product(a, other));
    int const digits = 5 + round % 5;
    EXPECT_EQ(refusal([&] {
                scene_of(single, {"field.anisotropy={cubic=1,axes=[" + typed(first, digits) + "," +
                                  typed(second, digits) + "]}"});
              }),
              "accepted");
  }
  auto const said =
      refusal([&] { scene_of(single, {"field.anisotropy={cubic=1,axes=[[1,0,0],[0.001,1,0]]}"}); });
  EXPECT_NE(said.find("not at right angles, by 0.001"), said.npos) << said;
  EXPECT_NE(said.find("to 1e-4"), said.npos) << said;
}

TEST(RoundedDigits, OfAxesAreMadeOrthogonal) {
  Triple const first{0, 0.6, 0.8}, second{0, 0.8, -0.6};
  for (auto const* const in_plane :
       {"[0,0.80003,-0.59996]", "['0','0.8 + 2e-5*i','3e-5*i - 0.6']"}) {
    auto const scene = scene_of(
        single,
        {std::string("field.anisotropy={hexagonal=1,axis=[0,0.6,0.8],in_plane=") + in_plane + "}"});
    auto const axes = crystal_axes(scene, scene.field.crystal_anisotropies.at(0), whole(scene));
    ASSERT_EQ(axes[0].size(), axes[1].size()) << in_plane;
    for (std::size_t i = 0; i < axes[0].size(); ++i) {
      EXPECT_NEAR(axes[0][i], first[i % 3], 4e-15) << in_plane;
      EXPECT_NEAR(axes[1][i], second[i % 3], 4e-15) << in_plane;
    }
  }
}

// Rounded vectors of a cell give the same bonds as exact ones.
TEST(RoundedDigits, OfACellKeepItsShells) {
  double const s = std::sqrt(0.75);
  struct Cell {
    std::array<Triple, 3> vectors;
    std::vector<Triple> basis;
  };
  std::vector<double> const exchange{1, 2, 3, 4};
  for (auto const& [vectors, basis] : std::vector<Cell>{
           {{{{1, 0, 0}, {0.5, s, 0}, {0, 0, std::sqrt(8. / 3)}}},
            {{0, 0, 0}, {1. / 3, 1. / 3, 0.5}}},
           {{{{1, 0, 0}, {-0.5, s, 0}, {0, 0, 1.3}}}, {{0, 0, 0}}},
           {{{{1, 1, 0}, {0, 1, 1}, {1, 0, 1}}}, {{0, 0, 0}}},
           {{{{1, 0, 0}, {0.5, s, 0}, {0, 0, 1}}}, {{0, 0, 0}, {0.5, 0, 0}, {0, 0.5, 0}}}}) {
    auto const expected = couplings_of_shells(Crystal{vectors, basis}, exchange);
    for (int const digits : {5, 6, 7, 9, 12}) {
      std::string cell, sites;
      for (auto const& v : vectors) cell += typed(v, digits) + ",";
      for (auto const& v : basis) sites += typed(v, digits) + ",";
      auto const scene = scene_of(single, {"lattice={shape=[9,9,9],boundary='periodic',cell=[" +
                                               cell + "],basis=[" + sites + "]}",
                                           "field.couplings={shells=[1,2,3,4]}"});
      auto const& found = scene.field.couplings;
      ASSERT_EQ(found.size(), expected.size()) << digits;
      std::array<int, 5> of_strength{};
      for (std::size_t i = 0; i < found.size(); ++i) {
        ++of_strength[static_cast<std::size_t>(found[i].tensor[0])];
        --of_strength[static_cast<std::size_t>(expected[i].tensor[0])];
      }
      EXPECT_EQ(of_strength, (std::array<int, 5>{})) << digits;
    }
  }
}

}  // namespace
}  // namespace cayspin::inline v0_2::io::test
