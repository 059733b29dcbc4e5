// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "trial.hpp"

#include <string>
#include <vector>

namespace cayspin::extremes {

/// Results of every integrator in the situations of a section, in both precisions.
class Table {
 public:
  Table(Section section, std::vector<Integrator> integrators);
  Table(Table&&) = default;
  Table(Table const&) = delete;  // runs_ points into it

  struct Run {
    Integrator const* integrator;
    Situation const* situation;
    Precision precision;
    Outcome outcome;
  };

  Section const& section() const { return section_; }
  /// Returns the runs by integrator and situation, double before single.
  std::vector<Run> const& runs() const { return runs_; }
  /// Returns true if the run keeps the section's promise.
  bool is_kept(Run const& run) const;
  /// Returns the title, the promise, and a table with one row for all integrators with equal
  /// results.
  std::string to_markdown() const;

 private:
  struct Row {
    std::vector<Integrator const*> integrators;
    std::vector<std::string> cells;
  };

  std::vector<Row> rows() const;
  std::string names(Row const& row) const;

  Section section_;
  std::vector<Integrator> integrators_;
  std::vector<Run> runs_;
};

}  // namespace cayspin::extremes
