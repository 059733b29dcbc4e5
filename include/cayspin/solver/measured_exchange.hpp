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

namespace cayspin::inline v0_2::detail {

/// Functor that writes e_z + amplitude * sign * e_x where there is a spin, and 0 on vacant sites.
template <class Real>
struct FillWaves {
  AlternatingSigns signs;
  Real amplitude;
  SiteArray<Real, 3> spins;
  OutputArray<Real, 3> output;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    using Value = typename Site::value_type;
    Value const wave = Value(amplitude) * signs.template at<Value>(site);
    Vec3<Value> const m = site.load(spins);
    site.store(select<Value>(dot(m, m) == Value(Real(0)), zero<Value>(),
                             Vec3<Value>{wave, Value(Real(0)), Value(Real(1))}),
               output);
  }
};

/// Functor that counts a site's bonds along each axis to sites where the wave has the opposite
/// sign. So each bond is counted at both ends.
template <class Real>
struct OpposedBonds {
  SiteArray<Real, 3> waves;

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Value* values) const {
    Stencil<Site, Real> const stencil(site, waves);
    Value const here = stencil.center().x;
    auto const missing = zero<Value>();
    auto const count = [&](Vec3<Value> const& previous, Vec3<Value> const& next) {
      return opposed(here, previous.x) + opposed(here, next.x);
    };
    values[0] = count(stencil.template previous<0>(missing), stencil.template next<0>(missing));
    values[1] = count(stencil.template previous<1>(missing), stencil.template next<1>(missing));
    values[2] = count(stencil.template previous<2>(missing), stencil.template next<2>(missing));
  }

 private:
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Value opposed(Value const& here, Value const& there) {
    return select<Value>(here * there < Value(Real(0)), Value(Real(1)), Value(Real(0)));
  }
};

/// Functor that computes the components of A along the wave, and along the wave rotated about z by
/// a right angle.
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

/// The exchange in a generator A = precession * H + damping * m x H, measured by the response to
/// the shortest waves along each axis on uniform spins. H is taken to be a sum over the axes of a
/// coupling times the second difference of the spins; local terms cancel. If the exchange depends
/// on the site, the couplings are means over the bonds between spins. (For minimisers `probe` uses
/// m.H of a field instead, and finds couplings of either sign.)
struct MeasuredExchange {
  std::array<double, 3> couplings{};
  double precession = 1, damping = 0;
  bool known = false;

  /// Evaluates the generator twice, and twice more for each axis with neighbours. Returns the
  /// number of evaluations. Overwrites `work`: with waves where `spins` is not zero, else with 0.
  /// Waits.
  template <class Exec, class Generator, class Spins>
  int measure(Exec const& exec, std::string const& label, Generator const& generator,
              Spins const& spins, Spins const& work, double t) {
    auto const& lattice = work.lattice();
    auto const uniform = response(exec, label, generator, spins, work, t, {});
    std::array<double, 3> precessing{}, damped{};
    int evaluations = 2;
    double total_precessing = 0, total_damped = 0;
    for (int axis = 0; axis < 3; ++axis) {
      if (!lattice.has_neighbors(axis)) continue;
      auto const i = static_cast<std::size_t>(axis);
      auto const answer =
          response(exec, label, generator, spins, work, t, AlternatingSigns::along_axis(axis));
      evaluations += 2;
      double const bonds = opposed_bonds(exec, label, work)[i];
      if (bonds == 0) continue;
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
  template <class Exec, class Spins>
  static std::array<double, 3> opposed_bonds(Exec const& exec, std::string const& label,
                                             Spins const& waves) {
    using Real = typename Spins::value_type;
    auto counts =
        reduce_sites<Sum, 3>(exec, label, waves.layout(), OpposedBonds<Real>{waves.array()});
    for (double& count : counts) count *= 0.5;
    return counts;
  }

  // Returns the sums over the sites of the values of ResponseToWaves, averaged over waves of
  // opposite sign: contributions to A that are even in the wave cancel.
  template <class Exec, class Generator, class Spins>
  static std::array<double, 2> response(Exec const& exec, std::string const& label,
                                        Generator const& generator, Spins const& spins,
                                        Spins const& work, double t,
                                        AlternatingSigns const& signs) {
    using Real = typename Spins::value_type;
    std::array<double, 2> sum{};
    for (Real const amplitude : {Real(1), Real(-1)}) {
      for_each_site<Real>(exec, label, work.layout(),
                          FillWaves<Real>{signs, amplitude, spins.array(), work.output(false)});
      auto prepared = prepare_term(generator, exec, work, t);
      auto const values = reduce_sites<Sum, 2>(
          exec, label, work.layout(),
          ResponseToWaves<decltype(prepared), Real>{std::move(prepared), work.array()});
      for (std::size_t i = 0; i < 2; ++i) sum[i] += 0.5 * values[i];
    }
    return sum;
  }
};

}  // namespace cayspin::inline v0_2::detail
