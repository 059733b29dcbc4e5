// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "trial.hpp"

#include <vector>

namespace cayspin::extremes {

void print_head();

/// What became of every integrator in the situations of a section, in both precisions.
class Table {
 public:
  Table(Section const& section, std::vector<Integrator> const& integrators);

  bool is_kept() const;
  /// The promise, and one row for all integrators that fare alike.
  void print_markdown() const;
  /// One line, an object, for each run.
  void print_json() const;

 private:
  struct Run {
    Integrator const* integrator;
    Situation const* situation;
    Precision precision;
    Outcome outcome;
  };
  struct Row {
    std::vector<Integrator const*> integrators;
    std::vector<std::string> cells;
  };

  bool is_kept(Run const& run) const;
  std::vector<Row> rows() const;
  std::string names(Row const& row) const;

  Section const& section_;
  std::vector<Integrator> const& integrators_;
  /// Integrator by integrator, situation by situation, double before single.
  std::vector<Run> runs_;
};

}  // namespace cayspin::extremes
