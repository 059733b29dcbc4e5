// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "page.hpp"

namespace cayspin::extremes {
namespace {

constexpr char const* head = R"(# Tables of extreme inputs

These tables show how each method handles inputs that are tiny, huge or wrong; [the
report](extremes.md) has a summary. The test `extremes` computes all tables but the last, compares
them with this page, and checks most of the statements in the text before each table. The test
`extremes_long` computes and compares the last table. After a change of a method or of these tests,
`build/release/bin/test_extremes --write` rewrites this page in a few minutes.

| word | meaning |
|---|---|
| exact | the exact solution to round-off: 8 epsilon per step, plus 4 epsilon times the angle of rotation in radians |
| bounded | lengths change by at most 4 epsilon per step; directions have the error of the method |
| warned | `run` warns that dt is too large; the run stops with exit status 3, or keeps the lengths as in "bounded" (except with `classical_*`) |
| drifts | lengths are not kept, as documented for `classical_*` |
| refused | the scene is refused before the first step, with a one-line message |
| detected | the run stops with exit status 3 |

Here epsilon is the machine epsilon of the precision. Unless a table or its text says otherwise,
runs take six steps of dt = 1/128. If a cell has two words, the first is for double precision and
the second for single precision. Where a method behaves differently with different generators or
rotations, square brackets list those that the row is about. No run has a constant sigma.
)";

// Returns methods that take 1e8 steps in minutes.
std::vector<Integrator> simplest() {
  std::vector<Integrator> few;
  for (auto const& one : with_equal_steps())
    if (one.name() == "rkmk4" && one.generator == io::Generator::standard) few.push_back(one);
  return few;
}

// Returns the methods with constant steps whose scenes with this setting are not refused.
std::vector<Integrator> those_that_take(Setting const& setting) {
  Situation const situation{"", setting, setting};
  std::vector<Integrator> some;
  for (auto const& one : with_equal_steps())
    if (try_out(one, situation, Precision::double_precision).fate != Fate::refused)
      some.push_back(one);
  return some;
}

std::vector<Table> all_tables() {
  std::vector<Table> all;
  for (auto const& section : sections()) all.emplace_back(section, with_equal_steps());
  all.emplace_back(adaptive_steps(), with_adaptive_steps());
  all.emplace_back(temperatures(), those_that_take({.damping = 0.1, .temperature = 1}));
  all.emplace_back(expensive_fields(), those_that_take({.damping = 0.1, .multirate = 0.5}));
  all.emplace_back(equilibria(), std::vector{relaxation()});
  return all;
}

}  // namespace

std::vector<Table> const& tables() {
  static auto const all = all_tables();
  return all;
}

Table table_of_longest_runs() { return {longest_runs(), simplest()}; }

std::string page_of_tables() {
  std::string text = head;
  for (auto const& table : tables()) text += table.to_markdown();
  return text;
}

}  // namespace cayspin::extremes
