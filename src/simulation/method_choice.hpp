// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/scene.hpp"

#include <cstdint>
#include <string>

namespace cayspin::simulation {

/// A method for a scene, without its steps: the keys of [integrator] that choose it.
struct MethodChoice {
  io::Method const* method = nullptr;
  io::Generator generator = io::Generator::standard;
  io::Isotropy isotropy = io::Isotropy::zero;
  double sigma = 0;
  io::Rotation rotation = io::Rotation::cayley;
  bool compensated = false;
  std::int64_t substeps = 0;  // between evaluations of an expensive field; 0: no such field

  /// Writes the choice into a scene's [integrator].
  void put_into(io::Integrator& integrator) const;

  /// Returns the keys as "key=value", separated by commas, without those that have their default.
  std::string keys() const;
};

}  // namespace cayspin::simulation
