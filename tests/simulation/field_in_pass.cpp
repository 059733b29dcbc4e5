// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Compares two forms of one physical system: terms in kernels or in a separate pass, fewer sites or
// vacant sites, and constants or expressions. The first two are compared with every method that
// accepts both forms.
#include "../support/larger.hpp"
#include "io/method.hpp"
#include "scenes_of_text.hpp"

#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace cayspin::simulation::test {
namespace {

// Compares the terms of a plain scene in kernels with those in a separate pass. Moments of 1 cause
// the pass and change nothing else.
TEST(FieldInPass, APassIsTheFieldThatKernelsEvaluate) {
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
        continue;  // e.g. a method that refuses time-dependent fields
      }
      try {
        auto const in_pass = scene_of(fmt::format(plain, "moments = [1]", method->word, more));
        double const allowed = (method->adaptive ? 1e4 : 1e3) * epsilon(precision);
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

// A film with vacant sites acts like a film of only its occupied sites.
TEST(FieldInPass, SitesWithoutSpinsAreNone) {
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
    auto const small = end_of(*half), large = end_of(*whole);
    double largest = 0;
    for (std::size_t j = 0; j < 4; ++j)
      for (std::size_t i = 0; i < 19; ++i)
        for (std::size_t c = 0; c < 3; ++c) {
          double const there = large[3 * (19 * j + i) + c];
          largest = cayspin::test::larger(
              largest, std::abs(there - (i < 9 ? small[3 * (9 * j + i) + c] : 0)));
        }
    // Stiff methods solve a step only to a fraction of its error, and differently on the two
    // lattices.
    bool const is_rounded = !method->adaptive && !method->word.starts_with("stiff");
    EXPECT_LT(largest, is_rounded ? 1e-13 : 1e-6);
    auto const of_half = SceneRun::open(*half, {})->sample();
    auto const of_whole = SceneRun::open(*whole, {})->sample();
    EXPECT_NEAR(of_whole.energy.value, of_half.energy.value, 1e-12);
    EXPECT_NEAR(of_whole.magnetization.y, of_half.magnetization.y, 1e-14);
    EXPECT_LT(of_whole.norm_defect, 1e-15);
    ++compared;
  }
  EXPECT_GE(compared, 19);
}

// Expressions that are uniform act like constants.
TEST(FieldInPass, NumbersOfSites) {
  auto const scene = [](std::string const& damping, std::string const& field) {
    return llg_scene(damping, "rkmk4", 50,
                     "[lattice]\nshape = [19, 4, 2]\nspacing = [0.8, 1, 1.25]\n"
                     "boundary = ['open', 'periodic', 'open']\n"
                     "[initial]\nrandom = { seed = 5 }\n[field]\n" +
                         field);
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
  // Spins without damping keep their m_z in the field; the others do not.
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

// Each of the sources adds profile / k * (k cos(2 t)), so that all of them together are one source.
TEST(FieldInPass, AnyNumberOfSourcesAddUp) {
  auto const sources = [](int first, int last, double divisor) {
    std::string list;
    for (int k = first; k <= last; ++k)
      list += fmt::format("{{ profile = ['{0}*x', '{0}*(y-0.5)', {0}], time = '{1}*cos(2*t)' }}, ",
                          divisor / k, k);
    return "sources = [" + list + "]";
  };
  auto const scene = [](std::string const& method, std::string const& of_sources) {
    std::string const more = io::find_method(method)->adaptive ? ", tolerance = 1e-5" : "";
    return scene_of(
        fmt::format("system = {{ kind = 'llg', damping = 0.1 }}\n"
                    "lattice = {{ shape = [19, 4, 3], spacing = [0.8, 1, 1.25] }}\n"
                    "field = {{ exchange = 0.5, {} }}\n"
                    "initial = {{ random = {{ seed = 5 }} }}\n"
                    "integrator = {{ method = '{}', dt = 0.02, steps = 40{} }}\n",
                    of_sources, method, more));
  };
  for (std::string const method : {"heun", "tsit5"})
    for (auto const precision : precisions)
      for (int const count : {8, 9, 20}) {
        SCOPED_TRACE(
            fmt::format("{}, {} sources, {} precision", method, count, to_string(precision)));
        auto const one =
            SceneRun::open(scene(method, sources(1, 1, 0.05 * count)), {.precision = precision});
        auto const many =
            SceneRun::open(scene(method, sources(1, count, 0.05)), {.precision = precision});
        for (auto* const run : {one.get(), many.get()}) run->advance(40);
        EXPECT_LT(largest_distance(spins_of(*one), spins_of(*many)),
                  (io::find_method(method)->adaptive ? 1e4 : 1e3) * epsilon(precision));
        auto const energy = one->sample().energy.value;
        EXPECT_NEAR(many->sample().energy.value, energy,
                    1e4 * epsilon(precision) * std::abs(energy));
      }
}

}  // namespace
}  // namespace cayspin::simulation::test
