// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/ghosts.hpp>
#include <cayspin/solver/line_solver.hpp>
#include <cayspin/solver/multigrid.hpp>
#include <cayspin/spin_field.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>

namespace cayspin::inline v0_2::detail {

/// Solver that approximates z = (c + b * K)^-1 r for fields of vectors, with b >= 0 and c > 0. K u
/// is the sum over the neighbours u' of a site of J * (u - u'), with the J of each axis. Along an
/// axis with J < 0, the sum is over |J| * (u + u') instead, so that K >= 0; alternating the sign of
/// all vectors along this axis turns K into that of |J|. If at most one axis couples, z is the
/// exact solution. Otherwise z is the result of one multigrid cycle V(2, 2) in single precision,
/// which leaves a fifth to a half of the residual. A cycle is a linear map, symmetric to round-off,
/// and positive definite.
template <class Real, class MemorySpace>
class Helmholtz {
 public:
  using Field = SiteField<Real, 3, MemorySpace>;

  Helmholtz() = default;
  /// `couplings`: J of each axis, A / spacing^2 for exchange, not negative along a periodic axis of
  /// odd extent; ignored along axes without neighbours. Throws std::invalid_argument for a part of
  /// a lattice, and for replicas.
  Helmholtz(std::string const& name, Lattice const& lattice, std::array<double, 3> couplings)
      : scale_label_("cayspin::" + name + "::scale"), signs_label_("cayspin::" + name + "::signs") {
    require_whole("cayspin::Helmholtz", lattice);
    require_one_replica("cayspin::Helmholtz", lattice);
    if (auto const axis = only_coupled_axis(lattice, couplings))
      lines_.emplace(name, RowLayout::of<Real>(lattice), *axis,
                     couplings[static_cast<std::size_t>(*axis)]);
    else {
      for (std::size_t i = 0; i < 3; ++i) {
        signs_.along[i] = couplings[i] < 0;
        couplings[i] = std::abs(couplings[i]);
      }
      multigrid_ = {name, lattice, couplings};
    }
  }

  /// `r` and `z` must be different fields. Does not wait.
  template <class Exec>
  void solve(Exec const& exec, double c, double b, Field const& r, Field const& z) {
    if (lines_) return lines_->solve(exec, c, static_cast<Real>(b), r, z);
    auto const& right = multigrid_.right();
    LaunchEach<Exec> const launch{exec};
    launch.template run<Real>(scale_label_, right.layout(),
                              ScaleCells<Real, float>{cells_of<3>(r), cells_of<3>(right),
                                                      static_cast<Real>(1 / c), signs_});
    multigrid_.solve(exec, b / c, cells_of<3>(z));
    if (signs_.any())
      launch.template run<Real>(
          signs_label_, z.layout(),
          ScaleCells<Real, Real>{cells_of<3>(z), cells_of<3>(z), Real(1), signs_});
  }

 private:
  std::string scale_label_, signs_label_;
  AlternatingSigns signs_;
  std::optional<LineSolver<Real, MemorySpace>> lines_;
  Multigrid<ShiftedExchange<float>, 2, true, float, MemorySpace> multigrid_;
};

}  // namespace cayspin::inline v0_2::detail
