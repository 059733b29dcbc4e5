// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/concepts.hpp>
#include <cayspin/detail/for_each_site.hpp>
#include <cayspin/isotropy/sigma.hpp>
#include <cayspin/rotation/cayley.hpp>
#include <cayspin/scalars.hpp>
#include <cayspin/stencil.hpp>
#include <cayspin/stepper/stepper_base.hpp>

#include <cmath>
#include <stdexcept>

namespace cayspin::inline v0_1 {

namespace detail {

/// The coordinates orthogonal to m0 of the rotation that takes m0 to m1, f = 2 m0 x m1 / (1 +
/// m0.m1), so that cay(f) m0 = m1. Zero for opposite spins, which have no such f.
template <class Value>
KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> coordinates_between(Vec3<Value> const& m0,
                                                            Vec3<Value> const& m1) {
  Vec3<Value> const middle = m0 + m1;  // |m0 + m1|^2 = 2 (1 + m0.m1), without cancellation
  return guarded_quotient(Value(4), dot(middle, middle)) * cross(m0, m1);
}

/// <dE/dm, f> = -<A, f> of coordinates f orthogonal to the spins; and E at their begin.
template <class Generator, class Real>
struct EnergyAlongCoordinates {
  Generator generator;
  SiteArray<Real, 3> begin, end;

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Value* values) const {
    Stencil<Site, Real> const stencil(site, begin);
    Vec3<Value> const f = coordinates_between(stencil.center(), site.load(end));
    values[0] = Value(0.0) - dot(evaluate(generator, stencil), f);
    values[1] = generator.energy_density(stencil);
  }
};

/// m1 <- cay(f + epsilon m0) m0
template <class Real>
struct ProjectStage {
  SiteArray<Real, 3> begin, end;
  OutputArray<Real, 3> next;
  Real epsilon;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    using Value = typename Site::value_type;
    Vec3<Value> const m0 = site.load(begin), m1 = site.load(end);
    Vec3<Value> const f = coordinates_between(m0, m1);
    Vec3<Value> const projected = Cayley::rotate(multiply_add(Value(epsilon), m0, f), m0);
    // Without such an f the step stays as it is.
    auto const none = dot(f, f) == Value(0);
    site.store(select<Value>(none, m1, projected), next);
  }
};

}  // namespace detail

/// A stepper whose steps keep the energy: m1 <- cay(f + epsilon m0) m0. Here f are the coordinates
/// orthogonal to m0 of the inner stepper's step. One epsilon for all spins corrects the energy.
/// The generator must be conservative, have an energy and not depend on t.
/// Keeps the stepper's order. Enough `corrections` keep the energy to round-off.
/// Not in the paper. Work memory: two fields beside the stepper's.
template <class Stepper>
class EnergyProjection : public detail::StepperBase<typename Stepper::spins_type> {
  using Base = detail::StepperBase<typename Stepper::spins_type>;

 public:
  using Spins = typename Stepper::spins_type;
  using stepper_type = Stepper;
  using typename Base::Real;
  static constexpr int order = Stepper::order;
  static constexpr int evaluations = Stepper::evaluations + 1;  // energies not counted
  static constexpr int ghosts = detail::ghosts_of<Stepper>;
  static constexpr int work_fields = Stepper::work_fields + 2;

  EnergyProjection(Spins const& like, Stepper stepper, int corrections = 3)
      : Base("EnergyProjection", like.lattice(), ghosts),
        stepper_(std::move(stepper)),
        corrections_(corrections),
        begin_("EnergyProjection::begin", like.lattice()),
        next_("EnergyProjection::next", like.lattice()) {}

  /// Evaluations of the generator so far, and of energies: a nonlocal field is evaluated for these,
  /// too.
  std::int64_t evaluations_done() const { return evaluations_done_; }

  std::size_t work_bytes() const { return stepper_.work_bytes() + 2 * begin_.bytes(); }
  static std::size_t work_bytes(Lattice const& lattice, bool by_time_alone, int threads)
    requires requires { Stepper::work_bytes(lattice, by_time_alone, threads); }
  {
    auto const layout = detail::RowLayout::of<Real>(lattice);
    return Stepper::work_bytes(lattice, by_time_alone, threads) +
           2 * layout.allocation(3) * sizeof(Real);
  }

  /// Forgets what the stepper remembers of the step before.
  void reset()
    requires requires(Stepper& inner) { inner.reset(); }
  {
    stepper_.reset();
  }

  /// For cayspin::exchange_memory.
  template <class Visit>
  void visit_memory(Visit const& visit)
    requires requires(Stepper& inner) { inner.visit_memory(visit); }
  {
    stepper_.visit_memory(visit);
  }

  /// For cayspin::integrate: the fields whose memory a step may exchange for that of the spins.
  template <class Visit>
  void visit_exchanged(Visit const& visit)
    requires requires(Stepper& inner) { inner.visit_exchanged(visit); }
  {
    visit(next_);
    stepper_.visit_exchanged(visit);
  }

  /// Advances `spins` from t to t + dt under `generator`; exchanges their memory with its own, so
  /// take arrays of `spins` again after a step. Waits.
  /// Throws std::invalid_argument when the generator is not conservative, or `spins` is not of the
  /// lattice given at construction.
  template <class Exec, class Generator>
  void step(Exec const& exec, Generator const& generator, Spins& spins, double t, double dt) {
    static_assert(
        requires { generator.is_conservative(); },
        "EnergyProjection needs a generator that says whether it conserves its energy: a "
        "member is_conservative().");
    static_assert(!detail::depends_on_time<Generator>,
                  "EnergyProjection refuses fields that depend on t.");
    detail::check_conservative<Generator>();
    auto const region = this->begin_step(exec, spins);
    this->require_other_memory(spins, next_);
    if (!generator.is_conservative())
      throw std::invalid_argument(
          "cayspin::EnergyProjection: the generator does not conserve its energy (damping 0 does)");
    Kokkos::deep_copy(exec, begin_.allocation(), spins.allocation());
    try {
      step_and_project(exec, generator, spins, t, dt);
    } catch (...) {
      Kokkos::deep_copy(exec, spins.allocation(), begin_.allocation());
      throw;
    }
  }

 private:
  template <class Exec, class Generator>
  void step_and_project(Exec const& exec, Generator const& generator, Spins& spins, double t,
                        double dt) {
    [[maybe_unused]] std::int64_t counted = 0;
    if constexpr (detail::counts_evaluations<Stepper>)
      counted = stepper_.evaluations_done();
    else
      evaluations_done_ += detail::evaluations_of_next_step(stepper_);
    stepper_.step(exec, generator, spins, t, dt);
    if constexpr (detail::counts_evaluations<Stepper>)
      evaluations_done_ += stepper_.evaluations_done() - counted;

    auto const prepared = detail::prepare_term(generator, exec, begin_, t);
    using Slope = detail::EnergyAlongCoordinates<std::remove_const_t<decltype(prepared)>, Real>;
    auto const [slope, before] = detail::reduce_sites<detail::Sum, 2>(
        exec, slope_label_, spins.layout(), Slope{prepared, begin_.array(), spins.array()});
    ++evaluations_done_;
    if (!(slope != 0)) return;
    double epsilon = 0, projected_with = 0;
    double excess = energy_of(exec, generator, spins, t) - before;
    for (int i = 0; i < corrections_ && excess != 0; ++i) {
      projected_with = epsilon - 2 * excess / slope;
      project(exec, spins, projected_with);
      double const left = energy_of(exec, generator, next_, t) - before;
      if (!(std::abs(left) < std::abs(excess))) break;
      epsilon = projected_with;
      excess = left;
    }
    if (epsilon == 0) return;
    if (projected_with != epsilon) project(exec, spins, epsilon);
    swap(spins, next_);
  }

  template <class Exec, class Generator>
  double energy_of(Exec const& exec, Generator const& generator, Spins const& spins, double t) {
    ++evaluations_done_;
    return energy(exec, generator, spins, t).value;
  }

  template <class Exec>
  void project(Exec const& exec, Spins const& end, double epsilon) {
    detail::for_each_site<Real>(
        exec, project_label_, end.layout(),
        detail::ProjectStage<Real>{begin_.array(), end.array(), next_.output(false),
                                   static_cast<Real>(epsilon)});
  }

  std::string slope_label_ = this->label("::slope"), project_label_ = this->label("::project");
  Stepper stepper_;
  int corrections_;
  Spins begin_, next_;
  std::int64_t evaluations_done_ = 0;
};

template <class Spins, class Stepper>
EnergyProjection(Spins, Stepper, int = 3) -> EnergyProjection<Stepper>;

}  // namespace cayspin::inline v0_1
