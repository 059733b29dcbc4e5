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

/// Returns true if a term of the scene's field is multirate: slab_demag if slab_demag.multirate is
/// true, demag if demag.multirate is true or, by default, if the method and the rest of the scene
/// support it, and a program's own nonlocal field if there are substeps.
bool has_slow_field(io::Scene const& scene);

/// Throws io::SceneError for substeps without an expensive field; for demag.multirate = false with
/// substeps and a program's own nonlocal field; and for an expensive field with energy control, a
/// temperature, or a method that needs the field at each stage, remembers earlier steps, iterates
/// or chooses its steps.
void require_slow_field_fits(io::Scene const& scene, Variant const& variant);

/// Returns an override, KEY=VALUE, with which the scene's slab_demag, demag or dipoles is not
/// multirate.
std::string without_multirate(io::Scene const& scene);

/// Returns the order in time to which an expensive field is interpolated: 4 for methods of order 5
/// and higher, and also for those of order 4 if the damping is small, because order 3 would add to
/// the damping; otherwise 3.
int order_of_multirate(io::Scene const& scene, Variant const& variant);
/// Returns the order of the method in a scene with an expensive field.
inline int order_with_multirate(io::Scene const& scene, Variant const& variant) {
  return std::min(variant.order, order_of_multirate(scene, variant));
}
/// Returns how many fields of three numbers per site the method stores for an expensive field.
inline std::int64_t work_fields_of_multirate(io::Scene const& scene, Variant const& variant) {
  return order_of_multirate(scene, variant) == 4 ? 6 : 4;
}

/// Opens the plan's method. If the scene has an expensive field, the method takes substeps between
/// evaluations of that field.
std::unique_ptr<OpenMethod> open_method(io::Scene const& scene, Plan const& plan,
                                        AnySimulation simulation);

}  // namespace cayspin::simulation
