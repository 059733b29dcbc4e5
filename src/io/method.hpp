// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/words.hpp"

#include <optional>
#include <span>
#include <string_view>

namespace cayspin::inline v0_1::io {

/// A way in which `cayspin trade` tries a method.
enum class Trial { plain, in_chart, sigma, single_precision, compensated_single_precision };

/// What is known of a method of scenes. All methods stand in src/simulation/method_list.hpp.
struct Method {
  std::string_view word;              ///< integrator.method
  int order = 0;                      ///< of trajectories
  std::optional<int> evaluations{};   ///< per step; none where it iterates or chooses its steps
  bool adaptive = false;              ///< chooses its steps by integrator.tolerance
  bool automatic = false;             ///< stands for another method, chosen by integrator.error
  bool keeps_length = true;           ///< |m| = 1 to round-off
  bool compensated = false;           ///< takes integrator.compensated
  bool stiff = false;                 ///< takes steps that exchange does not limit
  bool differentiates_field = false;  ///< refuses fields that depend on t
  bool corrects_energy = false;       ///< takes the isotropy energy on rigid bodies
  bool by_colour = false;             ///< moves the spins of one colour of a checkerboard at a time
  SetOf<Rotation> rotations{};        ///< none: a baseline
  SetOf<Generator> generators{};      ///< none: a baseline
  SetOf<Isotropy> isotropies{};       ///< but for energy
  SetOf<Trial> trials{};

  /// Outside the Lie group: takes neither generator, isotropy nor rotation.
  constexpr bool is_baseline() const { return rotations.empty() && !automatic; }
  /// Takes equal steps of integrator.dt.
  constexpr bool has_equal_steps() const { return !adaptive && !automatic; }
  constexpr bool takes(Rotation rotation) const { return rotations.contains(rotation); }
  constexpr bool takes(Generator generator) const { return generators.contains(generator); }
  constexpr bool takes(Isotropy isotropy, SystemKind kind) const {
    return isotropy == Isotropy::energy ? corrects_energy && kind == SystemKind::rigid_body
                                        : isotropies.contains(isotropy);
  }
  /// The rotation of a scene that names none.
  constexpr Rotation usual_rotation() const {
    return takes(Rotation::cayley) || rotations.empty() ? Rotation::cayley : Rotation::exponential;
  }
};

/// All methods, in the order of the documentation.
std::span<Method const* const> methods();

/// The method of this word, or nullptr.
Method const* find_method(std::string_view word);

}  // namespace cayspin::inline v0_1::io
