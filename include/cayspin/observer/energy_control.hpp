// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/concepts.hpp>
#include <cayspin/detail/for_each_site.hpp>
#include <cayspin/detail/ghosts.hpp>
#include <cayspin/detail/narrowing_store.hpp>
#include <cayspin/detail/reduce_sites.hpp>
#include <cayspin/rotation/cayley.hpp>
#include <cayspin/spin_field.hpp>
#include <cayspin/stencil.hpp>
#include <cayspin/step.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <type_traits>
#include <utility>

namespace cayspin::inline v0_2 {

namespace detail {

/// Functor that computes E and |A_o|^2, where A_o is the part of A normal to m. Stores m x A (A_o
/// turned by a right angle), the axis of the correction's rotation.
template <class Generator, class Real>
struct EnergyAndSlope {
  Generator generator;
  SiteArray<Real, 3> spins, axes;

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Value* values) const {
    Stencil<Site, Real> const stencil(site, spins);
    Vec3<Value> const axis = cross(stencil.center(), evaluate(generator, stencil));
    values[0] = generator.energy_density(stencil);
    values[1] = dot(axis, axis);
    store_narrowed(axis, site, axes);
  }
};

/// Functor that sets m to cay(kappa * axis) m.
template <class Real>
struct TurnAboutAxes {
  SiteArray<Real, 3> spins, axes;
  OutputArray<Real, 3> output;
  Real kappa;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    using Value = typename Site::value_type;
    Vec3<Value> const f = Value(kappa) * site.load(axes);
    site.store(Cayley::rotate(f, site.load(spins)), output);
  }
};

}  // namespace detail

/// Options of EnergyControl. Its constructor throws std::invalid_argument if one is out of range.
struct EnergyControlOptions {
  std::int64_t period = 1;  // steps between corrections
  /// Largest turn of a spin in a correction, as a fraction of its turn in a step.
  double largest_fraction = 0.1;
  std::optional<double> energy = {};  // the energy to hold; default: that at the first call
};

/// Lagged energy control: an observer for undamped runs with any one-step or multistep method,
/// called at the end of steps. A correction turns all spins towards the field or away from it, m <-
/// cay(kappa * m x A) m, where kappa = (E - E_0) / sum |A_o|^2 is the same for all spins and A_o is
/// the part of A normal to m. This is a Newton step to E_0, the energy to hold, so that energy
/// errors do not accumulate. The generator A must conserve an energy and not depend on t. kappa is
/// of the order of the method's error, so the method keeps its order.
///
/// Each correction costs one evaluation of the generator and two passes over the spins. The memory
/// cost is one field.
///   EnergyControl control(spins, generator);
///   integrate(exec, stepper, generator, spins, times, control);
/// Other observers see the spins before or after the correction, depending on their position among
/// the arguments.
/// Does not compile with an AdaptiveStepper, which continues from an internal state.
template <class Spins, class Generator>
class EnergyControl {
  static_assert(
      requires(Generator const& generator) { generator.conserves_energy(); },
      "EnergyControl needs a generator that says whether it conserves its energy: a member "
      "conserves_energy().");
  static_assert(!detail::depends_on_time<Generator>,
                "EnergyControl refuses fields that depend on t.");

 public:
  using Real = typename Spins::value_type;
  static constexpr bool changes_spins = true;

  /// Throws std::invalid_argument when the generator does not conserve its energy, for invalid
  /// options, and for a lattice of several replicas.
  EnergyControl(Spins const& like, Generator generator, EnergyControlOptions const& options = {})
      : generator_(std::move(generator)),
        options_(options),
        energy_(options.energy),
        axes_("EnergyControl::axes", like.lattice()) {
    detail::check_conservative<Generator>();
    detail::require_one_replica("cayspin::EnergyControl", like.lattice());
    if (!generator_.conserves_energy())
      throw std::invalid_argument(
          "cayspin::EnergyControl: the generator does not conserve its energy (damping 0 does)");
    if (options.period < 1)
      throw std::invalid_argument("cayspin::EnergyControl: the period must be at least 1");
    if (!(options.largest_fraction > 0))
      throw std::invalid_argument("cayspin::EnergyControl: the largest fraction must be above 0");
    if (options.energy && !std::isfinite(*options.energy))
      throw std::invalid_argument("cayspin::EnergyControl: the energy to hold must be finite");
  }

  std::size_t work_bytes() const { return axes_.bytes(); }
  /// Returns the held energy; empty before the first call unless the options give it.
  std::optional<double> energy() const { return energy_; }
  /// Returns by how much the energy exceeded the held one at the last call, before the correction.
  double excess() const { return excess_; }
  /// Evaluations of the generator so far.
  std::int64_t evaluations_done() const { return evaluations_done_; }

  /// Forgets the held energy. The next call sets it to the energy of the spins, unless the options
  /// give an energy.
  void reset() { energy_ = options_.energy; }

  /// For cayspin::serialize.
  template <class Visit>
  void visit_memory(Visit const& visit) {
    bool holds = energy_.has_value();
    visit("holds", holds);
    if (!holds) return reset();
    double energy = energy_.value_or(0);
    visit("energy", energy);
    energy_ = energy;
  }

  bool due(Step const& step) const { return !energy_ || step.number % options_.period == 0; }

  /// Changes `spins` in place. Throws std::invalid_argument when they are not on the lattice given
  /// at construction. If the energy is not finite, the spins do not change.
  template <class Exec>
  void operator()(Exec const& exec, Step const& step, Spins const& spins) {
    detail::check_access<Exec, typename Spins::memory_space>();
    require_lattice("cayspin::EnergyControl", axes_.lattice(), spins.lattice());
    auto const prepared = detail::prepare_term(generator_, exec, spins, step.time);
    using Look = detail::EnergyAndSlope<std::remove_const_t<decltype(prepared)>, Real>;
    auto const [energy, slope] =
        detail::reduce_sites<detail::Sum, 2>(exec, "cayspin::EnergyControl::slope", spins.layout(),
                                             Look{prepared, spins.array(), axes_.array()});
    ++evaluations_done_;
    if (!energy_) energy_ = energy;
    excess_ = energy - *energy_;
    double const most = options_.largest_fraction * std::abs(step.dt);
    double const kappa = std::clamp(excess_ / slope, -most, most);
    if (!std::isfinite(excess_) || !std::isfinite(kappa) || kappa == 0) return;
    detail::for_each_site<Real>(
        exec, "cayspin::EnergyControl::turn", spins.layout(),
        detail::TurnAboutAxes<Real>{spins.array(), axes_.array(), spins.output(false),
                                    static_cast<Real>(kappa)},
        spins.layout().own);
    detail::update_ghosts(exec, spins.lattice(), spins);
  }

 private:
  Generator generator_;
  EnergyControlOptions options_;
  std::optional<double> energy_;
  double excess_ = 0;
  std::int64_t evaluations_done_ = 0;
  SiteField<Real, 3, typename Spins::memory_space> axes_;
};

}  // namespace cayspin::inline v0_2
