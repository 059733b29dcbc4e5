// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// docs/reports/extremes.md: the page is what is printed, and every run keeps its promise.
#include "io/method.hpp"
#include "program_test.hpp"

#include <nlohmann/json.hpp>

#include <fstream>
#include <map>
#include <set>
#include <sstream>

namespace cayspin::program::test {
namespace {

using Json = nlohmann::json;

class Extremes : public ProgramTest {
 protected:
  static std::string page() {
    std::ifstream file(CAYSPIN_DOCS "/reports/extremes.md");
    return {std::istreambuf_iterator<char>(file), {}};
  }

  /// All runs, by "section: situation".
  std::map<std::string, std::vector<Json>> runs() const {
    std::map<std::string, std::vector<Json>> runs;
    std::istringstream lines(output_of({"extremes", "--json"}));
    for (std::string line; std::getline(lines, line);) {
      auto const run = Json::parse(line);
      EXPECT_TRUE(run.at("kept")) << line;
      runs[run.at("section").get<std::string>() + ": " + run.at("situation").get<std::string>()]
          .push_back(run);
    }
    return runs;
  }

  static double epsilon(Json const& run) {
    return run.at("precision") == "double" ? 0x1p-52 : 0x1p-23;
  }
  static bool is_adaptive(std::string const& situation) {
    return situation.starts_with("Adaptive steps: ");
  }
  /// Of all methods with equal steps, or all others.
  static bool is_of_all(std::string const& situation) {
    return !situation.starts_with("Temperatures: ") && !situation.starts_with("Dear fields: ") &&
           !situation.starts_with("States of rest: ");
  }
  /// Of the methods that choose their steps, or of the others.
  static std::vector<std::string> words(bool adaptive) {
    std::vector<std::string> all;
    for (auto const* const method : io::methods())
      if (!method->automatic && method->adaptive == adaptive) all.emplace_back(method->word);
    return all;
  }
  static bool is_body(Json const& run) {
    return run.at("method").get<std::string>().ends_with("(rigid body)");
  }
  static bool is_classical(Json const& run) {
    return run.at("method").get<std::string>().starts_with("classical");
  }
};

TEST_F(Extremes, ThePageIsWhatIsPrinted) {
  auto const outcome = start({"extremes"});
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_TRUE(page().starts_with(outcome.output))
      << "docs/reports/extremes.md begins with what `cayspin extremes` prints:\n"
      << outcome.output;
}

// The promises once more, from the numbers alone.
TEST_F(Extremes, RunsKeepTheirPromises) {
  auto const all = runs();
  std::set<std::string> methods;
  for (auto const& [situation, some] : all) {
    if (is_of_all(situation)) {
      ASSERT_GE(some.size(), 2 * words(is_adaptive(situation)).size()) << situation;
    }
    for (auto const& run : some) {
      methods.insert(run.at("method"));
      std::string const fate = run.at("fate");
      std::int64_t const step = run.at("step"), steps = run.at("steps");
      EXPECT_TRUE(fate != "drifts" || is_classical(run)) << run;
      if (fate == "detected") {
        EXPECT_GE(step, 0) << run;
      }
      if (step >= 0 || fate == "refused") {
        EXPECT_FALSE(run.at("message").get<std::string>().empty()) << run;
        continue;
      }
      if (!is_classical(run)) {
        EXPECT_LE(run.at("norm"), 4.0 * (steps + 1)) << run;
      }
    }
  }
  for (bool const adaptive : {false, true})
    for (auto const& word : words(adaptive)) {
      EXPECT_TRUE(methods.contains(word)) << word;
    }

  auto const each = [&](std::string const& situation, auto const& expect) {
    ASSERT_TRUE(all.contains(situation)) << situation;
    for (auto const& run : all.at(situation))
      expect(run, run.at("fate").template get<std::string>());
  };
  for (auto const& [situation, expected] :
       {std::pair{"Steps: dt 1e-300", "exact"},
        {"Steps: dt 1e-12", "exact"},
        {"Fields: A along m", "exact"},
        {"Lattices: 3e8 x 3e6", "refused"},
        {"Adaptive steps: A = 0", "exact"},
        {"Adaptive steps: A along m", "exact"},
        {"Adaptive steps: denormal", "exact"},
        {"Adaptive steps: dt 1e-300", "exact"},
        {"Adaptive steps: damping 1e12, min_dt 1e-3", "detected"},
        {"Adaptive steps: min_dt 3", "detected"},
        {"Adaptive steps: tolerance 1e-300", "refused"},
        {"States of rest: no field", "exact"},
        {"States of rest: field 1e-300", "exact"},
        {"States of rest: m along H", "exact"},
        {"States of rest: m against H", "bounded"},
        {"States of rest: one spin", "bounded"},
        {"States of rest: exchange 1e6", "bounded"},
        {"States of rest: exchange 1e300", "detected"},
        {"States of rest: field 1e30, bound 1e24", "bounded"},
        {"States of rest: field 1e300", "detected"},
        {"States of rest: bound 1e-200", "refused"},
        {"States of rest: NaN", "detected"}})
    each(situation,
         [&](Json const& run, std::string const& fate) { EXPECT_EQ(fate, expected) << run; });
  // Of such angles round-off decides, and with them whether an implicit step is solved.
  each("Turns: 1e160", [](Json const& run, std::string const&) {
    auto const message = run.at("message").get<std::string>();
    if (message.find("is not solved") != std::string::npos) return;
    EXPECT_LE(run.at("step"), 1) << run;  // -1 where nothing overflows
  });
  for (auto const* situation :
       {"on within a step", "damping 0", "damping 1e-12", "damping 1e12, dt 1e-13"})
    each(
        "Adaptive steps: " + std::string(situation), [&](Json const& run, std::string const& fate) {
          bool const may_rise = situation == std::string("damping 1e-12");
          EXPECT_TRUE(fate == "bounded" || (fate == "detected" && may_rise)) << run;
          bool const fine = situation == std::string("on within a step");
          EXPECT_LE(run.at("error").get<double>() * epsilon(run), 30 * (fine ? 1e-5 : 1e-4)) << run;
        });
  // The field's jump in the middle of a step: half a step's turn, at most.
  each("Fields: on within a step", [](Json const& run, std::string const& fate) {
    if (fate != "bounded" || is_body(run)) return;
    EXPECT_LE(run.at("error").get<double>() * epsilon(run), 1. / 128) << run;
  });
  for (auto const* section : {"Starts", "Adaptive steps"})
    each(section + std::string(": 1 + 1e-3"), [](Json const& run, std::string const& fate) {
      if (is_classical(run)) return;
      EXPECT_EQ(fate, "detected") << run;
      EXPECT_EQ(run.at("step"), 0) << run;
    });
  for (auto const& [situation, expected] : {std::pair{"Temperatures: T = 0", "exact"},
                                            {"Temperatures: T 1e-300", "exact"},
                                            {"Temperatures: T 1", "bounded"},
                                            {"Temperatures: T 1e3", "warned"},
                                            {"Temperatures: T 1e300", "refused"},
                                            {"Temperatures: field 1e-300", "bounded"},
                                            {"Temperatures: NaN", "detected"},
                                            {"Dear fields: dt 1e-300", "exact"},
                                            {"Dear fields: dt 1e-3", "bounded"},
                                            {"Dear fields: dt 1e8", "warned"},
                                            {"Dear fields: 1000 substeps", "bounded"},
                                            {"Dear fields: strength 1e-300", "exact"},
                                            {"Dear fields: NaN", "detected"}})
    each(situation, [&](Json const& run, std::string const& fate) {
      EXPECT_TRUE(fate == expected || (is_classical(run) && fate == "drifts")) << run;
      if (fate == "detected") {
        EXPECT_EQ(run.at("step"), 4) << run;
      }
    });
  for (auto const* section : {"Temperatures: NaN", "Dear fields: NaN"}) {
    std::set<std::string> tried;
    for (auto const& run : all.at(section)) tried.insert(run.at("method"));
    for (auto const* method : {"euler", "heun", "rkmk4", "rkmk5", "rkmk8", "cf4", "projected_rk4"})
      EXPECT_TRUE(tried.contains(method)) << section << ": " << method;
  }
  each("Faults: 64 spins",
       [](Json const& run, std::string const&) { EXPECT_EQ(run.at("step"), 4) << run; });
  each("Faults: 5000 spins", [](Json const& run, std::string const&) {
    EXPECT_GT(run.at("step"), 3) << run;
    EXPECT_LE(run.at("step"), 13) << run;
  });
}

// What the table calls warned and refused, as `run` says it.
TEST_F(Extremes, RunWarnsOfADtThatIsTooLarge) {
  for (auto const* method : {"ab2", "implicit_midpoint", "euler"}) {
    auto const outcome = run_into(
        "out.h5", macrospin_scene(),
        set(std::string("integrator={method='") + method + "',dt=3.0,steps=1,energy_guard=false}"));
    EXPECT_EQ(outcome.status, 0);
    EXPECT_TRUE(is_one_line(outcome.errors)) << outcome.errors;
    EXPECT_TRUE(contains_all(outcome.errors, {"warning: ", "integrator.dt"}));
  }
}

TEST_F(Extremes, ALatticeThatDoesNotFitIsRefusedWithItsNeed) {
  auto const outcome =
      expect_status(2, {"run", "chain.toml", "--set", "lattice={shape=[300000000,3000000]}"});
  EXPECT_TRUE(contains_all(outcome.errors, {"the run needs ", " of memory, ", "available"}));
}

// Minutes: ctest -C long -L long
TEST_F(Extremes, DISABLED_LongRuns) {
  auto const outcome = start({"extremes", "--long"});
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_TRUE(page().ends_with(outcome.output)) << outcome.output;
}

}  // namespace
}  // namespace cayspin::program::test
