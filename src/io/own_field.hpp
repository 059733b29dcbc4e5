// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <array>
#include <cstdint>
#include <functional>

namespace cayspin::inline v0_1::io {

/// Three numbers of every site in host memory: component c of site (i, j, k) lies
/// k strides[0] + j strides[1] + i strides[2] + c strides[3] numbers after `data`.
struct HostVectors {
  void* data = nullptr;
  bool is_double = true;                ///< numbers are double, otherwise float
  std::array<std::int64_t, 3> shape{};  ///< nz, ny, nx
  std::array<std::int64_t, 4> strides{};
};

/// Fields that a program adds to its scene. No file has them. Both are called on the host, by the
/// thread that steps; what they throw ends the run.
struct OwnField {
  /// The uniform field at t, in place of field.applied; mu0 multiplies it, too.
  std::function<std::array<double, 3>(double t)> uniform;
  /// Puts H of all sites into `field`. H must be linear in the spins and symmetric, as that of an
  /// FFT demag is: E = -sum m.H / 2. Reduced units.
  std::function<void(HostVectors const& spins, HostVectors const& field, double t)> nonlocal;
};

}  // namespace cayspin::inline v0_1::io
