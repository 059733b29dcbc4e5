// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "table.hpp"

#include "../text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace cayspin::program::extremity {
namespace {

constexpr std::array precisions{Precision::double_precision, Precision::single_precision};

std::string number(double value) {
  return std::isfinite(value) ? fmt::format("{:.3g}", value) : "null";
}

/// Inside the quotes of JSON.
std::string quoted(std::string text) {
  text = one_line(text);
  std::ranges::replace(text, '"', '\'');
  std::ranges::replace(text, '\\', '/');
  return text;
}

std::string join(std::vector<std::string> const& parts) {
  return fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace

void print_head() {
  fmt::print(R"(# At the extremes

What every method does where numbers end, as `cayspin extremes` prints it, and at its end `cayspin extremes --long`.
Tests hold this page to what is printed, and every run to the promise above its table.

| word | meaning |
|---|---|
| exact | the exact solution to round-off: 8 epsilon a step, and 4 epsilon of the angle |
| bounded | \| \|m\| - 1 \| below 4 epsilon a step; off the exact solution by the method's error |
| warned | the program says beforehand that dt is too large; then \|m\| is kept as well, or the run is stopped with status 3 |
| drifts | `classical_*`, where nothing else is said: \|m\| is not kept |
| refused | in one line, before the first step |
| detected | stopped with status 3 |

Six steps of 1/128 where not said. Two words are for double and for single precision. In brackets are generators and
rotations, where not all fare alike. Constant sigmas fare as zero does. Methods that conserve the energy are run without
damping where that is not asked for. The adaptive methods have a table of their own.

A program of your own has neither warnings nor guard: where a table says warned or detected, ask `largest_stable_step`
beforehand, and `energy` and `norm_defect` on the way.
)");
}

Table::Table(Section const& section, std::vector<Choice> const& choices)
    : section_(section), choices_(choices) {
  for (auto const& choice : choices)
    for (auto const& situation : section.situations)
      for (auto const precision : precisions) {
        runs_.push_back({&choice, &situation, precision, try_out(choice, situation, precision)});
      }
}

bool Table::is_kept(Run const& run) const {
  auto const& promised = run.choice->is_classical() ? section_.broken : section_.kept;
  if (run.outcome.fate == Fate::detected && run.outcome.step > run.situation->detected_by)
    return false;
  if (run.situation->against == Against::one_spin && run.choice->takes_neighbors_apart() &&
      run.outcome.fate == Fate::bounded)
    return true;
  return std::ranges::find(promised, run.outcome.fate) != promised.end();
}

bool Table::is_kept() const {
  return std::ranges::all_of(runs_, [&](Run const& run) { return is_kept(run); });
}

std::vector<Table::Row> Table::rows() const {
  std::vector<Row> rows;
  for (std::size_t i = 0; i < runs_.size();) {
    auto const* choice = runs_[i].choice;
    std::vector<std::string> cells;
    for (; i < runs_.size() && runs_[i].choice == choice; i += 2) {
      auto const twice = to_string(runs_[i].outcome.fate),
                 once = to_string(runs_[i + 1].outcome.fate);
      cells.push_back(twice == once ? twice : twice + "; " + once);
    }
    auto found = std::ranges::find(rows, cells, &Row::cells);
    if (found == rows.end()) found = rows.insert(rows.end(), {{}, cells});
    found->choices.push_back(choice);
  }
  // What most do comes last, in a few words.
  auto const most =
      std::ranges::max_element(rows, {}, [](Row const& row) { return row.choices.size(); });
  std::rotate(most, most + 1, rows.end());
  return rows;
}

std::string Table::names(Row const& row) const {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < row.choices.size();) {
    auto const method = row.choices[i]->method();
    std::vector<std::string> variants;
    for (; i < row.choices.size() && row.choices[i]->method() == method; ++i)
      variants.push_back(row.choices[i]->variant());
    auto const all = std::ranges::count(choices_, method, &Choice::method);
    bool const whole = static_cast<std::int64_t>(variants.size()) == all;
    names.push_back(whole ? method : fmt::format("{} [{}]", method, join(variants)));
  }
  return join(names);
}

void Table::print_markdown() const {
  fmt::print("\n## {}\n{}\n\n| methods |", section_.title, section_.promise);
  for (auto const& situation : section_.situations) fmt::print(" {} |", situation.name);
  fmt::print("\n|---|");
  for (std::size_t i = 0; i < section_.situations.size(); ++i) fmt::print("---|");
  fmt::print("\n");
  auto const all = rows();
  for (auto const& row : all) {
    auto const name = &row != &all.back() ? names(row) : all.size() == 1 ? "all" : "all others";
    fmt::print("| {} | {} |\n", name, fmt::join(row.cells, " | "));
  }
}

void Table::print_json() const {
  for (auto const& run : runs_) {
    auto const& outcome = run.outcome;
    fmt::print(
        "{{\"section\": \"{}\", \"situation\": \"{}\", \"method\": \"{}\", \"variant\": \"{}\", "
        "\"precision\": \"{}\", \"fate\": \"{}\", \"step\": {}, \"steps\": {}, \"norm\": {}, "
        "\"error\": {}, \"message\": \"{}\", \"kept\": {}}}\n",
        section_.title, run.situation->name, run.choice->method(), run.choice->variant(),
        to_string(run.precision), to_string(outcome.fate), outcome.step, outcome.steps,
        number(outcome.norm), number(outcome.error), quoted(outcome.message), is_kept(run));
  }
}

}  // namespace cayspin::program::extremity
