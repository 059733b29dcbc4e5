// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// `cayspin trade` and `cayspin advise`: which errors they report, at which costs, and how long they
// take.
#include "early_rest.hpp"
#include "program_test.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>

namespace cayspin::program::test {
namespace {

using nlohmann::json;

struct Looks : ProgramTest {
  static std::string at_rest() {
    return early_rest("[integrator]\nmethod = \"rkmk4\"\ndt = 0.125\nend = 20.0\n");
  }

  json trade() const {
    write("scene.toml", at_rest());
    return json::parse(output_of({"trade", "scene.toml", "--json", "--seconds", "0.1", "--threads",
                                  "1", "--precision", "double"}));
  }
  static json const& method(json const& trade, std::string const& name) {
    auto const& methods = trade.at("methods");
    auto const found =
        std::ranges::find_if(methods, [&](json const& one) { return one.at("method") == name; });
    if (found == methods.end()) throw std::runtime_error(name + " is not in the trade");
    return *found;
  }

  /// Returns frames at the times of `steps` equal steps, from a run with `finer` times as many.
  std::vector<double> frames(std::int64_t steps, std::int64_t finer) const {
    std::ostringstream integrator;
    integrator.precision(17);
    integrator << "integrator={method='rkmk4',dt=" << 20 / static_cast<double>(steps * finer)
               << ",steps=" << steps * finer << "}";
    end_of(at_rest(), {"--threads", "1", "--set", integrator.str(), "--set",
                       "output.every=" + std::to_string(finer)});
    return read_dataset("out.h5", "/spins").values;
  }
};

// At the end of this run the error is a millionth of the error during the motion.
TEST_F(Looks, ErrorsOfTradeAreThoseOfTheMotion) {
  auto const all = trade();
  int compared = 0;
  for (auto const& rung : method(all, "rkmk4").at("rungs")) {
    auto const steps = std::llround(20 / rung.at("dt").get<double>());
    if (steps < 160 || steps > 400) continue;  // keeps to stable and quick runs
    ++compared;
    double const largest = distance(frames(steps, 1), frames(steps, 8));
    EXPECT_GT(rung.at("error").get<double>(), 0.3 * largest) << steps;
    EXPECT_LT(rung.at("error").get<double>(), 1.01 * largest) << steps;
  }
  EXPECT_GE(compared, 2);  // each rung has 1.5 times the steps of the one before
}

TEST_F(Looks, CostsOfErrorsLieBetweenTheRunsOfALadder) {
  auto const all = trade();
  int known = 0;
  for (auto const& one : all.at("methods")) {
    ASSERT_EQ(one.at("costs").size(), 4u);
    for (auto const& cost : one.at("costs")) {
      auto const& rungs = one.at("rungs");
      bool const is_reached = std::ranges::any_of(
          rungs, [&](json const& rung) { return rung.at("error") <= cost.at("error"); });
      EXPECT_EQ(cost.at("seconds").is_null(), !is_reached) << one.at("method");
      EXPECT_EQ(cost.at("evaluations").is_null(), !is_reached) << one.at("method");
      known += is_reached;
    }
  }
  EXPECT_GT(known, 20);
  auto const& rungs = method(all, "rkmk4").at("rungs");
  auto const& costs = method(all, "rkmk4").at("costs");
  EXPECT_EQ(costs[2].at("error"), 1e-6);
  int around = 0;
  for (std::size_t i = 1; i < rungs.size(); ++i) {
    double const coarse = rungs[i - 1].at("error"), fine = rungs[i].at("error");
    if (coarse <= 1e-6 || fine > 1e-6) continue;
    ++around;
    EXPECT_GT(costs[2].at("evaluations"), rungs[i - 1].at("evaluations"));
    EXPECT_LE(costs[2].at("evaluations"), rungs[i].at("evaluations"));
  }
  EXPECT_EQ(around, 1);
  // A hundredth of the error takes 100^(1/4) times the evaluations at order 4.
  double const ratio = double(costs[3].at("evaluations")) / double(costs[2].at("evaluations"));
  EXPECT_NEAR(ratio, 3.162, 0.3);
}

// Finding a method for this error with disordered spins once took 40 s.
TEST_F(Looks, AdviceTakesNoLongerThanItSays) {
  auto const disordered =
      set("lattice={shape=[8,8,8],boundary='periodic'}", "field={exchange=1.0,applied=[0,0,0.5]}",
          "initial.random.seed=1", "integrator={method='rkmk4',dt=0.05,end=20.0}");
  auto const begin = std::chrono::steady_clock::now();
  auto const output =
      output_of(joined({"advise", "chain.toml", "--error", "1e-8", "--threads", "1"}, disordered));
  std::chrono::duration<double> const taken = std::chrono::steady_clock::now() - begin;
  EXPECT_TRUE(output.starts_with("trying methods for at most 2 s\n")) << output;
  EXPECT_LT(taken.count(), address_sanitizer ? 20 : 5);
}

}  // namespace
}  // namespace cayspin::program::test
