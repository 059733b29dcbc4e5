// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// `advise`, `trade` and the method "auto" for fields that change within a small part of a run: the
// method that they choose has the requested error, or one line says that no method has it.
#include "../support/larger.hpp"
#include "../support/random_pulses.hpp"
#include "program_test.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <sstream>

namespace cayspin::program::test {
namespace {

using cayspin::test::RandomPulses;

struct Pulses : ProgramTest {
  /// Returns a scene of one damped spin at equilibrium along z, with a pulse normal to it near the
  /// end.
  static std::string scene(std::string const& integrator) {
    return "system = { kind = \"llg\", damping = 0.5 }\nlattice = { shape = [1] }\n"
           "field = { applied = [\"t>500 && t<501.5 ? 1.0 : 0\", \"0\", \"1.0\"] }\n"
           "initial = { uniform = [0, 0, 1] }\nintegrator = { " +
           integrator + " }\n";
  }
  static double error_of(std::vector<double> const& spins) {
    return distance(spins, {0.681299, 0.140225, 0.718449});
  }
};

TEST_F(Pulses, AreSeenByTheMethodAuto) {
  for (std::string const error : {"1e-2", "1e-4"})
    EXPECT_LT(error_of(end_of(scene("method='auto', error=" + error + ", end=502"))),
              2 * std::stod(error));
}

TEST_F(Pulses, AreSeenByAdvise) {
  write("scene.toml", scene("method='rkmk4', dt=0.5, end=502"));
  auto const advice = nlohmann::json::parse(
      output_of({"advise", "scene.toml", "--error", "1e-4", "--json", "--threads", "1"}));
  EXPECT_GT(advice["error"].get<double>(), 1e-12);
  Arguments arguments{"--precision", advice["precision"], "--threads", "1"};
  for (std::string const override : advice["overrides"])
    arguments.insert(arguments.end(), {"--set", override});
  EXPECT_LT(error_of(end_of(scene("method='rkmk4', dt=0.5, end=502"), arguments)), 2e-4);
}

TEST_F(Pulses, AreSeenByTrade) {
  write("scene.toml", scene("method='rkmk4', dt=0.5, end=502"));
  auto const all =
      nlohmann::json::parse(output_of({"trade", "scene.toml", "--json", "--seconds", "0.1",
                                       "--threads", "1", "--precision", "double", "--quiet"}));
  EXPECT_EQ(all["horizon"], 502.0);
  double largest = 0;
  for (auto const& method : all["methods"])
    for (auto const& rung : method["rungs"])
      largest = cayspin::test::larger(largest, rung["error"].get<double>());
  EXPECT_GT(largest, 1e-3);
}

TEST_F(Pulses, RandomOnesAreFollowedByTheMethodAuto) {
  char const* const asked = std::getenv("CAYSPIN_PULSES");
  std::int64_t const count = asked ? std::atoll(asked) : 4;
  std::int64_t refused = 0;
  double worst = 0;
  for (std::int64_t number = 0; number < count; ++number) {
    RandomPulses const pulses(7, number);
    double const error = std::pow(10.0, -2.0 - static_cast<double>(number % 4));
    std::ostringstream integrator;
    integrator.precision(17);
    integrator << "integrator = { method = 'auto', error = " << error << ", end = " << pulses.end
               << " }\n";
    auto const text = pulses.tables() + integrator.str();
    auto const outcome = run_into("out.h5", text, {"--threads", "1"});
    if (outcome.status != 0) {
      ++refused;
      EXPECT_TRUE(outcome.status == 2 || outcome.status == 3) << outcome.errors << text;
      EXPECT_EQ(std::ranges::count(outcome.errors, '\n'), 1) << outcome.errors << text;
      continue;
    }
    auto spins = read_dataset("out.h5", "/spins").values;
    spins.erase(spins.begin(), spins.end() - 3);
    auto const exact = pulses.exact();
    double const found = distance(spins, {exact[0], exact[1], exact[2]});
    worst = cayspin::test::larger(worst, found / error);
    EXPECT_LT(found, 2 * error) << number << '\n' << text;
    std::filesystem::remove(in_folder("out.h5"));
  }
  std::printf("    error over that asked for, of %ld fields: at most %.3g; %ld refused\n",
              static_cast<long>(count), worst, static_cast<long>(refused));
  EXPECT_LE(refused, count / 10);
}

TEST_F(Pulses, StepsThatAutoChoosesAreNoLongerThanTheScenesLongest) {
  auto const resolved =
      run("system = { kind = \"llg\", damping = 0.1 }\nlattice = { shape = [1] }\n"
          "field = { applied = [0, 0, 1] }\ninitial = { uniform = [1, 0, 1] }\n"
          "integrator = { method='auto', error=1e-2, end=8, max_dt=0.03 }\n")
          .header.resolved_scene;
  if (resolved.find("tolerance") != std::string::npos) {
    EXPECT_NE(resolved.find("max_dt = 0.03"), std::string::npos) << resolved;
  } else {
    auto const dt = resolved.find("dt = ");
    ASSERT_NE(dt, std::string::npos) << resolved;
    EXPECT_LE(std::stod(resolved.substr(dt + 5)), 0.03) << resolved;
  }
}

TEST_F(Pulses, CheckNamesTheShortestFeature) {
  write("scene.toml", scene("method='rkmk4', dt=2, end=502"));
  auto const text = output_of({"check", "scene.toml"});
  EXPECT_NE(text.find("features    the shortest is 1.5 long, of field.applied at t = 500; 2 jumps"),
            std::string::npos)
      << text;
  auto const numbers = nlohmann::json::parse(output_of({"check", "scene.toml", "--json"}));
  EXPECT_NEAR(numbers["shortest_feature"].get<double>(), 1.5, 1e-9);
  EXPECT_EQ(numbers["jumps"], 2);
  EXPECT_EQ(output_of({"check", "chain.toml"}).find("features"), std::string::npos);
}

TEST_F(Pulses, APeakJustAfterTheStartOrBeforeTheEndIsNoShortFeature) {
  for (std::string const value : {"cos(9*t-0.1)", "cos(9*(0.3-t)-0.1)"}) {
    auto const shortest = [&](double end) {
      write(
          "scene.toml",
          fmt::format("system = {{ kind = \"llg\", damping = 0.1 }}\nlattice = {{ shape = [1] }}\n"
                      "field.applied = [0, 0, \"{}\"]\ninitial.uniform = [1, 0, 1]\n"
                      "integrator = {{ method = 'rkmk4', dt = 0.02, end = {} }}\n",
                      value, end));
      return nlohmann::json::parse(output_of({"check", "scene.toml", "--json"}))
          .at("shortest_feature");
    };
    EXPECT_TRUE(shortest(0.3).is_null()) << shortest(0.3);
    EXPECT_NEAR(shortest(1.3).get<double>(), std::numbers::pi / 9, 1e-3);
  }
}

TEST_F(Pulses, RunWarnsOfStepsThatMayMissThem) {
  auto const outcome = run_into("out.h5", scene("method='rkmk4', dt=1.6, steps=314"));
  EXPECT_EQ(outcome.status, 0);
  EXPECT_NE(outcome.errors.find("which steps may miss"), std::string::npos) << outcome.errors;
  EXPECT_EQ(
      run_into("out.h5", scene("method='rkmk4', dt=1.6, steps=314, refuse_unstable=true")).status,
      2);
}

}  // namespace
}  // namespace cayspin::program::test
