// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/stage/update_compensated.hpp>

// Determines at compile time, from the tableau and the update, which arrays the stages of an
// explicit Runge-Kutta step read and write.
namespace cayspin::inline v0_2::detail {

/// Returns true for a chain: every stage uses only the increment of the stage before it, as in
/// tableau::Heun and tableau::Classical4.
template <class Tableau>
constexpr bool is_chain() {
  for (int i = 0; i < Tableau::stages; ++i)
    for (int j = 0; j < i; ++j)
      if ((Tableau::a[i][j] != 0) != (j == i - 1)) return false;
  return true;
}

/// True if the last stage evaluates the generator at the end of the step, so that the first stage
/// of the next step need not evaluate it.
template <class Tableau>
inline constexpr bool is_first_same_as_last = requires { Tableau::first_same_as_last; };

/// Returns true if a tableau has an error estimate that needs the increment of stage `source`.
template <class Tableau>
constexpr bool estimates_with(int source) {
  if constexpr (is_first_same_as_last<Tableau>) return Tableau::error[source] != 0;
  return false;
}

/// Returns the weight of increment `column` in the second rotation that leads to stage `row`, or to
/// the end of the step if `row` is Tableau::stages; 0 if the tableau has no second rotations.
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

/// True for chains of three or more stages whose increments depend on the previous increment. They
/// store two arrays: the last increment, and the weighted sum, which every second stage updates. No
/// other choice moves less memory.
template <class Tableau, class Update>
inline constexpr bool keeps_sum = Tableau::stages > 2 &&
                                  is_chain<Tableau>() && Update::increment_needs_argument;

/// Returns true for chains that store only spins. Their last stage recomputes the increment of each
/// stage from the spins of the next stage.
template <class Tableau, class Update>
constexpr bool recovers_increments() {
  if constexpr (requires { Update::recovers_increments(Tableau::stages); })
    return is_chain<Tableau>() && Update::recovers_increments(Tableau::stages);
  return false;
}

/// Returns true if stage `stage` reads the increment of stage `source`: for its own increment, for
/// the spins of the next stage or, in the last stage, for the end of the step.
template <class Tableau, class Update>
constexpr bool reads_increment(int stage, int source) {
  if (source >= stage || recovers_increments<Tableau, Update>()) return false;
  if (keeps_sum<Tableau, Update>) return source == stage - 1;
  bool const last = stage == Tableau::stages - 1;
  if (second_weight<Tableau>(stage + 1, source) != 0) return true;
  if (last && (Tableau::b[source] != 0 || estimates_with<Tableau>(source))) return true;
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

/// Returns the number of fields that hold the spins of stages.
template <class Tableau, class Update>
constexpr int level_fields() {
  if (recovers_increments<Tableau, Update>()) return Tableau::stages - 1;
  return Tableau::stages < 3 ? 1 : 2;
}

/// Returns the number of fields, of three numbers per site, that a method needs in addition to the
/// spins.
template <class Tableau, class Update>
constexpr int work_fields() {
  int const levels = level_fields<Tableau, Update>() + carried_fields<Update>();
  if (keeps_sum<Tableau, Update>) return levels + 2;
  int increments = 0;
  for (int stage = 0; stage + 1 < Tableau::stages; ++stage)
    increments += stores_increment<Tableau, Update>(stage);
  return levels + increments;
}

/// The arrays that stage `Stage` reads in addition to its own spins, and writes in addition to the
/// next spins.
template <class Tableau, class Update, int Stage>
struct StageDataFlow {
  static constexpr int stages = Tableau::stages;
  static constexpr int stage = Stage;
  static constexpr bool last = Stage + 1 == stages;
  static constexpr bool recovers = recovers_increments<Tableau, Update>();
  static constexpr bool reads_start = Stage > 0;
  static constexpr bool reads_sum = detail::reads_sum<Tableau, Update>(Stage);
  static constexpr bool writes_sum = detail::writes_sum<Tableau, Update>(Stage);
  static constexpr bool stores_increment =
      !last && detail::stores_increment<Tableau, Update>(Stage);
  static constexpr int carried = last ? carried_fields<Update>() : 0;
  /// The last stage that reads this stage's increment, or, by a method that recovers increments,
  /// the spins of the next stage in its place. This stage itself if none does.
  static constexpr int last_reader = [] {
    if (recovers) return Stage + 2 < stages ? stages - 1 : Stage;
    int reader = Stage;
    for (int later = Stage + 1; later < stages; ++later)
      if (detail::reads_increment<Tableau, Update>(later, Stage)) reader = later;
    return reader;
  }();
  /// Returns true if increment j is read or, by a method that recovers increments, the spins of
  /// stage j + 1 in its place.
  static constexpr bool reads_increment(int j) {
    return recovers ? last && j + 1 < Stage : detail::reads_increment<Tableau, Update>(Stage, j);
  }
};

}  // namespace cayspin::inline v0_2::detail
