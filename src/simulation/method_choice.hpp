// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/scene.hpp"

#include <cstdint>
#include <string>

namespace cayspin::simulation {

/// What integrates a scene, its steps left open: the words of [integrator] that say so.
struct MethodChoice {
  io::Method const* method = nullptr;
  io::Generator generator = io::Generator::standard;
  io::Isotropy isotropy = io::Isotropy::zero;
  double sigma = 0;
  io::Rotation rotation = io::Rotation::cayley;
  bool compensated = false;
  std::int64_t substeps = 0;  // between evaluations of a dear field; 0: no field is dear

  /// Puts it into a scene's [integrator].
  void put_into(io::Integrator& integrator) const;

  /// Keys of [integrator], "key=value" with commas between them. Those of defaults are left out.
  std::string keys() const;
};

}  // namespace cayspin::simulation
