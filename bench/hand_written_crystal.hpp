// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "hand_written.hpp"

#include <cstddef>

// The same for one crystal: bcc, n x n x n periodic cells of two sites, exchange with 8 neighbours
// or, with a second shell, 14, a field along z, damping. It is what one writes who knows the
// offsets of all neighbours when the program is compiled.
namespace hand_written {

template <class Real>
struct Bcc {
  int n;
  Real first_shell, second_shell, applied, damping;

  std::size_t sites() const { return 2 * static_cast<std::size_t>(n) * n * n; }
};

/// Spins by plane z, and in it sites 0 of all cells before sites 1.
template <class Real, bool SecondShell>
class HeunOnBcc {
 public:
  explicit HeunOnBcc(Bcc<Real> const& bcc) : bcc_(bcc), v_(bcc.sites()), k_(bcc.sites()) {}
  void step(Vectors<Real>& m, Real dt);

 private:
  Bcc<Real> bcc_;
  Vectors<Real> v_, k_;
};

}  // namespace hand_written
