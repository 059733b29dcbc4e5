// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/ghosts.hpp>
#include <cayspin/solver/line_solver.hpp>
#include <cayspin/solver/multigrid.hpp>

#include <array>
#include <complex>
#include <cstddef>
#include <optional>
#include <string>

namespace cayspin::inline v0_2::detail {

struct SpinWaveOptions {
  bool conjugated = false;       ///< a right-hand side (r', r'') stands for (r', -r'')
  bool same_directions = false;  ///< m is close to that of the previous call, whose copy is reused
};

/// Solver that approximates the v with v + b * K v = r, for vectors normal to the directions m. In
/// the complex b, i stands for the operator m x. K u is the sum over the neighbours u' of a site of
/// J * (u - u'). If at most one axis couples, it solves lines, which is exact for parallel m.
/// Otherwise it runs one multigrid cycle in single precision, which takes the m of each site into
/// account and leaves 0.1 to 0.3 of the residual.
template <class Real, class MemorySpace>
class SpinWaveSolver {
  using Vectors = SiteField<Real, 3, MemorySpace>;

 public:
  using Solution = SiteField<Real, 6, MemorySpace>;

  SpinWaveSolver() = default;
  /// `couplings`: J of each axis, at least 0. Throws std::invalid_argument for a part of a lattice,
  /// and for replicas.
  SpinWaveSolver(std::string const& name, Lattice const& lattice, std::array<double, 3> couplings)
      : turn_label_("cayspin::" + name + "::turn") {
    require_whole("cayspin::SpinWaveSolver", lattice);
    require_one_replica("cayspin::SpinWaveSolver", lattice);
    if (auto const axis = only_coupled_axis(lattice, couplings))
      lines_.emplace(name, RowLayout::of<Real>(lattice), *axis,
                     couplings[static_cast<std::size_t>(*axis)]);
    else
      multigrid_ = {name, lattice, couplings};
  }

  /// Returns true if v' is zero in all solutions; solve() then does not write it.
  bool solves_only_rotated_part() const { return !lines_; }

  /// Computes z = (v', v''), where v = v' + m x v''. A right-hand side of 6 components is likewise
  /// (r', r''). Does not wait.
  template <class Exec, int RightComponents>
  void solve(Exec const& exec, std::complex<double> b,
             SiteField<Real, RightComponents, MemorySpace> const& r, Vectors const& m,
             Solution const& z, SpinWaveOptions const& options = {}) {
    if (lines_)
      return lines_->solve(
          exec, 1, Kokkos::complex<Real>(static_cast<Real>(b.real()), static_cast<Real>(b.imag())),
          r, z, options.conjugated);
    auto const& right = multigrid_.right();
    LaunchEach<Exec>{exec}.template run<Real>(
        turn_label_, right.layout(),
        TurnRightSide<RightComponents, Real, float>{right.layout().nx,
                                                    options.conjugated ? Real(-1) : Real(1),
                                                    cells_of<RightComponents>(r), cells_of<3>(m),
                                                    cells_of<6>(right), options.same_directions});
    multigrid_.solve(exec, b, cells_of<3>(z, 3), options.same_directions);
  }

 private:
  std::string turn_label_;
  std::optional<LineSolver<Kokkos::complex<Real>, MemorySpace>> lines_;
  Multigrid<ShiftedSpinWaves<float>, 4, false, float, MemorySpace> multigrid_;
};

}  // namespace cayspin::inline v0_2::detail
