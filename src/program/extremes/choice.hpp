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

  bool is_baseline() const { return io::is_baseline(entry->key.method); }
  bool is_classical() const { return io::is_classical(entry->key.method); }
  bool of_rigid_bodies() const { return entry->key.rigid_body; }

  /// The method with its isotropy, and with its chart.
  std::string method() const;
  /// Generator and rotation, where the method takes some.
  std::string variant() const;
  /// Lines of a scene's [integrator].
  std::string toml() const;
};

/// Every method of the program with every generator and rotation it takes.
std::vector<Choice> all_choices();

}  // namespace cayspin::program::extremity
