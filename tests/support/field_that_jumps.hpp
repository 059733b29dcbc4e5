// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/field/zeeman.hpp>

namespace cayspin::test {

/// A uniform field that jumps to another value at a given time.
struct FieldThatJumps {
  static constexpr bool depends_on_time = true;
  double when;
  Vec3<double> before, after;

  template <class Exec, class Field>
  Zeeman prepare(Exec const&, Field const&, double t) const {
    return Zeeman{t < when ? before : after};
  }
};

}  // namespace cayspin::test
