// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <array>
#include <cstdint>
#include <functional>

namespace cayspin::inline v0_2::io {

/// Vectors of all sites in host memory. Component c of site (i, j, k) is at
///   data + k * strides[0] + j * strides[1] + i * strides[2] + c * strides[3],
/// counted in numbers, not bytes.
struct HostVectors {
  void* data = nullptr;
  bool is_double = true;                ///< true: double; false: float
  std::array<std::int64_t, 3> shape{};  ///< nz, ny, nx
  std::array<std::int64_t, 4> strides{};
};

/// Fields that a program adds to its scene; they are not stored in files. Both functions are called
/// on the host, by the stepping thread; an exception from them ends the run.
struct OwnField {
  /// Returns the uniform field at t. It takes the place of field.applied, which must not be set,
  /// and is multiplied by mu0, too.
  std::function<std::array<double, 3>(double t)> uniform;
  /// Writes H of all sites, in reduced units, to `field`. H must be linear in the spins and
  /// symmetric, like a demagnetising field: E = -sum mu m.H / 2, with the moments mu.
  std::function<void(HostVectors const& spins, HostVectors const& field, double t)> nonlocal;
};

}  // namespace cayspin::inline v0_2::io
