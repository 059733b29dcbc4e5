// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "../method.hpp"
#include "../plan.hpp"

#include <string>
#include <vector>

namespace cayspin::program::extremity {

/// One integrator as a scene can ask for it.
struct Choice {
  MethodEntry const* entry;
  io::Generator generator;
  io::Rotation rotation;

  bool is_adaptive() const { return io::is_adaptive(entry->key.method); }
  bool is_baseline() const { return io::is_baseline(entry->key.method); }
  bool is_classical() const { return io::is_classical(entry->key.method); }
  /// Neighbours count as they were, or as they are foretold, while a spin moves.
  bool takes_neighbors_apart() const {
    auto const method = entry->key.method;
    return io::is_red_black(method) || method == io::Method::fx3 || method == io::Method::fx4;
  }
  bool of_rigid_bodies() const { return entry->key.rigid_body; }

  /// The method with its isotropy, and with its chart.
  std::string method() const;
  /// Generator and rotation, where the method takes some.
  std::string variant() const;
  /// Lines of a scene's [integrator].
  std::string toml() const;
};

/// Every method of the program that takes steps of dt, with every generator and rotation it takes.
std::vector<Choice> fixed_step_choices();

/// The same of those that choose their steps.
std::vector<Choice> adaptive_choices();

}  // namespace cayspin::program::extremity
