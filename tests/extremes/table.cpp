// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "table.hpp"

#include "simulation/text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace cayspin::extremes {
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
  fmt::print(R"(# Behaviour at extreme inputs

`cayspin extremes` prints this page, `cayspin extremes --long` its last part. Tests hold the page
to the output, and every run to the promise above its table.

| word | meaning |
|---|---|
| exact | the exact solution to round-off: 8 epsilon a step, and 4 epsilon of the angle |
| bounded | \| \|m\| - 1 \| is below 4 epsilon a step; the error is that of the method |
| warned | dt is too large, says a warning; \|m\| is kept, or the run stops with status 3 |
| drifts | \|m\| is not kept, as `classical_*` say of themselves |
| refused | one line before the first step |
| detected | the run stops with status 3 |

Runs take six steps of 1/128 unless the table says otherwise. Two words are for double and single
precision. Brackets hold generators and rotations where not all behave alike. Constant sigmas
behave as zero does.

A program of your own has neither the warnings nor the guard. Where a table says warned or
detected, call `largest_stable_step` before the run, and `energy` and `norm_defect` during it.
)");
}

Table::Table(Section const& section, std::vector<Integrator> const& integrators)
    : section_(section), integrators_(integrators) {
  for (auto const& integrator : integrators)
    for (auto const& situation : section.situations)
      for (auto const precision : precisions) {
        runs_.push_back(
            {&integrator, &situation, precision, try_out(integrator, situation, precision)});
      }
}

bool Table::is_kept(Run const& run) const {
  auto const& promised = run.integrator->method->keeps_length ? section_.kept : section_.broken;
  if (run.outcome.fate == Fate::detected && run.outcome.step > run.situation->detected_by)
    return false;
  if (run.situation->against == Against::one_spin && run.integrator->method->by_colour &&
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
    auto const* integrator = runs_[i].integrator;
    std::vector<std::string> cells;
    for (; i < runs_.size() && runs_[i].integrator == integrator; i += 2) {
      auto const in_double = to_string(runs_[i].outcome.fate),
                 in_single = to_string(runs_[i + 1].outcome.fate);
      cells.push_back(in_double == in_single ? in_double : in_double + "; " + in_single);
    }
    auto found = std::ranges::find(rows, cells, &Row::cells);
    if (found == rows.end()) found = rows.insert(rows.end(), {{}, cells});
    found->integrators.push_back(integrator);
  }
  // What most do comes last, in a few words.
  auto const most =
      std::ranges::max_element(rows, {}, [](Row const& row) { return row.integrators.size(); });
  std::rotate(most, most + 1, rows.end());
  return rows;
}

std::string Table::names(Row const& row) const {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < row.integrators.size();) {
    auto const method = row.integrators[i]->name();
    std::vector<std::string> variants;
    for (; i < row.integrators.size() && row.integrators[i]->name() == method; ++i)
      variants.push_back(row.integrators[i]->variant());
    auto const all = std::ranges::count(integrators_, method, &Integrator::name);
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
        section_.title, run.situation->name, run.integrator->name(), run.integrator->variant(),
        to_string(run.precision), to_string(outcome.fate), outcome.step, outcome.steps,
        number(outcome.norm), number(outcome.error), quoted(outcome.message), is_kept(run));
  }
}

}  // namespace cayspin::extremes
