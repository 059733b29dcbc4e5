// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/isotropy/zero.hpp>
#include <cayspin/rotation/cayley.hpp>
#include <cayspin/stepper/two_point.hpp>

namespace cayspin {

/// The two-step method of Adams and Bashforth, order 2 with one evaluation:
/// m <- cay(dt (3 xi_n - xi_(n-1)) / 2) m, xi = A + sigma m; for steps that change,
/// dt (xi_n + (dt / dt before) (xi_n - xi_(n-1)) / 2). The first step is one of LieHeun.
/// Not in the paper.
template <class Spins, class Isotropy = isotropy::Zero, class Rotation = Cayley>
class LieAdamsBashforth2
    : public TwoPoint<Spins, detail::AdamsBashforthMethod, Isotropy, Rotation> {
 public:
  explicit LieAdamsBashforth2(Spins const& like, Isotropy isotropy = {}, Rotation = {})
      : LieAdamsBashforth2::TwoPoint("LieAdamsBashforth2", like, {}, isotropy) {}
};

}  // namespace cayspin
