// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/generator/landau_lifshitz.hpp>
#include <cayspin/minimizer/hessian.hpp>
#include <cayspin/minimizer/preconditioner.hpp>
#include <cayspin/modes/bloch.hpp>
#include <cayspin/modes/normal_mode.hpp>
#include <cayspin/modes/search.hpp>

#include <Kokkos_Profiling_ScopedRegion.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

// Needs Eigen 3, and is not part of cayspin.hpp.
namespace cayspin::inline v0_2 {

namespace detail {

/// Functor that replaces the precession a and the damping b of a Turning by the coefficients of
/// InverseTurning, p = a / (a^2 + b^2) and q = b / (a^2 + b^2), or by 0 where a and b are 0. Also
/// computes |q| and sqrt(a^2 + b^2).
template <class Real>
struct InvertTurning {
  SiteArray<Real, 1> precession, damping;

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Value* values) const {
    Value const a = site.load(precession), b = site.load(damping);
    Value const square = a * a + b * b, none(0.0), one(1.0);
    Value const inverse =
        select<Value>(none < square, one / select<Value>(none < square, square, one), none);
    values[0] = Kokkos::abs(b * inverse);
    values[1] = square_root(square);
    store_narrowed(Value(a * inverse), precession.data + site.offset());
    store_narrowed(Value(b * inverse), damping.data + site.offset());
  }
};

/// Functor that stores the precession (1 or 0) and the damping of a LandauLifshitz at every site.
template <class Generator, class Real>
struct StoreTurning {
  Generator generator;
  OutputArray<Real, 1> precession, damping;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    using Value = typename Site::value_type;
    site.store(Value(Real(generator.has_precession() ? 1 : 0)), precession);
    site.store(generator.template damping<Value>(site), damping);
  }
};

/// Throws std::invalid_argument if the fields of `turning` are on another lattice than the spins.
template <class Real, class MemorySpace, class Spins>
void require_turning_of(char const* who, Turning<Real, MemorySpace> const& turning,
                        Spins const& spins) {
  require_lattice(who, turning.precession.lattice(), spins.lattice());
  require_lattice(who, turning.damping.lattice(), spins.lattice());
}

/// Multiplies a mode, real + i * imaginary, by a complex number such that its longest vector has
/// length 1 and the largest component of that vector is real and positive. If several vectors or
/// components are equally large up to round-off, the first of them is taken.
template <class Exec, class Spins>
void normalize_mode(Exec const& exec, Spins const& real, Spins const& imaginary) {
  auto const x = copy_to_host(real), y = copy_to_host(imaginary);
  auto const square = [&](std::size_t c) { return double(x[c]) * x[c] + double(y[c]) * y[c]; };
  auto const of_site = [&](std::size_t i) { return square(i) + square(i + 1) + square(i + 2); };
  constexpr double nearly = 1 - 1e-5;
  double longest = 0;
  for (std::size_t i = 0; i + 2 < x.size(); i += 3) longest = std::max(longest, of_site(i));
  if (!(longest > 0)) return;
  std::size_t site = 0;
  while (of_site(site) < nearly * longest) site += 3;
  double const most = std::max({square(site), square(site + 1), square(site + 2)});
  std::size_t component = site;
  while (square(component) < nearly * most) ++component;
  double const factor = 1 / std::sqrt(square(component) * longest);
  double const a = factor * x[component], b = -factor * y[component];
  // Computes (x + i y) * (a + i b), with a copy of x because both parts change.
  Spins const before("modes::before", real.lattice());
  combine(exec, 1, real, 0, real, before);
  combine(exec, a, real, -b, imaginary, real);
  combine(exec, b, before, a, imaginary, imaginary);
}

/// Setup that all searches for modes at an equilibrium share.
template <class Exec, class Field, class Spins>
class ModesAt {
  using Real = typename Spins::value_type;
  using Memory = typename Spins::memory_space;

 public:
  ModesAt(char const* who, Exec const& exec, Field const& field, Spins const& spins,
          ModesOptions const& options)
      : exec_(exec), field_(field), spins_(spins), options_(options) {
    check_access<Exec, Memory>();
    check_conservative<Field>();
    require_whole(who, spins.lattice());
    require_one_replica(who, spins.lattice());
    if (options.count < 1 || options.count > ModesOptions::most)
      throw std::invalid_argument(std::string(who) + ": the count must be from 1 to " +
                                  std::to_string(ModesOptions::most));
    if (!(options.tolerance >= 0) || options.evaluations < 1)
      throw std::invalid_argument(
          std::string(who) +
          ": accepted: a tolerance of 0 or more, and at least one evaluation of the field");
  }

  struct Found {
    std::complex<double> rate;
    double error;
    Spins real, imaginary;
  };
  using Take = std::function<void(Found const&)>;

  /// Searches, calls take(mode) for each mode found, and returns why the search ended.
  ModesEnd find(InverseTurning<Real> const& inverse, bool is_undamped, bool is_symmetric,
                double fastest, Take const& take) {
    auto const named = [&](char const* name) { return Spins(name, spins_.lattice()); };
    ScalarField<Real, Memory> const is_mobile("modes::is_mobile", spins_.lattice());
    HessianArrays<Spins> const arrays{named("modes::shifted"), named("modes::at_rest"),
                                      named("modes::before")};
    auto const found = probe(exec_, field_, options_.time, spins_, arrays.shifted, is_mobile);
    Preconditioner<Spins> preconditioner;
    preconditioner.set(spins_.lattice(), found, options_.preconditioned);
    double const scale = preconditioner.first_shift();
    Hessian hessian(exec_, field_, options_.time, spins_, is_mobile, arrays,
                    HessianDifferences::of_four);
    round_off_ = hessian.round_off(found.strongest());
    least_energy_ = least_energy * scale;
    auto const precondition = [&](Spins const& from, Spins const& to) {
      preconditioner.apply(exec_, from, to);
    };
    ModeSearchOptions const options{.count = options_.count,
                                    .tolerance = options_.tolerance,
                                    .round_off = round_off_ / scale,
                                    .evaluations = options_.evaluations,
                                    .scale = scale,
                                    .shift = 1e-3 * scale * fastest,
                                    .is_undamped = is_undamped,
                                    .is_symmetric = is_symmetric,
                                    .poll = options_.poll};
    ModeSearch search(exec_, spins_, hessian, inverse, precondition, options);
    using End = typename decltype(search)::End;
    auto const end = search.run();
    evaluations_ = found.evaluations + hessian.evaluations();
    for (std::size_t i = 0; i < search.count(); ++i) {
      auto const real = named("modes::real"), imaginary = named("modes::imaginary");
      search.write(i, real, imaginary);
      normalize_mode(exec_, real, imaginary);
      take({search.modes()[i].rate, search.error(i), real, imaginary});
    }
    return end == End::converged          ? ModesEnd::converged
           : end == End::stagnated        ? ModesEnd::stagnated
           : end == End::evaluation_limit ? ModesEnd::evaluation_limit
                                          : ModesEnd::interrupted;
  }

  std::int64_t evaluations() const { return evaluations_; }

  /// Returns an estimate of the error of an eigenvalue of the Hessian. `error`: that of its vector.
  double error_of_value(double value, double error) const {
    return round_off_ + error * std::max(std::abs(value), least_energy_);
  }

 private:
  Exec const& exec_;
  Field const& field_;
  Spins const& spins_;
  ModesOptions const& options_;
  std::int64_t evaluations_ = 0;
  double round_off_ = 0, least_energy_ = 0;
};

}  // namespace detail

/// Returns the normal modes of the equation of motion (Turning), linearised at an equilibrium,
/// slowest first. Each product of the Hessian with a vector takes one evaluation of the field if
/// the field is affine in the spins, otherwise four. Symmetries that the equilibrium breaks give
/// zero modes, with a rate of about 0. At a saddle some modes grow; their decay is negative. Waits.
/// Throws std::invalid_argument for invalid options, parts of a lattice and replicas.
template <class Exec, class Field, class Spins>
NormalModes<Spins> normal_modes(
    Exec const& exec, Field const& field,
    Turning<typename Spins::value_type, typename Spins::memory_space> const& turning,
    Spins const& spins, ModesOptions const& options = {}) {
  using Real = typename Spins::value_type;
  Kokkos::Profiling::ScopedRegion const region("cayspin::normal_modes");
  detail::ModesAt<Exec, Field, Spins> at("cayspin::normal_modes", exec, field, spins, options);
  detail::require_turning_of("cayspin::normal_modes", turning, spins);
  Turning<Real, typename Spins::memory_space> inverse{{"modes::sideways", spins.lattice()},
                                                      {"modes::along", spins.lattice()}};
  Kokkos::deep_copy(exec, inverse.precession.allocation(), turning.precession.allocation());
  Kokkos::deep_copy(exec, inverse.damping.allocation(), turning.damping.allocation());
  auto const [damping, fastest] = detail::reduce_sites<detail::Maximum, 2>(
      exec, "cayspin::modes::invert_turning", spins.layout(),
      detail::InvertTurning<Real>{inverse.precession.array(), inverse.damping.array()});
  NormalModes<Spins> found;
  found.end = at.find({inverse.precession.array(), inverse.damping.array()}, damping == 0, false,
                      fastest, [&](auto const& mode) {
                        found.modes.push_back({std::abs(mode.rate.imag()), 0 - mode.rate.real(),
                                               mode.error, mode.real, mode.imaginary});
                      });
  found.evaluations = at.evaluations();
  return found;
}

/// Returns the normal modes of a LandauLifshitz. Throws std::invalid_argument also if it has
/// neither precession nor damping.
template <class Exec, class Field, class Damping, class Spins>
NormalModes<Spins> normal_modes(Exec const& exec, LandauLifshitz<Field, Damping> const& generator,
                                Spins const& spins, ModesOptions const& options = {}) {
  using Real = typename Spins::value_type;
  generator.check_spins(spins);
  if (!generator.has_precession() && !generator.is_damped())
    throw std::invalid_argument(
        "cayspin::normal_modes: spins without precession and damping do not move");
  Turning<Real, typename Spins::memory_space> const turning{{"modes::precession", spins.lattice()},
                                                            {"modes::damping", spins.lattice()}};
  auto const prepared = detail::prepare_term(generator, exec, spins, options.time);
  detail::for_each_site<Real>(
      exec, "cayspin::modes::store_turning", spins.layout(),
      detail::StoreTurning<decltype(prepared), Real>{prepared, turning.precession.output(false),
                                                     turning.damping.output(false)});
  return normal_modes(exec, generator.field(), turning, spins, options);
}

/// Returns the lowest eigenvalues of the Hessian of a field's energy on the tangent planes of
/// mobile spins, with the eigenvectors. Waits. Throws like normal_modes.
template <class Exec, class Field, class Spins>
Curvatures<Spins> lowest_curvatures(Exec const& exec, Field const& field, Spins const& spins,
                                    ModesOptions const& options = {}) {
  using Real = typename Spins::value_type;
  Kokkos::Profiling::ScopedRegion const region("cayspin::lowest_curvatures");
  detail::ModesAt<Exec, Field, Spins> at("cayspin::lowest_curvatures", exec, field, spins, options);
  ScalarField<Real, typename Spins::memory_space> const none("modes::sideways", spins.lattice()),
      minus_one("modes::along", spins.lattice(), Real(-1));
  Curvatures<Spins> found;
  found.end = at.find({none.array(), minus_one.array()}, false, true, 1, [&](auto const& mode) {
    double const value = mode.rate.real();
    found.curvatures.push_back(
        {value, at.error_of_value(value, mode.error), mode.error, mode.real});
  });
  found.evaluations = at.evaluations();
  return found;
}

/// Returns the spin waves of given wave vectors (cycles per lattice cell) about an equilibrium that
/// is equal in all cells along the periodic axes. This takes two products of the Hessian with a
/// vector for each mobile site of a cell, up to four to compare the cells, and then the eigenvalues
/// of a small matrix for each wave vector. A wave vector need not fit the lattice, unless the
/// interaction reaches around the lattice, as a demagnetising field does. This is noticed only for
/// even numbers of cells: for odd ones, such a field gives wrong rates of waves that do not fit.
/// Bonds must not be longer than half the lattice. If there is only one cell along a periodic axis,
/// bonds along it join the cell to itself, and a wave has the same phase at both ends of such a
/// bond.
/// `poll` is called before each product and each wave vector; after Next::stop the result is empty.
/// Throws std::invalid_argument if cells differ, for a wave vector that must fit but does not or
/// that has a component along an open axis, and for parts of a lattice and replicas.
template <class Exec, class Field, class Spins>
BlochModes bloch_modes(
    Exec const& exec, Field const& field,
    Turning<typename Spins::value_type, typename Spins::memory_space> const& turning,
    Spins const& spins, std::vector<std::array<double, 3>> const& wave_vectors, double time = 0,
    std::function<Next()> const& poll = {}) {
  Kokkos::Profiling::ScopedRegion const region("cayspin::bloch_modes");
  detail::check_access<Exec, typename Spins::memory_space>();
  detail::check_conservative<Field>();
  detail::require_whole("cayspin::bloch_modes", spins.lattice());
  detail::require_one_replica("cayspin::bloch_modes", spins.lattice());
  detail::require_periodic_along(wave_vectors, spins.lattice());
  detail::require_turning_of("cayspin::bloch_modes", turning, spins);
  BlochModes found;
  bool is_stopped = false;
  auto const stops = [&] { return is_stopped = is_stopped || (poll && poll() == Next::stop); };
  auto const problem = detail::bloch_problem(exec, field, time, spins, turning.precession,
                                             turning.damping, stops, found.evaluations);
  for (auto const& wave : wave_vectors) {
    if (stops()) return {};
    auto& branches = found.bands.emplace_back();
    for (auto const& rate : problem.rates(wave))
      branches.push_back({0 - rate.imag(), 0 - rate.real()});
  }
  return found;
}

}  // namespace cayspin::inline v0_2
