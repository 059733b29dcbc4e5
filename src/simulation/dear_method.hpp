// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/scene.hpp"
#include "plan.hpp"
#include "variant.hpp"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>

namespace cayspin::simulation {

/// Is a term of the scene's field dear? slab_demag.dear says so, demag is where the method can, and
/// a program's own nonlocal field where there are substeps.
bool has_dear_field(io::Scene const& scene);

/// Throws io::SceneError for substeps without a dear field, and for a dear field with what has to
/// see it at each stage, or remembers the stages of steps before.
void require_dear_field_fits(io::Scene const& scene, Variant const& variant);

/// An override by which no term is dear.
std::string without_dear(io::Scene const& scene);

/// The order in time of its interpolation: 4 for methods of a higher order, and for those of order
/// 4 where the damping is small, to which order 3 adds; otherwise 3.
int order_of_dear(io::Scene const& scene, Variant const& variant);
/// The method's order around a dear field.
inline int order_around_dear(io::Scene const& scene, Variant const& variant) {
  return std::min(variant.order, order_of_dear(scene, variant));
}
/// Fields of three numbers per site that the method keeps for a dear field.
inline std::int64_t work_fields_of_dear(io::Scene const& scene, Variant const& variant) {
  return order_of_dear(scene, variant) == 4 ? 6 : 4;
}

/// The method of the plan, in substeps between evaluations of a dear field where there is one.
std::unique_ptr<OpenMethod> open_method(io::Scene const& scene, Plan const& plan,
                                        AnySimulation simulation);

}  // namespace cayspin::simulation
