// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <array>

/// A symmetric tensor N of rank 2.
struct Tensor {
  double xx, yy, zz, xy, xz, yz;
};

/// H = -N M: the mean field in one cell of M in another one of the same size. The distance between
/// them and the size are in one unit of length.
using TensorOfCells = Tensor(std::array<double, 3> const& distance,
                             std::array<double, 3> const& size);
