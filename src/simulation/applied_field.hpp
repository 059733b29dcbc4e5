// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/expression.hpp"
#include "io/field.hpp"
#include "io/units.hpp"

#include <cayspin/vec3.hpp>

#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <variant>

namespace cayspin::simulation {

/// The uniform field mu0 * applied(t) of a scene, or another vector whose components are numbers or
/// expressions in t.
class AppliedField {
 public:
  /// `units`: the scene's, for error messages.
  explicit AppliedField(io::Field const& field, io::Units const& units = {});
  AppliedField(std::array<io::AppliedComponent, 3> const& components, std::string key,
               io::Units const& units = {});

  /// Returns the same field with other components, which do not depend on t.
  AppliedField with(io::Triple const& components) const {
    auto other = *this;
    for (std::size_t c = 0; c < 3; ++c) other.components_[c] = components[c];
    return other;
  }

  bool present() const { return present_; }
  bool depends_on_time() const { return depends_on_time_; }

  /// Returns mu0 * applied(t). Throws NumbersFailed if a component is not finite at t.
  Vec3<double> operator()(double t) const;

 private:
  std::array<std::variant<double, io::Expression>, 3> components_;
  std::function<std::array<double, 3>(double t)> own_;
  double mu0_ = 1;
  bool present_ = true, depends_on_time_ = false;
  std::string key_ = "field.applied";
  io::Units units_;
};

}  // namespace cayspin::simulation
