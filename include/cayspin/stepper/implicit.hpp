// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/concepts.hpp>
#include <cayspin/detail/text.hpp>
#include <cayspin/isotropy/policies.hpp>
#include <cayspin/rotation/cayley.hpp>
#include <cayspin/stencil.hpp>
#include <cayspin/stepper/newton_krylov.hpp>
#include <cayspin/stepper/stepper_base.hpp>

#include <limits>
#include <stdexcept>
#include <string>

namespace cayspin::inline v0_2 {

/// Thrown when an implicit step's equation was not solved. The spins are those before the step.
class NotConverged : public std::runtime_error {
 public:
  NotConverged(std::string const& message, double start, double length)
      : std::runtime_error(message), t_(start), dt_(length) {}

  /// Return the start and the length of the step.
  double t() const { return t_; }
  double dt() const { return dt_; }

 private:
  double t_, dt_;
};

/// Options of the solver in implicit steps.
struct ImplicitOptions {
  double tolerance =
      8;  ///< bound on the last change of any component, divided by the precision's epsilon
  int fixed_point = 50;  ///< most fixed-point iterations before Newton's method takes over
  int newton = 30;       ///< most Newton iterations; 0 disables Newton's method
};

namespace detail {

/// One iteration of an implicit step: computes m1 = R(dt * xi) m0, where R is Rotation, and xi is A
/// with its isotropy at the spins `level`, the current estimate. Stores m1 or, if `to_middle` is
/// true, (m0 + m1) / 2.
template <class Isotropy, class Rotation, class Generator, class Real>
struct ImplicitStage {
  Generator generator;
  Isotropy isotropy;
  SiteArray<Real, 3> start, level;
  SiteArray<Real, 1> sigma;  // sigma * m0 is added to A, unless data is null
  OutputArray<Real, 3> next;
  Real dt;
  bool to_middle;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    using Value = typename Site::value_type;
    Stencil<Site, Real> const stencil(site, level);
    Vec3<Value> const m0 = site.load(start);
    Vec3<Value> xi = isotropy(stencil.center(), evaluate(generator, stencil));
    if (sigma.data != nullptr) xi = multiply_add(site.load(sigma), m0, xi);
    Vec3<Value> const m1 = Rotation::rotate(Vec3<Value>(Value(dt) * xi), m0);
    site.store(to_middle ? Vec3<Value>(Value(0.5) * (m0 + m1)) : m1, next);
  }
};

/// The sigma at the start of an implicit step, for isotropies that add sigma * m0 to A only after
/// the equation is solved; they specialise this class. Zero and Constant do not need it, and use
/// this empty class.
template <class Spins, class Isotropy>
struct ImplicitSigma {
  static constexpr bool is_there = false;
  static constexpr int evaluations = 0, ghosts = 1, work_fields = 0;

  ImplicitSigma(std::string const&, Lattice const&) {}
  static std::size_t bytes() { return 0; }
};

/// Base class of implicit methods: m1 = R(dt * xi(p)) m0, where R is Rotation, xi is A with its
/// isotropy, and p is m1 or, if AtMiddle, (m0 + m1) / 2.
template <class Spins, class Isotropy, class Rotation, bool AtMiddle>
class Implicit : public StepperBase<Spins> {
 public:
  using typename StepperBase<Spins>::Real;
  static constexpr int ghosts =
      ImplicitSigma<Spins, Isotropy>::ghosts;  // ghosts are exchanged in each iteration
  static constexpr int work_fields = 2 + ImplicitSigma<Spins, Isotropy>::work_fields;

  Implicit(std::string const& name, Spins const& like, Isotropy isotropy, ImplicitOptions options)
      : StepperBase<Spins>(name, like.lattice(), ghosts),
        isotropy_(checked_policy(isotropy)),
        options_(options),
        level_(name + "::level", like.lattice()),
        next_(name + "::next", like.lattice()),
        sigma_(name, like.lattice()) {}

  /// Returns the bytes of work memory, without the 16 fields that Newton's method allocates at its
  /// first use.
  std::size_t work_bytes() const { return level_.bytes() + next_.bytes() + sigma_.bytes(); }

  /// Returns the number of generator evaluations so far.
  std::int64_t evaluations_done() const { return evaluations_done_; }

  /// Advances `spins` from t to t + dt under `generator`. A step swaps the memory of `spins` with
  /// that of the stepper, so call spins.array() again after it. Waits for each iteration. Throws
  /// NotConverged when no solution is found, and std::invalid_argument when `spins` is not on the
  /// lattice given at construction.
  template <class Exec, class Generator>
  void step(Exec const& exec, Generator const& generator, Spins& spins, double t, double dt) {
    auto const region = this->begin_step(exec, spins);
    this->require_other_memory(spins, level_);
    this->require_other_memory(spins, next_);
    double const when = AtMiddle ? t + 0.5 * dt : t + dt;
    bool corrected = false;
    auto const map = [&](Spins const& from, Spins const& to, bool to_middle) {
      evaluate_map(exec, generator, spins, from, to, when, dt, to_middle, corrected);
    };
    if (!solve(
            exec, [&](Spins const& from, Spins const& to) { map(from, to, AtMiddle); }, spins))
      throw NotConverged(this->label("::step: the equation of the step from t = ") + to_text(t) +
                             " is not solved: dt = " + to_text(dt) +
                             " is too large, or the numbers are not finite",
                         t, dt);
    if constexpr (is_corrected) {
      sigma_.find(exec, generator, spins, t, dt);
      evaluations_done_ += sigma_.evaluations;
      corrected = true;
    }
    if constexpr (AtMiddle || is_corrected) {
      swap(level_, next_);
      map(level_, next_, false);
    }
    swap(spins, next_);
  }

  /// Visits the fields whose memory a step may swap with that of the spins, for cayspin::integrate.
  template <class Visit>
  void visit_exchanged(Visit const& visit) {
    visit(level_);
    visit(next_);
  }

 private:
  static constexpr bool is_corrected = ImplicitSigma<Spins, Isotropy>::is_there;

  // Leaves the solution in next_. Returns false if none is found.
  template <class Exec, class Map>
  bool solve(Exec const& exec, Map const& map, Spins const& spins) {
    double const epsilon = std::numeric_limits<Real>::epsilon();
    double const tolerance = options_.tolerance * epsilon;
    double change = std::numeric_limits<double>::infinity(), smallest = change;
    int stalled = 0;
    for (int i = 0; i < options_.fixed_point; ++i) {
      map(i == 0 ? spins : level_, next_);
      change = largest_difference(exec, i == 0 ? spins : level_, next_);
      if (change <= tolerance) return true;
      // A small change that no longer falls is round-off.
      stalled = change < smallest ? 0 : stalled + 1;
      if (change <= 512 * tolerance && stalled == 4) return true;
      if (!(change < 100 * smallest)) break;
      smallest = std::min(smallest, change);
      swap(level_, next_);
    }
    if (options_.newton == 0) return false;
    map(spins, level_);
    return newton_.solve(exec, map, level_, next_, tolerance, options_.newton);
  }

  template <class Exec, class Generator>
  void evaluate_map(Exec const& exec, Generator const& generator, Spins const& start,
                    Spins const& from, Spins const& to, double when, double dt, bool to_middle,
                    bool corrected) {
    auto prepared = prepare_term(generator, exec, from, when);
    using Policy = std::conditional_t<is_corrected, isotropy::Zero, Isotropy>;
    using Kernel = ImplicitStage<Policy, Rotation, decltype(prepared), Real>;
    Kernel kernel{std::move(prepared),   {},       start.array(),
                  from.array(),          {},       to.output(false),
                  static_cast<Real>(dt), to_middle};
    if constexpr (!is_corrected) kernel.isotropy = isotropy_;
    if constexpr (is_corrected)
      if (corrected) kernel.sigma = sigma_.array();
    for_each_site<Real>(exec, iterate_label_, start.layout(), kernel, start.layout().own);
    update_ghosts(exec, this->lattice_, to);
    ++evaluations_done_;
  }

  std::string iterate_label_ = this->label("::iterate");
  Isotropy isotropy_;
  ImplicitOptions options_;
  Spins level_, next_;
  CAYSPIN_DETAIL_NO_UNIQUE_ADDRESS ImplicitSigma<Spins, Isotropy> sigma_;
  NewtonKrylov<Spins> newton_;
  std::int64_t evaluations_done_ = 0;
};

}  // namespace detail

/// Implicit Euler, order 1: m1 = cay(dt * xi(m1)) m0, xi = A + sigma * m, solved by fixed-point
/// iteration or, if that fails, by Newton's method. Lewis and Nigam 2002, Sec. 4.2.
template <class Spins, class Isotropy = isotropy::Zero, class Rotation = Cayley>
class ImplicitLieEuler : public detail::Implicit<Spins, Isotropy, Rotation, false> {
 public:
  static constexpr int order = 1;
  explicit ImplicitLieEuler(Spins const& like, Isotropy isotropy = {}, Rotation = {},
                            ImplicitOptions options = {})
      : ImplicitLieEuler::Implicit("ImplicitLieEuler", like, isotropy, options) {}
};

/// Implicit midpoint in Cayley form, order 2: m1 = cay(dt * A((m0 + m1) / 2)) m0. Conserves |m|
/// and, without damping, energies that are quadratic in the spins. A sigma would have no effect.
/// Not in Lewis and Nigam 2002.
template <class Spins>
class ImplicitMidpoint : public detail::Implicit<Spins, isotropy::Zero, Cayley, true> {
 public:
  static constexpr int order = 2;
  explicit ImplicitMidpoint(Spins const& like, ImplicitOptions options = {})
      : ImplicitMidpoint::Implicit("ImplicitMidpoint", like, {}, options) {}
};

}  // namespace cayspin::inline v0_2
