// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "warning_of_columns.hpp"

#include "plan.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

namespace cayspin::simulation {
namespace {

/// For each column, a bound on the part of the field that differs between columns, and the damping.
/// Both are empty if columns differ in neither.
struct FieldsAndDampings {
  std::vector<double> fields, dampings;

  FieldsAndDampings(io::Scene const& one, io::Columns const& values)
      : fields(std::max({values.dampings.size(), values.applied.size(), values.constants.size()})),
        dampings(values.dampings) {
    if (dampings.empty()) dampings.assign(fields.size(), one.system.damping);
    for (std::size_t column = 0; column < fields.size(); ++column) {
      if (!values.applied.empty()) {
        auto const& [x, y, z] = values.applied[column];
        fields[column] += std::abs(one.field.mu0) * std::hypot(x, y, z);
      }
      if (!values.constants.empty())
        for (double const constant : values.constants[column]) fields[column] += std::abs(constant);
    }
  }

  /// Adds each column unless another one has both a larger field and a larger damping (if `sign` is
  /// -1, a smaller one).
  void add_largest(double sign, std::set<std::size_t>& columns) const {
    auto const damping = [&](std::size_t column) { return sign * dampings[column]; };
    std::vector<std::size_t> by_field(fields.size());
    std::iota(by_field.begin(), by_field.end(), std::size_t{0});
    std::ranges::stable_sort(by_field, std::greater(), [&](std::size_t column) {
      return std::pair(fields[column], damping(column));
    });
    double most = -std::numeric_limits<double>::infinity();
    for (auto const column : by_field) {
      if (damping(column) <= most) continue;
      most = damping(column);
      columns.insert(column);
    }
  }
};

}  // namespace

std::optional<ColumnWarning> warning_of_columns(io::Scene const& one, io::Columns const& values,
                                                Precision precision) {
  auto const features = features_of(one, one.integrator.tolerance);
  auto const warning_of = [&](io::Scene scene) {
    scene.integrator.refuse_unstable = false;
    return dt_warning_of_run(scene, make_plan(scene, precision, features));
  };
  auto const scene_of = [&](std::size_t column) {
    auto scene = one;
    values.put(column, scene);
    return scene;
  };
  auto const heats = values.heats();
  FieldsAndDampings const of_columns(one, values);
  std::set<std::size_t> columns;
  if (!heats.empty())
    columns.insert(static_cast<std::size_t>(std::ranges::max_element(heats) - heats.begin()));
  if (auto const& [fields, dampings] = of_columns; !fields.empty()) {
    // add_largest may add all columns. It is not needed if the largest field needs no warning with
    // the largest damping, and none with the smallest.
    auto worst =
        scene_of(static_cast<std::size_t>(std::ranges::max_element(fields) - fields.begin()));
    worst.thermal.reset();
    auto const has_warning = [&](double damping) {
      worst.system.damping = damping;
      return warning_of(worst).has_value();
    };
    if (has_warning(std::ranges::max(dampings)) || has_warning(std::ranges::min(dampings)))
      for (double const sign : {1.0, -1.0}) of_columns.add_largest(sign, columns);
  } else if (heats.empty()) {
    columns.insert(0);
  }
  for (auto const column : columns)
    if (auto const text = warning_of(scene_of(column))) return ColumnWarning{column, *text};
  return std::nullopt;
}

}  // namespace cayspin::simulation
