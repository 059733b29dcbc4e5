// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Scenes of crystals, sublattices, currents and vacancies: closed forms, and the same physics said
// in two ways, by every method that takes it.
#include "simulation/scene_run.hpp"

#include <cayspin/io/method.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

namespace cayspin::simulation::test {
namespace {

constexpr double pi = std::numbers::pi;
constexpr Precision precisions[] = {Precision::double_precision, Precision::single_precision};

double epsilon(Precision precision) {
  return precision == Precision::double_precision ? std::numeric_limits<double>::epsilon()
                                                  : std::numeric_limits<float>::epsilon();
}

io::Scene scene_of(std::string const& text) { return io::parse_scene(text, "scene.toml"); }

std::vector<double> spins_of(SceneRun& run) {
  auto const spins = run.spins();
  if (run.precision() == Precision::double_precision) return packed<double>(spins.vectors);
  auto const single = packed<float>(spins.vectors);
  return {single.begin(), single.end()};
}

std::vector<double> end_of(io::Scene const& scene, Precision precision) {
  auto const run = SceneRun::open(scene, {.precision = precision});
  run->advance(scene.integrator.steps);
  return spins_of(*run);
}

double largest_distance(std::vector<double> const& a, std::vector<double> const& b) {
  EXPECT_EQ(a.size(), b.size());
  double largest = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

/// A cone of spins that turns rigidly: phase(t) is the phase of each spin in i, j, k, s.
struct Cone {
  char const* name;
  std::string scene, phase;
  double frequency;  // of a full transverse part; times cos(0.7)
};

// The lattice and the couplings of a scene.
Cone const cones[] = {
    {"bcc",
     "[lattice]\nshape = [16, 6, 5]\ncrystal = 'bcc'\nboundary = 'periodic'\n"
     "[field]\ncouplings = { shells = [1.25] }\n",
     "2*pi/16*3*(i+s/2) + 2*pi/6*(j+s/2) + 2*pi/5*2*(k+s/2)",
     10 - 10 * std::cos(3 * pi / 16) * std::cos(pi / 6) * std::cos(2 * pi / 5)},
    {"second shell of bcc",
     "[lattice]\nshape = [12, 6, 5]\ncrystal = 'bcc'\nboundary = 'periodic'\n"
     "[field]\ncouplings = { shells = [1, -0.25] }\n",
     "2*pi/12*2*(i+s/2)", 8 - 8 * std::cos(pi / 6) + 0.5 * (std::cos(pi / 3) - 1)},
    {"kagome",
     "[lattice]\nshape = [9, 8]\ncrystal = 'kagome'\nboundary = 'periodic'\n"
     "[field]\ncouplings = { shells = [0.75] }\n",
     "2*pi/3*s", 4.5},
    {"pyrochlore",
     "[lattice]\nshape = [3, 4, 3]\ncrystal = 'pyrochlore'\nboundary = 'periodic'\n"
     "[field]\ncouplings = { shells = [0.5] }\n",
     "pi*(s%4 > 1)", 4},
    {"fcc",
     "[lattice]\nshape = [8, 5, 4]\ncrystal = 'fcc'\nboundary = 'periodic'\n"
     "[field]\ncouplings = { shells = [0.5] }\n",
     "2*pi/8*3*(i + (s>1)/2)", 6 - 2 * (2 * std::cos(3 * pi / 8) + 1)},
    {"hcp",
     "[lattice]\nshape = [6, 6, 4]\ncrystal = 'hcp'\nboundary = 'periodic'\n"
     "[field]\ncouplings = { shells = [0.5] }\n",
     "pi*s", 6},
    {"chain with DMI",
     "[lattice]\nshape = [24]\nboundary = 'periodic'\n"
     "[field]\ncouplings = [ { offset = [1, 0, 0], J = 1.0, D = [0, 0, 0.3] } ]\n",
     "2*pi/24*5*i", 2 - 2 * std::cos(5 * pi / 12) - 0.6 * std::sin(5 * pi / 12)}};

TEST(CrystalScenes, ConesTurnAtTheFrequencyOfTheirMagnon) {
  for (auto const& [name, lattice, phase, frequency] : cones)
    for (auto const precision : precisions) {
      SCOPED_TRACE(fmt::format("{}, {} precision", name, to_string(precision)));
      double const rate = frequency * std::cos(0.7), end = 2;
      auto const scene = [&](std::string const& at) {
        return scene_of(
            fmt::format("[system]\nkind = 'llg'\ndamping = 0\n{}[initial]\n"
                        "expression = [\"sin(0.7)*cos({})\", \"sin(0.7)*sin({})\", "
                        "\"cos(0.7)\"]\n[integrator]\nmethod = 'rkmk8'\ndt = 0.02\n"
                        "steps = 100\n",
                        lattice, at, at));
      };
      auto text = phase;
      if (auto const at = text.find("s%4 > 1"); at != std::string::npos)
        text = "pi*(s>1&&s<4 || s>5&&s<8 || s>9&&s<12 || s>13)";
      auto const expected =
          SceneRun::open(scene(fmt::format("{} + {:.17g}", text, rate * end)), {});
      auto const found = end_of(scene(text), precision);
      double const allowed =
          precision == Precision::double_precision ? 1e-10 : 100 * 100 * epsilon(precision);
      EXPECT_LT(largest_distance(found, spins_of(*expected)), allowed);
    }
}

// Every term of plain scenes, evaluated in a pass: moments of 1 ask for that and change nothing.
TEST(CrystalScenes, APassIsTheFieldThatKernelsEvaluate) {
  constexpr auto plain = R"toml(
[system]
kind = "llg"
damping = 0.1
[lattice]
shape = [19, 4, 3]
spacing = [0.8, 1, 1.25]
boundary = ["open", "periodic", "open"]
{}
[field]
exchange = 0.5
dmi = {{ interfacial = 0.2, normal = [0, 0, 1] }}
anisotropy = [ {{ constant = 0.4, axis = [1, 2, 3] }}, {{ constant = -0.1, axis = [0, 0, 1] }} ]
applied = ["0.3*cos(2*t)", 0, 0.2]
slab_demag = {{ normal = [0, 0, 1], strength = 0.3 }}
[initial]
random = {{ seed = 5 }}
[integrator]
method = "{}"
dt = 0.01
steps = 40
{}
)toml";
  int compared = 0, refused = 0;
  for (auto const* const method : io::methods())
    for (auto const precision : precisions) {
      if (method->automatic) continue;
      SCOPED_TRACE(fmt::format("{}, {} precision", method->word, to_string(precision)));
      std::string const more = method->adaptive ? "tolerance = 1e-4" : "";
      std::optional<io::Scene> usual;
      try {
        usual = scene_of(fmt::format(plain, "", method->word, more));
      } catch (io::SceneError const&) {
        continue;  // such as one that takes no field in t
      }
      try {
        auto const in_pass = scene_of(fmt::format(plain, "moments = [1]", method->word, more));
        // Some move each spin in its own anisotropy, and extrapolate the rest.
        bool const extrapolates = method->word.starts_with("fx");
        double const allowed =
            extrapolates ? 1e-4 : (method->adaptive ? 1e4 : 1e3) * epsilon(precision);
        EXPECT_LT(largest_distance(end_of(*usual, precision), end_of(in_pass, precision)), allowed);
        auto const energy =
            SceneRun::open(in_pass, {.precision = precision})->sample().energy.value;
        EXPECT_NEAR(energy, SceneRun::open(*usual, {.precision = precision})->sample().energy.value,
                    1e3 * epsilon(precision));
        ++compared;
      } catch (io::SceneError const& error) {
        EXPECT_NE(std::string(error.what()).find("another method"), std::string::npos)
            << error.what();
        ++refused;
      }
    }
  EXPECT_GT(compared, 40);
  EXPECT_LT(refused, 20);
}

// Half a film without spins is half a film, and what is frozen stays.
TEST(CrystalScenes, SitesWithoutSpinsAreNone) {
  auto const film = [](std::string const& lattice, std::string const& method) {
    return scene_of(fmt::format(R"toml(
[system]
kind = "llg"
damping = 0.1
[lattice]
{}
[field]
exchange = 0.5
dmi = {{ bulk = 0.2 }}
anisotropy = {{ cubic = 0.4, axes = [[1, 2, 0], [0, 0, 1]] }}
applied = ["0.3*cos(2*t)", 0, 0.2]
[torque]
zhang_li = {{ velocity = [0.1, 0.05, 0], nonadiabaticity = 0.2 }}
slonczewski = {{ damping_like = "0.1*t", field_like = 0.2, polarization = [0, 1, 1] }}
[initial]
expression = ["cos(i)", "sin(2*i+j)", "j-1.5"]
[integrator]
method = "{}"
dt = 0.02
steps = 50
{}
)toml",
                                lattice, method,
                                io::find_method(method)->adaptive ? "tolerance = 1e-8" : ""));
  };
  int compared = 0;
  for (auto const* const method : io::methods()) {
    if (method->automatic) continue;
    std::optional<io::Scene> half, whole;
    try {
      half = film("shape = [9, 4]", std::string(method->word));
      whole = film("shape = [19, 4]\noccupied = 'i < 9'", std::string(method->word));
    } catch (io::SceneError const&) {
      continue;
    }
    SCOPED_TRACE(method->word);
    auto const small = end_of(*half, Precision::double_precision);
    auto const run = SceneRun::open(*whole, {});
    run->advance(50);
    auto const large = spins_of(*run);
    double largest = 0;
    for (std::size_t j = 0; j < 4; ++j)
      for (std::size_t i = 0; i < 19; ++i)
        for (std::size_t c = 0; c < 3; ++c) {
          double const there = large[3 * (19 * j + i) + c];
          largest = std::max(largest, std::abs(there - (i < 9 ? small[3 * (9 * j + i) + c] : 0)));
        }
    EXPECT_LT(largest, method->adaptive ? 1e-6 : 1e-13);
    auto const of_half = SceneRun::open(*half, {})->sample();
    auto const of_whole = SceneRun::open(*whole, {})->sample();
    EXPECT_NEAR(of_whole.energy.value, of_half.energy.value, 1e-12);
    EXPECT_NEAR(of_whole.magnetization.y, of_half.magnetization.y, 1e-14);
    EXPECT_LT(of_whole.norm_defect, 1e-15);
    ++compared;
  }
  EXPECT_GE(compared, 19);
}

TEST(CrystalScenes, FrozenSpinsStay) {
  auto const scene = scene_of(R"toml(
[system]
kind = "llg"
damping = 0.3
[lattice]
shape = [12, 3, 2]
crystal = "bcc"
frozen = "i < 2 && s == 1"
moments = [1, 2]
[field]
couplings = { shells = [1] }
applied = [0, 0, 2]
[thermal]
temperature = 0.2
seed = 3
[initial]
random = { seed = 1 }
[integrator]
method = "heun"
dt = 0.02
steps = 50
)toml");
  for (auto const precision : precisions) {
    auto const run = SceneRun::open(scene, {.precision = precision});
    auto const before = spins_of(*run);
    run->advance(50);
    auto const after = spins_of(*run);
    for (std::size_t site = 0; site < before.size() / 3; ++site) {
      bool const frozen = site % 12 < 2 && site / 36 % 2 == 1;
      EXPECT_EQ(frozen, before[3 * site] == after[3 * site]) << site;
    }
  }
}

// H = -(1 / mu) dE/dm: without damping E stays, and so does the sum of (mu / g) m.
TEST(CrystalScenes, MomentsConserveEnergyAndAngularMomentum) {
  auto const text = R"toml(
[system]
kind = "llg"
damping = 0
[lattice]
shape = [6, 5, 4]
crystal = "honeycomb"
boundary = "periodic"
moments = [1.5, 0.6]
gyromagnetic = [0.9, 1.2]
[field]
couplings = { shells = [-0.8, 0.2] }
[initial]
random = { seed = 2 }
[integrator]
method = "rkmk8"
dt = 0.02
steps = 100
)toml";
  auto const run = SceneRun::open(scene_of(text), {});
  auto const sums = [&] {
    auto const m = spins_of(*run);
    std::array<double, 3> sum{};
    for (std::size_t site = 0; site < m.size() / 3; ++site)
      for (std::size_t c = 0; c < 3; ++c)
        sum[c] += (site / 30 % 2 == 0 ? 1.5 / 0.9 : 0.6 / 1.2) * m[3 * site + c];
    return sum;
  };
  auto const energy = run->sample().energy.value;
  auto const before = sums();
  run->advance(100);
  EXPECT_NEAR(run->sample().energy.value, energy, 1e-9);
  auto const after = sums();
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(after[c], before[c], 1e-9);
}

// Paramagnets of two moments in one bath: each has Langevin's magnetization of its own mu h / T.
TEST(CrystalScenes, EachMomentHasTheTemperature) {
  auto const scene = scene_of(R"toml(
[system]
kind = "llg"
damping = 1
[lattice]
shape = [32, 32, 8]
basis = [[0, 0, 0], [0.5, 0.5, 0.5]]
moments = [0.5, 2]
gyromagnetic = [1.3, 0.8]
[field]
applied = [0, 0, 1]
[thermal]
temperature = 1
seed = 7
[initial]
uniform = [0, 0, 1]
[integrator]
method = "heun"
dt = 0.02
steps = 1000
)toml");
  auto const run = SceneRun::open(scene, {});
  run->advance(500);
  double sums[2] = {};
  for (int look = 0; look < 10; ++look) {
    run->advance(50);
    auto const m = spins_of(*run);
    for (std::size_t site = 0; site < m.size() / 3; ++site)
      sums[site / 1024 % 2] += m[3 * site + 2];
  }
  for (int site : {0, 1}) {
    double const x = site == 0 ? 0.5 : 2, expected = 1 / std::tanh(x) - 1 / x;
    // 8192 spins, ten looks that know little of each other.
    EXPECT_NEAR(sums[site] / (10 * 8192), expected, 0.01) << site;
  }
}

// m.p = tanh(a t + atanh(m0.p)).
TEST(CrystalScenes, ASpinUnderSlonczewski) {
  for (auto const precision : precisions) {
    auto const found = end_of(scene_of(R"toml(
[system]
kind = "llg"
damping = 0
[lattice]
shape = [1]
[torque]
slonczewski = { damping_like = "0.4*t", polarization = [0, 0, 1] }
[initial]
uniform = [0.6, 0, -0.8]
[integrator]
method = "rkmk8"
dt = 0.02
steps = 100
)toml"),
                              precision);
    EXPECT_NEAR(found[2], std::tanh(0.4 * 2 + std::atanh(-0.8)), 500 * epsilon(precision));
  }
}

// A wall of width 1 in a current. Alone it moves at (1 + damping xi) u and turns; a hard axis holds
// its plane below Walker's current, and it moves at (1 + damping^2) (xi / damping) u. Both are
// exact but for the lattice, of second order.
TEST(CrystalScenes, AWallUnderACurrent) {
  constexpr double damping = 0.4, xi = 0.25, u = 0.1;
  for (bool const has_hard_axis : {false, true}) {
    double const expected =
        has_hard_axis ? (1 + damping * damping) * (xi / damping) * u : (1 + damping * xi) * u;
    double errors[2];
    for (int fine : {0, 1}) {
      int const sites = 80 << fine;
      auto const run = SceneRun::open(
          scene_of(fmt::format(R"toml(
[system]
kind = "llg"
damping = {}
[lattice]
shape = [{}]
spacing = {}
[field]
exchange = 1
anisotropy = [ {{ constant = 1, axis = [0, 0, 1] }}, {{ constant = {}, axis = [1, 0, 0] }} ]
[torque]
zhang_li = {{ velocity = [{}, 0, 0], nonadiabaticity = {} }}
[initial]
expression = ["0", "1/cosh(40*(x - 0.4))", "-tanh(40*(x - 0.4))"]
[integrator]
method = "rkmk4"
dt = 0.02
steps = 2000
)toml",
                               damping, sites, 40.0 / sites, has_hard_axis ? -1.0 : 0.0, u, xi)),
          {});
      auto const place = [&] { return 20 * run->sample().magnetization.z; };
      run->advance(1000);
      auto const before = place();
      run->advance(1000);
      errors[fine] = (place() - before) / 20 - expected;
    }
    SCOPED_TRACE(fmt::format("hard axis {}: {:.3g}, {:.3g}", has_hard_axis, errors[0], errors[1]));
    EXPECT_GT(errors[0] / errors[1], 3.6);
    EXPECT_LT(errors[0] / errors[1], 4.4);
    EXPECT_LT(std::abs((4 * errors[1] - errors[0]) / 3), 1e-3 * expected);
  }
}

// Constants by expressions that do not differ are constants, and a jump of the exchange is that of
// the library.
TEST(CrystalScenes, NumbersOfSites) {
  auto const scene = [](std::string const& damping, std::string const& field) {
    return scene_of(fmt::format(R"toml(
[system]
kind = "llg"
damping = {}
[lattice]
shape = [19, 4, 2]
spacing = [0.8, 1, 1.25]
boundary = ["open", "periodic", "open"]
[field]
{}
[initial]
random = {{ seed = 5 }}
[integrator]
method = "rkmk4"
dt = 0.02
steps = 50
)toml",
                                damping, field));
  };
  std::pair<io::Scene, io::Scene> const same[] = {
      {scene("0.1",
             "exchange = 0.5\ndmi = { bulk = 0.2 }\n"
             "anisotropy = { constant = 0.4, axis = [1, 2, 3] }"),
       scene("'0.1+0*x'",
             "exchange = '0.5+0*i'\ndmi = { bulk = '0.2+0*j' }\n"
             "anisotropy = { constant = '0.4+0*k', axis = [1, 2, 3] }")},
      {scene("0.1", "exchange = 0.5\ndmi = { interfacial = 0.2, normal = [0, 1, 1] }"),
       scene("'0.1+0*x'",
             "exchange = '0.5+0*i'\ndmi = { interfacial = '0.2', normal = [0, 1, 1] }")},
      {scene("'0.2*(i<9)'", "applied = [0, 0, 1]"), scene("'(i<9)/5'", "applied = [0, 0, 1]")}};
  for (auto const& [uniform, by_site] : same)
    for (auto const precision : precisions) {
      EXPECT_LT(largest_distance(end_of(uniform, precision), end_of(by_site, precision)),
                1e3 * epsilon(precision));
      EXPECT_NEAR(SceneRun::open(uniform, {.precision = precision})->sample().energy.value,
                  SceneRun::open(by_site, {.precision = precision})->sample().energy.value,
                  1e4 * epsilon(precision));
    }
  // Spins without damping keep their height in a field, the others do not.
  auto const run = SceneRun::open(scene("'0.2*(i<9)'", "applied = [0, 0, 1]"), {});
  auto const before = spins_of(*run);
  run->advance(50);
  auto const after = spins_of(*run);
  for (std::size_t site = 0; site < before.size() / 3; ++site) {
    double const rise = after[3 * site + 2] - before[3 * site + 2];
    if (site % 19 < 9)
      EXPECT_GT(rise, 0) << site;
    else
      EXPECT_NEAR(rise, 0, 1e-14) << site;
  }
}

TEST(CrystalScenes, GoOnWithTheSameBits) {
  auto const scene = scene_of(R"toml(
[system]
kind = "llg"
damping = 0.05
[lattice]
shape = [6, 5, 4]
crystal = "kagome"
moments = [1, 2, 1.5]
occupied = "i != 2 || s != 1"
[field]
couplings = [ { between = [0, 1], J = 1, D = [0, 0.1, 0.2] }, { between = [1, 2], offset = [0, 0, 1], tensor = [[1, 0, 0], [0, 2, 0], [0.5, 0, 1]], biquadratic = 0.2 } ]
anisotropy = [ { constant = 0.3, axis = [0, 1, 1], site = 2 }, { cubic = 0.1, axes = [[1, 0, 0], [0, 1, 0]], site = 0 } ]
applied = [0, "sin(t)", 0.1]
[torque]
slonczewski = { damping_like = 0.1, polarization = [1, 0, 0] }
[thermal]
temperature = 0.05
seed = 3
[initial]
random = { seed = 1 }
[integrator]
method = "heun"
dt = 0.02
steps = 40
)toml");
  auto const path = std::filesystem::temp_directory_path() / "cayspin_crystal.checkpoint.h5";
  auto const whole = end_of(scene, Precision::double_precision);
  auto const first = SceneRun::open(scene, {});
  first->advance(17);
  first->save(path);
  auto const second = SceneRun::open(scene, {.restart = path});
  second->advance(23);
  EXPECT_EQ(spins_of(*second), whole);
  std::filesystem::remove(path);
}

// Neel's state of a bcc antiferromagnet in a field below its flop.
TEST(CrystalScenes, Relax) {
  auto const scene = scene_of(R"toml(
[system]
kind = "llg"
damping = 0.5
[lattice]
shape = [6, 5, 4]
crystal = "bcc"
boundary = "periodic"
[field]
couplings = { shells = [-1] }
anisotropy = { constant = 0.5, axis = [0, 0, 1] }
applied = [0, 0, 1]
[initial]
random = { seed = 4 }
[integrator]
method = "heun"
dt = 0.02
steps = 1
)toml");
  auto const run = SceneRun::open(scene, {});
  auto const found = run->relax();
  EXPECT_EQ(found.end, MinimizeEnd::converged);
  EXPECT_NEAR(found.energy.value, 120 * -8.0 - 240 * 0.25, 1e-6);
}

// Moments do not bend the way down: the energy of a ferrimagnet along its field, and that of a
// cubic crystal, whose field is not linear.
TEST(CrystalScenes, RelaxMomentsAndCubicAxes) {
  auto const relaxed = [](std::string const& lattice, std::string const& field) {
    auto const run = SceneRun::open(scene_of(fmt::format("[system]\nkind = 'llg'\ndamping = 0.5\n"
                                                         "[lattice]\nshape = [6, 5, 4]\n{}\n"
                                                         "[field]\n{}\n[initial]\nrandom = {{ "
                                                         "seed = 4 }}\n[integrator]\nmethod = "
                                                         "'heun'\ndt = 0.02\nsteps = 1\n",
                                                         lattice, field)),
                                    {});
    auto const found = run->relax({.torque = 1e-7});
    EXPECT_EQ(found.end, MinimizeEnd::converged);
    return found.energy.value;
  };
  EXPECT_NEAR(relaxed("crystal = 'bcc'\nboundary = 'periodic'\nmoments = [3, 0.4]\n"
                      "gyromagnetic = [1, 2]",
                      "couplings = { shells = [-1] }\napplied = [0, 0, 0.1]\n"
                      "anisotropy = { constant = 0.1, axis = [0, 0, 1] }"),
              120 * (-8.0 - 0.1 - 0.1 * (3 - 0.4)), 1e-6);
  EXPECT_NEAR(relaxed("boundary = 'periodic'",
                      "exchange = 1\nanisotropy = { cubic = -0.3, axes = [[1, 0, 0], [0, 1, 0]] }"),
              120 * -0.1, 1e-6);
}

}  // namespace
}  // namespace cayspin::simulation::test
