// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "page.hpp"

namespace cayspin::extremes {
namespace {

constexpr char const* head = R"(# Tables of extreme inputs

How each method handles inputs that are tiny, huge or wrong; [the report](extremes.md) has a
summary. The test `extremes` computes these tables and compares them with this page. It also checks
most of the statements above each table. `extremes_long` does the same for the last table. After a
change, `build/release/bin/test_extremes --write` writes this page again, in a few minutes.

| word | meaning |
|---|---|
| exact | the exact solution to round-off: 8 epsilon a step, plus 4 epsilon times the angle in radians |
| bounded | \| \|m\| - 1 \| is below 4 epsilon a step; the error is that of the method |
| warned | a warning says that dt is too large; except with `classical_*`, \|m\| is kept, or the run stops with status 3 |
| drifts | \|m\| is not kept, as documented for `classical_*` |
| refused | one line before the first step |
| detected | the run stops with status 3 |

Runs take six steps of 1/128, unless the table or its text says otherwise. Two words in a cell are
for double and single precision. Square brackets hold generators and rotations where not all behave
alike. Constant sigmas are not in the tables.
)";

// Methods that take 1e8 steps in minutes.
std::vector<Integrator> simplest() {
  std::vector<Integrator> few;
  for (auto const& one : with_equal_steps())
    if (one.name() == "rkmk4" && one.generator == io::Generator::standard) few.push_back(one);
  return few;
}

// Methods with constant steps whose scenes with this setting are not refused.
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
