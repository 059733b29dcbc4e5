// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/given.hpp"
#include "io/initial_state.hpp"
#include "io/key.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <variant>

namespace cayspin::inline v0_2::io {

/// All spins along one direction.
struct UniformStart {
  Triple direction = {};  ///< unit vector
};
/// An expression for each component; each spin is normalised.
struct ExpressionStart {
  /// Expressions in x, y, z, i, j, k; for a crystal also in s.
  std::array<std::string, 3> components;
};
/// Random spins, distributed uniformly on the sphere.
struct RandomStart {
  std::int64_t seed = 0;
};
/// The last frame of an HDF5 file, or an OVF file; each spin is normalised.
struct FileStart {
  std::filesystem::path path;  ///< HDF5 with dataset /spins, or OVF
};
/// Spins that a program passes with the text of a scene; each is normalised.
struct GivenStart {
  GivenNumbers spins;  ///< sites x 3, in the order of initial_spins
};

/// The table [initial].
using Initial =
    std::variant<UniformStart, ExpressionStart, RandomStart, FileStart, GivenStart, InitialState>;

}  // namespace cayspin::inline v0_2::io
