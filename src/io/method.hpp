// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/words.hpp"

#include <optional>
#include <span>
#include <string_view>

namespace cayspin::inline v0_2::io {

/// A variant of a method that `cayspin trade` tries.
enum class Trial { plain, in_chart, sigma, single_precision, compensated_single_precision };

/// Properties of a method that scenes may choose. src/simulation/method_list.hpp lists all methods.
struct Method {
  std::string_view word;              ///< integrator.method
  int order = 0;                      ///< order of convergence of trajectories
  std::optional<int> evaluations{};   ///< per step; empty if it iterates or chooses its steps
  bool adaptive = false;              ///< chooses its steps by integrator.tolerance
  bool automatic = false;             ///< stands for a method chosen to meet integrator.error
  bool keeps_length = true;           ///< |m| = 1 to round-off
  bool compensated = false;           ///< accepts integrator.compensated
  bool stiff = false;                 ///< exchange does not limit its steps
  bool differentiates_field = false;  ///< needs derivatives of H; refuses fields that depend on t
  bool corrects_energy = false;       ///< accepts Isotropy::energy for rigid bodies
  bool by_colour = false;             ///< moves the spins of one colour of a checkerboard at a time
  SetOf<Rotation> rotations{};        ///< empty for baselines and "auto"
  SetOf<Generator> generators{};      ///< empty for baselines and "auto"
  SetOf<Isotropy> isotropies{};       ///< apart from Isotropy::energy
  SetOf<Trial> trials{};

  /// Returns true for a baseline: a method that does not rotate spins, and so has no generator,
  /// isotropy or rotation.
  constexpr bool is_baseline() const { return rotations.empty() && !automatic; }
  /// Returns true for a method that takes constant steps of integrator.dt.
  constexpr bool has_equal_steps() const { return !adaptive && !automatic; }
  constexpr bool takes(Rotation rotation) const { return rotations.contains(rotation); }
  constexpr bool takes(Generator generator) const { return generators.contains(generator); }
  constexpr bool takes(Isotropy isotropy, SystemKind kind) const {
    return isotropy == Isotropy::energy ? corrects_energy && kind == SystemKind::rigid_body
                                        : isotropies.contains(isotropy);
  }
  /// Returns the rotation used if a scene gives none.
  constexpr Rotation usual_rotation() const {
    return takes(Rotation::cayley) || rotations.empty() ? Rotation::cayley : Rotation::exponential;
  }
};

/// All methods, in the order of the documentation.
std::span<Method const* const> methods();

/// Returns the method of this name, or nullptr.
Method const* find_method(std::string_view word);

}  // namespace cayspin::inline v0_2::io
