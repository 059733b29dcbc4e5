// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <utility>

namespace cayspin::extremes {
namespace {

constexpr std::array precisions{Precision::double_precision, Precision::single_precision};

std::string join(std::vector<std::string> const& parts, char const* separator = ", ") {
  return fmt::format("{}", fmt::join(parts, separator));
}

}  // namespace

Table::Table(Section section, std::vector<Integrator> integrators)
    : section_(std::move(section)), integrators_(std::move(integrators)) {
  for (auto const& integrator : integrators_)
    for (auto const& situation : section_.situations)
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
  // The row with the most integrators comes last, as "all others".
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

std::string Table::to_markdown() const {
  auto text = fmt::format("\n## {}\n{}\n\n| methods |", section_.title, section_.promise);
  for (auto const& situation : section_.situations) text += fmt::format(" {} |", situation.name);
  text += "\n|---|";
  for (std::size_t i = 0; i < section_.situations.size(); ++i) text += "---|";
  text += '\n';
  auto const all = rows();
  for (auto const& row : all) {
    auto const name = &row != &all.back() ? names(row) : all.size() == 1 ? "all" : "all others";
    text += fmt::format("| {} | {} |\n", name, join(row.cells, " | "));
  }
  return text;
}

}  // namespace cayspin::extremes
