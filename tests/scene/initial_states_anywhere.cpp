// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The named values of initial.state: in SI, in crystals and in parts of a lattice.
#include "initial_states.hpp"

#include <array>

namespace cayspin::inline v0_2::io::test {
namespace {

constexpr std::array<std::string_view, 5> states = {
    "state='vortex', radius=2.5", "state='neel_skyrmion', radius=2, width=1, center=[0.4, 0.3]",
    "state='bloch_skyrmion'",
    "state='two_domains', directions=[[0, 0, 1], [0, 0, -1]], wall=[1, 0, 0], width=0.7",
    "state='helix', period=7, direction=[1, 2, 3]"};

std::string initial_of(std::string_view keys) { return fmt::format("initial={{{}}}", keys); }

TEST(InitialStates, AreTheSameInPartsOfALattice) {
  for (auto const keys : states)
    for (std::string const lattice :
         {"lattice={shape=[6, 5, 4], spacing=[1, 0.5, 2], boundary='periodic'}",
          "lattice={shape=[6, 5, 2], crystal='bcc'}"}) {
      auto const scene = scene_of(plain_scene, {lattice, initial_of(keys)});
      auto const all = initial_spins(scene);
      for (SiteBox const part : {SiteBox{{1, 2, 1}, {3, 2, 2}}, SiteBox{{0, 0, 3}, {6, 5, 1}},
                                 SiteBox{{5, 4, 0}, {1, 1, 4}}, SiteBox{{0, 0, 2}, {6, 5, 0}}})
        EXPECT_EQ(initial_spins(scene, part), numbers_in(part, scene.lattice.shape, 3, all))
            << keys;
    }
}

// A honeycomb has skew cells of two sites: cell (i, j) is at i * a + j * b, and its second site is
// displaced by (a + b) / 3 from there.
TEST(InitialStates, SeeWhereTheSitesOfACrystalAre) {
  std::string const lattice = "lattice={shape=[9, 7], crystal='honeycomb', spacing=0.5}";
  auto const spins_of = [&](std::string_view keys) {
    return initial_spins(scene_of(plain_scene, {lattice, initial_of(keys)}));
  };
  auto const cells = crystal(scene_of(plain_scene, {lattice}).lattice);
  auto const place = [&](double x, double y) {
    Triple at{};
    for (std::size_t c = 0; c < 3; ++c) at[c] = 0.5 * (x * cells.cell[0][c] + y * cells.cell[1][c]);
    return at;
  };
  auto const vortex = spins_of("state='vortex', radius=1, center=[0.3, 0.6]");
  auto const helix = spins_of("state='helix', period=1.7, direction=[0, 1, 0]");
  auto const walls = spins_of(
      "state='two_domains', directions=[[0, 0, 1], [0, 0, -1]], wall=[1, 0, 0], width=0.4");
  auto const core = place(0.3 * 9, 0.6 * 7), middle = place(0.5 * 9, 0.5 * 7);
  std::size_t site = 0;
  for (int s = 0; s < 2; ++s)
    for (int j = 0; j < 7; ++j)
      for (int i = 0; i < 9; ++i, site += 3) {
        auto const spin = [&](std::vector<double> const& spins) {
          return Triple{spins[site], spins[site + 1], spins[site + 2]};
        };
        auto const at = place(i + s / 3.0, j + s / 3.0);
        double const x = at[0] - core[0], y = at[1] - core[1], r = std::hypot(x, y);
        double const theta = r < 1 ? 2 * std::atan(r) : std::numbers::pi / 2;
        expect_near(spin(vortex),
                    {-std::sin(theta) * y / r, std::sin(theta) * x / r, std::cos(theta)});
        double const angle = 2 * std::numbers::pi * at[1] / 1.7;
        expect_near(spin(helix), {std::sin(angle), 0, std::cos(angle)});
        double const u = (at[0] - middle[0]) / 0.4;
        expect_near(spin(walls), {1 / std::cosh(u), 0, -std::tanh(u)});
      }
}

constexpr std::string_view permalloy_film = R"toml(units = "SI"
[material]
Ms = 8e5
A = 1.3e-11
alpha = 0
[system]
kind = "llg"
[lattice]
shape = [12, 10, 2]
spacing = [4e-9, 4e-9, 3e-9]
[initial]
uniform = [0, 0, 1]
[integrator]
method = "rkmk4"
dt = 1e-14
steps = 10
)toml";

constexpr std::string_view atoms = R"toml(units = "SI"
[material]
mu_s = { bohr_magnetons = 2 }
J = 1e-21
alpha = 0
[system]
kind = "llg"
[lattice]
shape = [12, 10, 2]
spacing = 2.5e-10
[initial]
uniform = [0, 0, 1]
[integrator]
method = "rkmk4"
dt = 1e-16
steps = 10
)toml";

TEST(InitialStates, TakeLengthsInMetresInSi) {
  struct Keys {
    std::string_view text, length, width;
  };
  auto const typed = [](Keys const& keys, double unit) {
    std::string text(keys.text);
    if (!keys.length.empty()) text += fmt::format(", {}={}", keys.length, 2.75 * unit);
    if (!keys.width.empty()) text += fmt::format(", {}={}", keys.width, 1.25 * unit);
    return initial_of(text);
  };
  for (auto const& [text, unit, spacing] :
       {std::tuple{permalloy_film, 4e-9, "[1, 1, 0.75]"}, std::tuple{atoms, 2.5e-10, "[1, 1, 1]"}})
    for (Keys const& keys :
         {Keys{"state='vortex'", "radius", ""}, Keys{"state='vortex'", "", ""},
          Keys{"state='neel_skyrmion'", "radius", "width"},
          Keys{"state='bloch_skyrmion'", "", "width"}, Keys{"state='bloch_skyrmion'", "", ""},
          Keys{"state='two_domains', directions=[[1, 0, 0], [0, 1, 0]]", "width", ""},
          Keys{"state='two_domains', axis='z', directions=[[1, 0, 0], [0, 1, 0]]", "", ""},
          Keys{"state='helix', direction=[1, 0, 2]", "period", ""}}) {
      auto const si = initial_spins(scene_of(text, {typed(keys, unit)}));
      auto const reduced = initial_spins(scene_of(
          plain_scene,
          {fmt::format("lattice={{shape=[12, 10, 2], spacing={}}}", spacing), typed(keys, 1)}));
      ASSERT_EQ(si.size(), reduced.size());
      for (std::size_t n = 0; n < si.size(); ++n)
        EXPECT_NEAR(si[n], reduced[n], 2e-14) << keys.text;
    }
}

// with_overrides() reads the scene's text again. The state stays the same unless an override
// changes it.
TEST(InitialStates, SurviveOverrides) {
  auto const scene = scene_of(permalloy_film, {"initial={state='vortex', radius=9e-9}"});
  EXPECT_EQ(initial_spins(with_overrides(scene, {"integrator.dt=1e-15"})), initial_spins(scene));
  auto const changed = with_overrides(scene, {"initial.radius=12e-9", "initial.polarity=-1"});
  EXPECT_NEAR(std::get<VortexState>(std::get<InitialState>(changed.initial)).radius, 3, 1e-15);
}

}  // namespace
}  // namespace cayspin::inline v0_2::io::test
