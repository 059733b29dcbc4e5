// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/rows.hpp>
#include <cayspin/stage/update_compensated.hpp>

// What an explicit Runge-Kutta method keeps between its stages: found from the tableau and the
// geometry when compiled.
namespace cayspin::detail {

/// Every stage starts from the increment before it alone, as in the classical Runge-Kutta methods.
template <class Tableau>
constexpr bool is_chain() {
  for (int i = 0; i < Tableau::stages; ++i)
    for (int j = 0; j < i; ++j)
      if ((Tableau::a[i][j] != 0) != (j == i - 1)) return false;
  return true;
}

/// The last stage is at the end of the step, for the next step to begin with.
template <class Tableau>
inline constexpr bool is_first_same_as_last = requires {
  Tableau::first_same_as_last;
};

/// Weights of the rotation that follows the first one, where a tableau has such: row `stages` for
/// the end of the step.
template <class Tableau>
constexpr double second_weight(int row, int column) {
  if constexpr (requires { Tableau::second_a; })
    return row < Tableau::stages ? Tableau::second_a[row][column] : Tableau::second_b[column];
  return 0;
}
template <class Tableau>
constexpr bool has_second_rotation(int row) {
  for (int j = 0; j < row && j < Tableau::stages; ++j)
    if (second_weight<Tableau>(row, j) != 0) return true;
  return false;
}

/// In a chain that needs its increments as arguments, one array holds the last increment and one
/// the weighted sum, brought up to date at every second stage: the least that can be moved.
template <class Tableau, class Update>
inline constexpr bool keeps_sum = Tableau::stages > 2 &&
                                  is_chain<Tableau>() && Update::increment_needs_argument &&
                                  !Update::keeps_generators;

/// In a chain on a chart, each increment is read back from the spins of the stage after it: stages
/// store their spins alone.
template <class Tableau, class Update>
constexpr bool recovers_increments() {
  if constexpr (requires { Update::has_chart; })
    return Update::has_chart && Tableau::stages > 1 && is_chain<Tableau>();
  return false;
}

/// Does stage `stage` (or the end of the step behind the last one) read the increment of `source`?
template <class Tableau, class Update>
constexpr bool reads_increment(int stage, int source) {
  if (source >= stage || recovers_increments<Tableau, Update>()) return false;
  if (keeps_sum<Tableau, Update>) return source == stage - 1;
  bool const last = stage == Tableau::stages - 1;
  if (second_weight<Tableau>(stage + 1, source) != 0) return true;
  if (last && (Tableau::b[source] != 0 || Update::keeps_generators)) return true;
  if (!last && Tableau::a[stage + 1][source] != 0) return true;
  return Update::increment_needs_argument && Tableau::a[stage][source] != 0;
}

template <class Tableau, class Update>
constexpr bool stores_increment(int source) {
  for (int stage = source + 1; stage < Tableau::stages; ++stage)
    if (reads_increment<Tableau, Update>(stage, source)) return true;
  return false;
}

template <class Tableau, class Update>
constexpr bool writes_sum(int stage) {
  return keeps_sum<Tableau, Update> && stage % 2 == 1 && stage + 1 < Tableau::stages;
}
template <class Tableau, class Update>
constexpr bool reads_sum(int stage) {
  return keeps_sum<Tableau, Update> && stage > 1 &&
         (stage % 2 == 1 || stage + 1 == Tableau::stages);
}

/// Fields of three numbers per site that a method needs beside the spins.
template <class Tableau, class Update>
constexpr int level_fields() {
  if (recovers_increments<Tableau, Update>()) return Tableau::stages - 1;
  return Tableau::stages < 3 ? 1 : 2;
}
template <class Tableau, class Update>
constexpr int work_fields() {
  int const levels = level_fields<Tableau, Update>() + is_compensated<Update>;
  if (keeps_sum<Tableau, Update>) return levels + 2;
  int increments = 0;
  for (int stage = 0; stage + 1 < Tableau::stages; ++stage)
    increments += stores_increment<Tableau, Update>(stage);
  return levels + increments;
}

/// The rows that a stage reads and writes.
template <class Real, int Stages>
struct StageRows {
  RowInput<Real> start;                                    // spins at the begin of the step
  RowStencil<Real> level;                                  // spins of this stage
  RowInput<Real> increments[Stages > 1 ? Stages - 1 : 1];  // of earlier stages, or their spins
  RowInput<Real> sum_before;                               // of weighted increments
  RowOutput<Real> sum;
  RowOutput<Real> increment;       // of this stage
  RowOutput<Real> next;            // spins of the next stage, or of the end
  RowInput<Real> residual_before;  // what the rounding of `start` left over
  RowOutput<Real> residual;        // what the rounding of the end leaves over
};

}  // namespace cayspin::detail
