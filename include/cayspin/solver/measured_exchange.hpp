// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/concepts.hpp>
#include <cayspin/detail/for_each_site.hpp>
#include <cayspin/detail/reduce_sites.hpp>
#include <cayspin/solver/alternating_signs.hpp>
#include <cayspin/spin_field.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>

namespace cayspin::inline v0_1::detail {

/// z + amplitude sign x on every site.
template <class Real>
struct FillWaves {
  AlternatingSigns signs;
  Real amplitude;
  OutputArray<Real, 3> output;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    using Value = typename Site::value_type;
    Value const wave = Value(amplitude) * signs.template at<Value>(site);
    site.store(Vec3<Value>{wave, Value(Real(0)), Value(Real(1))}, output);
  }
};

/// A along the waves, and along their rotation about z.
template <class Generator, class Real>
struct ResponseToWaves {
  Generator generator;
  SiteArray<Real, 3> waves;

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Value* values) const {
    Stencil<Site, Real> const stencil(site, waves);
    auto const a = evaluate(generator, stencil);
    values[0] = a.x * stencil.center().x;
    values[1] = a.y * stencil.center().x;
  }
};

/// How a generator A = precession H + damping m x H answers to the shortest waves of each axis
/// beside uniform spins: as an exchange field H = sum of couplings times second differences would.
/// What is local cancels out. Vacancies and constants that differ between sites give means. (For
/// minimisers `probe` takes m.H instead: couplings of either sign, of a field alone.)
struct MeasuredExchange {
  std::array<double, 3> couplings{};
  double precession = 1, damping = 0;
  bool known = false;

  /// Evaluates the generator 2 + 2 axes times, on `work`; returns that number. Waits.
  template <class Exec, class Generator, class Spins>
  int measure(Exec const& exec, std::string const& label, Generator const& generator,
              Spins const& work, double t) {
    auto const& lattice = work.lattice();
    auto const uniform = response(exec, label, generator, work, t, {});
    std::array<double, 3> precessing{}, damped{};
    int evaluations = 2;
    double total_precessing = 0, total_damped = 0;
    for (int axis = 0; axis < 3; ++axis) {
      if (!lattice.has_neighbors(axis)) continue;
      auto const i = static_cast<std::size_t>(axis);
      auto const answer =
          response(exec, label, generator, work, t, AlternatingSigns::along_axis(axis));
      evaluations += 2;
      double const bonds = opposed_bonds(lattice, axis);
      auto const coupling = [&](double from_uniform, double from_waves) {
        double const difference = from_uniform - from_waves;
        bool const is_noise = std::abs(difference) < 1e-5 * std::abs(from_uniform);
        return is_noise ? 0 : std::max(0.0, difference / (4 * bonds));
      };
      total_precessing += precessing[i] = coupling(uniform[0], answer[0]);
      total_damped += damped[i] = coupling(uniform[1], answer[1]);
    }
    known = true;
    bool const precesses = total_precessing > 1e-6 * total_damped;
    couplings = precesses ? precessing : damped;
    precession = precesses ? 1 : 0;
    damping = precesses ? total_damped / total_precessing : 1;
    return evaluations;
  }

 private:
  // Half the difference between waves of either sign, which cancels what is not linear in them.
  template <class Exec, class Generator, class Spins>
  static std::array<double, 2> response(Exec const& exec, std::string const& label,
                                        Generator const& generator, Spins const& work, double t,
                                        AlternatingSigns const& signs) {
    using Real = typename Spins::value_type;
    std::array<double, 2> sum{};
    for (Real const amplitude : {Real(1), Real(-1)}) {
      for_each_site<Real>(exec, label, work.layout(),
                          FillWaves<Real>{signs, amplitude, work.output(false)});
      auto prepared = prepare_term(generator, exec, work, t);
      auto const values = reduce_sites<Sum, 2>(
          exec, label, work.layout(),
          ResponseToWaves<decltype(prepared), Real>{std::move(prepared), work.array()});
      for (std::size_t i = 0; i < 2; ++i) sum[i] += 0.5 * values[i];
    }
    return sum;
  }
};

}  // namespace cayspin::inline v0_1::detail
