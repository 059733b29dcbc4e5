// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/method.hpp"

#include <string>
#include <vector>

namespace cayspin::test {

/// A combination of method, generator, isotropy and rotation in a scene.
struct MethodChoice {
  io::Method const& method;
  io::Generator generator;
  io::Isotropy isotropy;
  io::Rotation rotation;

  bool is_default() const {
    return generator == io::Generator::standard && isotropy == io::Isotropy::zero &&
           rotation == io::Rotation::cayley;
  }
  bool has_meaning(io::SystemKind kind) const {
    if (method.by_colour && kind != io::SystemKind::llg) return false;
    if (method.is_baseline()) return is_default();
    bool const needs_cayley =
        isotropy == io::Isotropy::energy || generator == io::Generator::tangent;
    if (needs_cayley && rotation != io::Rotation::cayley) return false;
    if (generator == io::Generator::tangent && isotropy != io::Isotropy::zero) return false;
    return method.takes(rotation) && method.takes(generator) && method.takes(isotropy, kind);
  }

  /// Returns KEY=VALUE overrides; for a baseline only the method and, if it is adaptive, a
  /// tolerance.
  std::vector<std::string> overrides() const {
    auto const word = [](auto value) { return "'" + std::string(to_string(value)) + "'"; };
    std::vector<std::string> all{"integrator.method='" + std::string(method.word) + "'"};
    if (method.adaptive) all.emplace_back("integrator.tolerance=1e-4");
    if (method.is_baseline()) return all;
    all.push_back("integrator.generator=" + word(generator));
    all.push_back("integrator.isotropy=" +
                  (isotropy == io::Isotropy::constant ? "{constant=0.7}" : word(isotropy)));
    all.push_back("integrator.rotation=" + word(rotation));
    return all;
  }
};

/// Calls work(choice) for each combination with a method on the group, and once for each baseline.
template <class Work>
void for_each_method_choice(Work const& work) {
  for (auto const* const method : io::methods())
    for (auto const& generator : io::words<io::Generator>())
      for (auto const& isotropy : io::words<io::Isotropy>())
        for (auto const& rotation : io::words<io::Rotation>()) {
          MethodChoice const choice{*method, generator.value, isotropy.value, rotation.value};
          if (!method->is_baseline() || choice.is_default()) work(choice);
        }
}

}  // namespace cayspin::test
