// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/concepts.hpp>
#include <cayspin/detail/narrowing_store.hpp>
#include <cayspin/detail/reduce_sites.hpp>
#include <cayspin/spin_field.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

namespace cayspin::inline v0_1::detail {

/// z + sign (-1)^(index along `axis`) x on every site; uniform where axis is 3.
template <class Real>
struct FillWaves {
  RowLayout layout;
  int axis;
  Real sign;
  SiteArray<Real, 3> to;

  KOKKOS_FUNCTION void operator()(std::int64_t site) const {
    std::int64_t const row = site / layout.nx;
    std::int64_t const index = axis == 0   ? site % layout.nx
                               : axis == 1 ? row % layout.ny
                               : axis == 2 ? row / layout.ny
                                           : 0;
    std::ptrdiff_t const at = layout.offset(site);
    to.data[at] = index % 2 == 0 ? sign : -sign;
    to.data[to.stride + at] = 0;
    to.data[2 * to.stride + at] = 1;
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
    auto const uniform = response(exec, label, generator, work, t, 3);
    std::array<double, 3> precessing{}, damped{};
    int evaluations = 2;
    double total_precessing = 0, total_damped = 0;
    for (int axis = 0; axis < 3; ++axis) {
      if (!lattice.has_neighbors(axis)) continue;
      auto const i = static_cast<std::size_t>(axis);
      auto const answer = response(exec, label, generator, work, t, axis);
      evaluations += 2;
      bool const closes = lattice.boundary[i] == Boundary::periodic && lattice.shape[i] % 2 == 0;
      double const bonds = static_cast<double>(lattice.sites() / lattice.shape[i]) *
                           static_cast<double>(lattice.shape[i] - (closes ? 0 : 1));
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
                                        int axis) {
    using Real = typename Spins::value_type;
    std::array<double, 2> sum{};
    for (Real const sign : {Real(1), Real(-1)}) {
      for_each_task(exec, label, work.sites(), work.sites(),
                    FillWaves<Real>{work.layout(), axis, sign, work.array()});
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
