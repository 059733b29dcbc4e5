// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The tables equal those of docs/reports/extremes_tables.md, and every run keeps the promise of its
// table.
#include "io/method.hpp"
#include "page.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <utility>

namespace cayspin::extremes {
namespace {

using enum Fate;
using Expected = std::pair<char const*, Fate>;  // a situation, and the fate of its runs

std::string page() {
  std::ifstream file(CAYSPIN_PAGE);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Returns all runs, by "section: situation".
std::map<std::string, std::vector<Table::Run>> const& runs() {
  static auto const all = [] {
    std::map<std::string, std::vector<Table::Run>> by_situation;
    for (auto const& table : tables())
      for (auto const& run : table.runs())
        by_situation[table.section().title + ": " + run.situation->name].push_back(run);
    return by_situation;
  }();
  return all;
}

double epsilon(Table::Run const& run) {
  return run.precision == Precision::double_precision ? std::numeric_limits<double>::epsilon()
                                                      : std::numeric_limits<float>::epsilon();
}

bool is_classical(Table::Run const& run) { return run.integrator->name().starts_with("classical"); }

std::string description(Table::Run const& run) {
  auto const& outcome = run.outcome;
  return fmt::format("{} {}, {}: {}, stopped at step {}, | |m| - 1 | {} and error {} epsilons, {}",
                     run.integrator->name(), run.integrator->variant(), to_string(run.precision),
                     to_string(outcome.fate), outcome.step, outcome.norm, outcome.error,
                     outcome.message);
}

/// Calls expect(run) for each run in a situation.
template <class Expect>
void for_each_run(std::string const& situation, Expect const& expect) {
  SCOPED_TRACE(situation);
  ASSERT_TRUE(runs().contains(situation));
  for (auto const& run : runs().at(situation)) {
    SCOPED_TRACE(description(run));
    expect(run);
  }
}

/// Returns the names of the methods with adaptive steps, or of those with constant steps.
std::vector<std::string> words_of_methods(bool adaptive) {
  std::vector<std::string> all;
  for (auto const* const method : io::methods())
    if (!method->automatic && method->adaptive == adaptive) all.emplace_back(method->word);
  return all;
}

TEST(Extremes, TablesAreThoseOfThePage) {
  auto const text = page_of_tables();
  EXPECT_TRUE(page().starts_with(text))
      << CAYSPIN_PAGE << " is written by test_extremes --write and begins with:\n"
      << text;
}

TEST(Extremes, RunsKeepTheirPromises) {
  for (auto const& table : tables())
    for (auto const& run : table.runs()) {
      SCOPED_TRACE(table.section().title + ": " + run.situation->name);
      SCOPED_TRACE(description(run));
      EXPECT_TRUE(table.is_kept(run));
    }
}

TEST(Extremes, FatesAgreeWithTheNumbers) {
  for (auto const& entry : runs())
    for_each_run(entry.first, [](Table::Run const& run) {
      auto const& [fate, step, steps, norm, error, message] = run.outcome;
      EXPECT_TRUE(fate != drifts || is_classical(run));
      if (fate == detected) {
        EXPECT_GE(step, 0);
      }
      if (step >= 0 || fate == refused) {
        EXPECT_FALSE(message.empty());
      } else if (!is_classical(run)) {
        EXPECT_LE(norm, 4.0 * static_cast<double>(steps + 1));
      }
    });
}

TEST(Extremes, TablesHaveEveryMethod) {
  for (auto const& table : tables()) {
    auto const& title = table.section().title;
    if (title == "Temperatures" || title == "Expensive fields" || title == "Equilibria") continue;
    for (auto const& word : words_of_methods(title == "Adaptive steps")) {
      auto const is_of_method = [&](Table::Run const& run) {
        return run.integrator->method->word == word;
      };
      EXPECT_TRUE(std::ranges::any_of(table.runs(), is_of_method)) << title << ": " << word;
    }
  }
  for (auto const* situation : {"Temperatures: NaN", "Expensive fields: NaN"}) {
    std::set<std::string> tried;
    for_each_run(situation, [&](Table::Run const& run) { tried.insert(run.integrator->name()); });
    for (auto const* method : {"euler", "heun", "rkmk4", "rkmk5", "rkmk8", "cf4", "projected_rk4"})
      EXPECT_TRUE(tried.contains(method)) << situation << ": " << method;
  }
}

TEST(Extremes, RunsFareAsTheirSituationAllows) {
  for (auto const& expected :
       std::initializer_list<Expected>{{"Steps: dt 1e-300", exact},
                                       {"Steps: dt 1e-12", exact},
                                       {"Fields: A along m", exact},
                                       {"Lattices: 3e8 x 3e6", refused},
                                       {"Adaptive steps: A = 0", exact},
                                       {"Adaptive steps: A along m", exact},
                                       {"Adaptive steps: denormal", exact},
                                       {"Adaptive steps: dt 1e-300", exact},
                                       {"Adaptive steps: damping 1e12, min_dt 1e-3", detected},
                                       {"Adaptive steps: min_dt 3", detected},
                                       {"Adaptive steps: tolerance 1e-300", refused},
                                       {"Equilibria: no field", exact},
                                       {"Equilibria: field 1e-300", exact},
                                       {"Equilibria: m along H", exact},
                                       {"Equilibria: m against H", bounded},
                                       {"Equilibria: one spin", bounded},
                                       {"Equilibria: exchange 1e6", bounded},
                                       {"Equilibria: exchange 1e300", detected},
                                       {"Equilibria: field 1e30, bound 1e24", bounded},
                                       {"Equilibria: field 1e300", detected},
                                       {"Equilibria: bound 1e-200", refused},
                                       {"Equilibria: NaN", detected}})
    for_each_run(expected.first,
                 [&](Table::Run const& run) { EXPECT_EQ(run.outcome.fate, expected.second); });
  for (auto const& expected :
       std::initializer_list<Expected>{{"Temperatures: T = 0", exact},
                                       {"Temperatures: T 1e-300", exact},
                                       {"Temperatures: T 1", bounded},
                                       {"Temperatures: T 1e3", warned},
                                       {"Temperatures: T 1e300", refused},
                                       {"Temperatures: field 1e-300", bounded},
                                       {"Temperatures: NaN", detected},
                                       {"Expensive fields: dt 1e-300", exact},
                                       {"Expensive fields: dt 1e-3", bounded},
                                       {"Expensive fields: dt 1e8", warned},
                                       {"Expensive fields: 1000 substeps", bounded},
                                       {"Expensive fields: strength 1e-300", exact},
                                       {"Expensive fields: NaN", detected}})
    for_each_run(expected.first, [&](Table::Run const& run) {
      auto const fate = run.outcome.fate;
      EXPECT_TRUE(fate == expected.second || (is_classical(run) && fate == drifts));
      if (fate == detected) {
        EXPECT_EQ(run.outcome.step, 4);
      }
    });
}

TEST(Extremes, ErrorsAreBounded) {
  for (std::string const situation :
       {"on within a step", "damping 0", "damping 1e-12", "damping 1e12, dt 1e-13"})
    for_each_run("Adaptive steps: " + situation, [&](Table::Run const& run) {
      auto const fate = run.outcome.fate;
      bool const may_rise = situation == "damping 1e-12";
      EXPECT_TRUE(fate == bounded || (fate == detected && may_rise));
      bool const fine = situation == "on within a step";
      EXPECT_LE(run.outcome.error * epsilon(run), 30 * (fine ? 1e-5 : 1e-4));
    });
  // The field jumps in the middle of a step: the error is at most the turn of one step.
  for_each_run("Fields: on within a step", [](Table::Run const& run) {
    if (run.outcome.fate != bounded || run.integrator->of_rigid_bodies) return;
    EXPECT_LE(run.outcome.error * epsilon(run), 1. / 128);
  });
}

TEST(Extremes, FaultsAreDetectedAtOnce) {
  // At such angles round-off decides the result, and whether an implicit step is solved.
  for_each_run("Turns: 1e160", [](Table::Run const& run) {
    if (run.outcome.message.find("is not solved") != std::string::npos) return;
    EXPECT_LE(run.outcome.step, 1);  // -1 if nothing overflows
  });
  for (auto const* situation : {"Starts: 1 + 1e-3", "Adaptive steps: 1 + 1e-3"})
    for_each_run(situation, [](Table::Run const& run) {
      if (is_classical(run)) return;
      EXPECT_EQ(run.outcome.fate, detected);
      EXPECT_EQ(run.outcome.step, 0);
    });
  for_each_run("Faults: 64 spins", [](Table::Run const& run) { EXPECT_EQ(run.outcome.step, 4); });
  for_each_run("Faults: 5000 spins", [](Table::Run const& run) {
    EXPECT_GT(run.outcome.step, 3);
    EXPECT_LE(run.outcome.step, 13);
  });
}

// Takes minutes; run by ctest -C long -L long.
TEST(Extremes, LongestRunsKeepTheirPromise) {
  auto const table = table_of_longest_runs();
  for (auto const& run : table.runs()) EXPECT_TRUE(table.is_kept(run)) << description(run);
  EXPECT_TRUE(page().ends_with(table.to_markdown())) << table.to_markdown();
}

}  // namespace
}  // namespace cayspin::extremes
