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

namespace cayspin::inline v0_1::detail {

struct SpinWaveOptions {
  bool conjugated = false;       ///< a right side of 6 components is (r', -r'')
  bool same_directions = false;  ///< near enough to those of the call before, which stay in use
};

/// Approximates v with v + b K v = r across the directions m, where i of the complex b stands for
/// m x, and K = -J Lap over the neighbours of a lattice. Where one axis alone couples, by lines,
/// which are exact for parallel m. Otherwise by one multigrid cycle in single precision, which
/// follows m and leaves a tenth to three tenths.
template <class Real, class MemorySpace>
class SpinWaveSolver {
  using Vectors = SiteField<Real, 3, MemorySpace>;

 public:
  using Solution = SiteField<Real, 6, MemorySpace>;

  SpinWaveSolver() = default;
  /// `couplings`: J of each axis, at least 0. Throws std::invalid_argument for a part of a lattice.
  SpinWaveSolver(std::string const& name, Lattice const& lattice, std::array<double, 3> couplings)
      : turn_label_("cayspin::" + name + "::turn") {
    require_whole("cayspin::SpinWaveSolver", lattice);
    if (auto const axis = only_coupled_axis(lattice, couplings))
      lines_.emplace(name, RowLayout::of<Real>(lattice), *axis,
                     couplings[static_cast<std::size_t>(*axis)]);
    else
      multigrid_ = {name, lattice, couplings};
  }

  /// Is v' of every solution zero?
  bool solves_for_turned_alone() const { return !lines_; }

  /// z = (v', v'') with v = v' + m x v''. Always by lines, or never: multigrid leaves v' as it is.
  /// A right side of 6 components is (r', r'') likewise. Does not wait.
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

}  // namespace cayspin::inline v0_1::detail
