// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Time-dependent factors of exchange, anisotropy and DMI.
#include "io/method.hpp"
#include "scenes_of_text.hpp"

#include <cayspin/units.hpp>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace cayspin::simulation::test {
namespace {

// A cone of spins turns rigidly about z, by an angle proportional to the integral of the factor.
TEST(ConstantsInTime, TurnConesByTheirIntegral) {
  struct Cone {
    std::string shape, field;
    double frequency;  // of the cone, divided by cos(0.7)
    std::string q;
  };
  double const A = 2 - 2 * std::cos(2 * pi / 12), D = -2 * 0.3 * std::sin(2 * pi / 12);
  std::string const along = "2*pi/12*k";
  for (
      auto const& [shape, field, frequency, q] :
      {Cone{"[3, 1, 12]", "exchange = 1\nin_time = { exchange = 'F' }", A, along},
       {"[3, 1, 12]", "exchange = '1 + 0*i'\nin_time = { exchange = 'F' }", A, along},
       {"[3, 1, 12]", "dmi = { bulk = 0.3 }\nin_time = { dmi = 'F' }", D, along},
       {"[3, 1, 12]", "dmi = { bulk = '0.3 + 0*i' }\nin_time = { dmi = 'F' }", D, along},
       {"[3, 1, 12]", "exchange = 1\ndmi = { bulk = 0.3 }\nin_time = { exchange = 'F', dmi = 'F' }",
        A + D, along},
       {"[40]", "anisotropy = { constant = 0.8, axis = [0, 0, 1] }\nin_time = { anisotropy = 'F' }",
        0.8, "0.3*i"},
       {"[40]",
        "anisotropy = [{ constant = 0.5, axis = [0, 0, 1] }, { constant = '0.3 + 0*i', axis = [0, 0, "
        "1] }]\nin_time = { anisotropy = 'F' }",
        0.8, "0.3*i"}})
    for (std::string const lattice : {"", "moments = 2\n", "moments = '2 + 0*i'\n"})
      for (auto const precision : precisions) {
        SCOPED_TRACE(field + lattice + std::string(to_string(precision)));
        double const end = 1, integral = 1 + 0.5 * (1 - std::cos(3.0)) / 3;
        double const rate = frequency * std::cos(0.7) / (lattice.empty() ? 1 : 2);
        auto text = field;
        for (auto at = text.find('F'); at != text.npos; at = text.find('F'))
          text.replace(at, 1, "1 + 0.5*sin(3*t)");
        auto const scene = [&](std::string const& phase) {
          return scene_of(fmt::format(
              "system = {{ kind = 'llg', damping = 0 }}\n[lattice]\nshape = {}\nboundary = "
              "'periodic'\n{}[field]\n{}\n[initial]\nexpression = [\"sin(0.7)*cos({})\", "
              "\"sin(0.7)*sin({})\", \"cos(0.7)\"]\n[integrator]\nmethod = 'rkmk4'\ndt = 0.002\n"
              "steps = 500\n",
              shape, lattice, text, phase, phase));
        };
        auto const expected =
            SceneRun::open(scene(fmt::format("{} + {:.17g}", q, rate * integral * end)), {});
        double const allowed =
            precision == Precision::double_precision ? 1e-11 : 500 * 16 * epsilon(precision);
        EXPECT_LT(largest_distance(end_of(scene(q), precision), spins_of(*expected)), allowed);
      }
}

std::string const film_of_layers = R"toml(
system = { kind = "llg", damping = 0.1 }
[lattice]
shape = [19, 5, 3]
boundary = ["open", "periodic", "open"]
regions = "i < 7 ? 0 : j % 2 + 1"
)toml";

/// Returns a table [field] with exchange, DMI, an applied field, a slab's demag, and anisotropies
/// whose constants are multiplied by `K`.
std::string field_of(std::string const& exchange, std::string const& dmi, double K) {
  return fmt::format(R"toml(
[field]
exchange = {}
dmi = {}
applied = [0.1, 0, 0.2]
slab_demag = {{ normal = [0, 0, 1], strength = 0.4 }}
anisotropy = [
  {{ constant = {}, axis = [1, 2, 3] }},
  {{ constant = "{}*i", axis = [0, 0, 1] }},
  {{ cubic = {}, axes = [[1, 0, 0], [0, 1, 0]] }},
  {{ hexagonal = {}, axis = [0, 0, 1], in_plane = [1, 0, 0] }}]
)toml",
                     exchange, dmi, 0.4 * K, 0.1 * K, 0.3 * K, 0.1 * K);
}

std::string with_method(io::Method const& method) {
  return fmt::format(
      "[initial]\nrandom = {{ seed = 5 }}\n[integrator]\nmethod = '{}'\ndt = 0.01\nsteps = 20\n{}",
      method.word, method.adaptive ? "tolerance = 1e-5\n" : "");
}

// Constant factors act like multiplied constants, with every method that accepts the terms.
TEST(ConstantsInTime, AreTheConstantsTimesTheirFactors) {
  struct Terms {
    std::string exchange, exchange_half, dmi, dmi_more;
  };
  for (auto const& [exchange, exchange_half, dmi, dmi_more] :
       {Terms{"0.8", "0.4", "{ bulk = 0.3 }", "{ bulk = 0.75 }"},
        {"'0.8 + 0.1*i'", "'0.4 + 0.05*i'", "{ d2d = 0.3 }", "{ d2d = 0.75 }"},
        {"0.8\nexchange_between = [{ between = [0, 1], factor = 0.5 }]",
         "0.4\nexchange_between = [{ between = [0, 1], factor = 0.5 }]",
         "{ interfacial = '0.1*j', normal = [0, 0, 1] }",
         "{ interfacial = '0.25*j', normal = [0, 0, 1] }"}})
    for (std::string const lattice : {"", "occupied = '(i + 2*j + k) % 5 > 0'\n",
                                      "moments = [0.5]\n", "moments = '1 + 0.1*j'\n"}) {
      int compared = 0;
      for (auto const* const method : io::methods()) {
        if (method->automatic) continue;
        std::optional<io::Scene> one;
        try {
          one = scene_of(film_of_layers + lattice + field_of(exchange, dmi, 1) +
                         "in_time = { exchange = 0.5, dmi = '2.5', anisotropy = '-2' }\n" +
                         with_method(*method));
        } catch (io::SceneError const&) {
          continue;  // the method refuses some of the terms
        }
        auto const other = scene_of(film_of_layers + lattice +
                                    field_of(exchange_half, dmi_more, -2) + with_method(*method));
        for (auto const precision : precisions) {
          SCOPED_TRACE(fmt::format("{}, {}{}{}, {}", method->word, exchange, dmi, lattice,
                                   to_string(precision)));
          double const allowed = (method->stiff      ? 4e4
                                  : method->adaptive ? 1e4
                                                     : 1e3) *
                                 epsilon(precision);
          EXPECT_LT(largest_distance(end_of(*one, precision), end_of(other, precision)), allowed);
          auto const of_one = SceneRun::open(*one, {.precision = precision})->energies(),
                     of_other = SceneRun::open(other, {.precision = precision})->energies();
          ASSERT_EQ(of_one.size(), of_other.size());
          for (std::size_t i = 0; i < of_one.size(); ++i) {
            EXPECT_EQ(of_one[i].first, of_other[i].first);
            EXPECT_NEAR(of_one[i].second, of_other[i].second, 4e3 * epsilon(precision));
          }
          ++compared;
        }
      }
      EXPECT_GE(compared, 20) << exchange << dmi << lattice;
    }
}

// In SI, t is in seconds: spins turn by gamma * m_z * (2 * Ku / Ms) times the integral of the
// factor.
TEST(ConstantsInTime, AreInSecondsInSi) {
  auto const scene = scene_of(R"toml(
units = "SI"
system = { kind = "llg" }
material = { Ms = 8e5, Ku = 5e4, axis = [0, 0, 1], alpha = 0 }
lattice = { shape = [3], spacing = 5e-9 }
field = { in_time = { anisotropy = "1 + 2e10*t" } }
initial = { uniform = [0.6, 0, 0.8] }
integrator = { method = "rkmk4", dt = 1e-13, steps = 400 }
)toml");
  constexpr double t = 4e-11;
  double const angle = units::electron_gamma * 2 * 5e4 / 8e5 * 0.8 * (t + 1e10 * t * t);
  auto const end = end_of(scene);
  EXPECT_NEAR(end[0], 0.6 * std::cos(angle), 1e-12);
  EXPECT_NEAR(end[1], 0.6 * std::sin(angle), 1e-12);
}

TEST(ConstantsInTime, AreLookedAtBeforeTheRun) {
  auto const pulse = llg_scene(
      "0.1", "heun", 1000,
      "lattice = { shape = [4] }\nfield = { anisotropy = { constant = 1, axis = [0, 0, 1] }, in_time "
      "= { anisotropy = '1 + 5*exp(-((t-10.003)/0.001)^2)' } }\ninitial = { uniform = [1, 0, 1] }\n");
  auto const plan = make_plan(pulse, Precision::double_precision);
  ASSERT_TRUE(plan.features->shortest.has_value());
  EXPECT_EQ(plan.features->shortest->key, "field.in_time.anisotropy");
  EXPECT_NEAR(plan.features->shortest->length, 2 * std::sqrt(std::log(2.0)) * 0.001, 2e-4);
  auto const pole = llg_scene(
      "0.1", "heun", 100,
      "lattice = { shape = [4] }\nfield = { exchange = 1, in_time = { exchange = '1/(t-1)' } }\n"
      "initial = { uniform = [1, 0, 1] }\n");
  EXPECT_THROW(make_plan(pole, Precision::double_precision), io::SceneError);
}

// An energy that rises because a constant rises must not stop a run.
TEST(ConstantsInTime, MayRaiseTheEnergy) {
  auto const scene = llg_scene(
      "0.1", "heun", 100,
      "lattice = { shape = [4] }\nfield = { anisotropy = { constant = -1, axis = [0, 0, 1] }, in_time "
      "= { anisotropy = '1 + 3*t' }, applied = [0, 0, 9] }\ninitial = { uniform = [0.1, 0, 1] }\n");
  auto const run = SceneRun::open(scene, {});
  double const first = run->sample().energy.value;
  run->advance(100);
  EXPECT_GT(run->sample().energy.value, first + 4);
}

TEST(ConstantsInTime, GoOnAfterABreak) {
  for (std::string const method : {"heun", "rkmk4"})
    expect_same_bits_after_a_break(
        scene_of(film_of_layers + field_of("'0.5 + 0.1*i'", "{ d2d = 0.3 }", 1) +
                 "in_time = { exchange = '1+0.1*sin(40*t)', dmi = '1-t', anisotropy = 'exp(-t)' }\n"
                 "[initial]\nrandom = { seed = 5 }\n[integrator]\nmethod = '" +
                 method + "'\ndt = 0.01\nsteps = 20\n"),
        7);
}

}  // namespace
}  // namespace cayspin::simulation::test
