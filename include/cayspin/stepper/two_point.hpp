// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/concepts.hpp>
#include <cayspin/detail/for_each_site.hpp>
#include <cayspin/generator/orthogonal.hpp>
#include <cayspin/isotropy/policies.hpp>
#include <cayspin/isotropy/sigma.hpp>
#include <cayspin/rotation/cayley.hpp>
#include <cayspin/spin_field.hpp>
#include <cayspin/stencil.hpp>
#include <cayspin/stepper/stepper_base.hpp>

#include <limits>

// Methods whose steps use two values of the generator A, one of which is stored in a field:
// LieEuler with sigma from finite differences of A_o = A - (m.A) * m, and the two-step method of
// Adams and Bashforth.
namespace cayspin::inline v0_2 {

namespace detail {

/// Input of a rule (one of the functors below) at a site: the spin m at which A is evaluated, the
/// spin m0 at the start of the step, a = A + sigma * m with the sigma of the isotropy policy, the
/// stored vector `kept`, and dt. The rule returns the coordinates F of the rotation that moves m0.
/// If Rule::writes is true, it sets `kept` to the vector to store.
template <class Value>
struct TwoPoints {
  Vec3<Value> m, m0, a, kept;
  Value dt;
};

/// F = dt * A_o; stores A_o.
struct PredictOrthogonal {
  static constexpr bool reads = false, writes = true;
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> operator()(TwoPoints<Value>& p) const {
    p.kept = orthogonal_part(p.a, p.m);
    return p.dt * p.kept;
  }
};

/// F = dt * (w + sigma * m0), where w is the stored A_o, and sigma comes from the difference
/// between w and A_o at m.
struct ForwardDifference {
  static constexpr bool reads = true, writes = false;
  double cap;
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> operator()(TwoPoints<Value>& p) const {
    Value const limit(static_cast<scalar_t<Value>>(cap));
    Vec3<Value> const difference = orthogonal_part(p.a, p.m) - p.kept;
    return multiply_add(turn_from_difference(difference, p.kept, p.m0, limit), p.m0,
                        Vec3<Value>(p.dt * p.kept));
  }
};

/// F = dt * (w + sigma * m0); stores w. Here w is A_o at m, and sigma comes from the difference
/// between w and the stored A_o. This difference is multiplied by ratio = dt / (previous dt).
struct BackwardDifference {
  static constexpr bool reads = true, writes = true;
  double cap, ratio;
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> operator()(TwoPoints<Value>& p) const {
    using Scalar = scalar_t<Value>;
    Vec3<Value> const w = orthogonal_part(p.a, p.m);
    Vec3<Value> const difference = Value(static_cast<Scalar>(ratio)) * (w - p.kept);
    p.kept = w;
    return multiply_add(turn_from_difference(difference, w, p.m0, Value(static_cast<Scalar>(cap))),
                        p.m0, Vec3<Value>(p.dt * w));
  }
};

/// F = dt * A; stores A.
struct PredictFull {
  static constexpr bool reads = false, writes = true;
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> operator()(TwoPoints<Value>& p) const {
    p.kept = p.a;
    return p.dt * p.a;
  }
};

/// F = dt * (A + kept) / 2.
struct Average {
  static constexpr bool reads = true, writes = false;
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> operator()(TwoPoints<Value>& p) const {
    return Value(Value(0.5) * p.dt) * (p.a + p.kept);
  }
};

/// F = dt * (A + ratio * (A - kept) / 2), with ratio = dt / (previous dt); stores A.
struct Extrapolate {
  static constexpr bool reads = true, writes = true;
  double ratio;
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> operator()(TwoPoints<Value>& p) const {
    Value const half(static_cast<scalar_t<Value>>(0.5 * ratio));
    Vec3<Value> const f = multiply_add(half, p.a - p.kept, p.a);
    p.kept = p.a;
    return p.dt * f;
  }
};

struct ForwardDifferenceMethod {
  static constexpr int order = 1;
  static constexpr bool remembers = false;
  double cap = std::numeric_limits<double>::infinity();
  PredictOrthogonal predict() const { return {}; }
  ForwardDifference correct() const { return {cap}; }
};

struct BackwardDifferenceMethod : ForwardDifferenceMethod {
  static constexpr bool remembers = true;
  BackwardDifference next(double ratio) const { return {cap, ratio}; }
};

struct AdamsBashforthMethod {
  static constexpr int order = 2;
  static constexpr bool remembers = true;
  PredictFull predict() const { return {}; }
  Average correct() const { return {}; }
  Extrapolate next(double ratio) const { return {ratio}; }
};

template <class Rule, class Isotropy, class Rotation, class Generator, class Real>
struct TwoPointStage {
  Generator generator;
  Isotropy isotropy;
  Rule rule;
  SiteArray<Real, 3> start, level;
  OutputArray<Real, 3> kept, next;
  Real dt;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    using Value = typename Site::value_type;
    Stencil<Site, Real> const stencil(site, level);
    TwoPoints<Value> points;
    points.m = stencil.center();
    points.m0 = level.data == start.data ? points.m : site.load(start);
    points.a = isotropy(points.m, evaluate(generator, stencil));
    if constexpr (Rule::reads) points.kept = site.load(kept);
    points.dt = Value(dt);
    Vec3<Value> const f = rule(points);
    if constexpr (Rule::writes) site.store(points.kept, kept);
    site.store(Rotation::rotate(f, points.m0), next);
  }
};

}  // namespace detail

/// A stepper that stores the generator A, or A_o = A - (m.A) * m, between the two evaluations of a
/// step, or from one step to the next. Method, for example detail::ForwardDifferenceMethod, defines
/// how a step uses the stored and the new value. Work memory: two fields.
template <class Spins, class Method, class Isotropy, class Rotation>
class TwoPoint : public detail::StepperBase<Spins> {
  using Base = detail::StepperBase<Spins>;

 public:
  using typename Base::Real;
  static constexpr int order = Method::order;
  static constexpr int evaluations = Method::remembers ? 1 : 2;  // generator evaluations per step
  static constexpr int ghosts = 2;
  static constexpr int work_fields = 2;

  explicit TwoPoint(std::string const& name, Spins const& like, Method method,
                    Isotropy isotropy = {})
      : Base(name, like.lattice(), ghosts),
        method_(method),
        isotropy_(detail::checked_policy(isotropy)),
        next_(name + "::next", like.lattice()),
        kept_(name + "::kept_generator", like.lattice()),
        streaming_(detail::exceeds_caches<DefaultExec>(like.bytes() + work_bytes())) {}

  /// Returns the number of generator evaluations in the next step. A method that remembers the
  /// previous step needs two in its first step and one in each later step.
  int next_step_evaluations() const { return last_dt_ == 0 ? 2 : evaluations; }

  std::size_t work_bytes() const { return work_fields * next_.bytes(); }

  /// Advances `spins` from t to t + dt under `generator`. For a method that remembers the previous
  /// step, `spins` must be those at the end of that step. A step may swap the memory of `spins`
  /// with that of the stepper, so call spins.array() again after it. Throws std::invalid_argument
  /// when `spins` is not on the lattice given at construction.
  template <class Exec, class Generator>
  void step(Exec const& exec, Generator const& generator, Spins& spins, double t, double dt) {
    auto const region = this->begin_step(exec, spins);
    this->require_other_memory(spins, next_);
    if constexpr (Method::remembers) {
      if (last_dt_ != 0) {
        stage(exec, generator, step_label_, method_.next(dt / last_dt_), spins, spins, next_, t,
              dt);
        swap(spins, next_);
        last_dt_ = dt;
        return detail::update_ghosts(exec, this->lattice_, spins);
      }
    }
    stage(exec, generator, predict_label_, method_.predict(), spins, spins, next_, t, dt);
    stage(exec, generator, correct_label_, method_.correct(), spins, next_, spins, t + dt, dt);
    last_dt_ = dt;
    detail::update_ghosts(exec, this->lattice_, spins);
  }

  /// Forgets the previous step, so that the next step is a first step. cayspin::integrate calls
  /// this at the start of each run that does not continue the previous one.
  void reset()
    requires(Method::remembers)
  {
    last_dt_ = 0;
  }

  /// For cayspin::serialize.
  template <class Visit>
  void visit_memory(Visit const& visit)
    requires(Method::remembers)
  {
    visit("last_dt", last_dt_);
    if (last_dt_ != 0) visit("kept_generator", kept_);
  }

  /// Visits the field whose memory a step may swap with that of the spins, for cayspin::integrate.
  template <class Visit>
  void visit_exchanged(Visit const& visit) {
    visit(next_);
  }

  /// Evaluates A at `spins` and time t, and stores it as the value at the start of a previous step
  /// of dt. The next call of `step` must start at t + dt.
  template <class Exec, class Generator>
  void remember(Exec const& exec, Generator const& generator, Spins const& spins, double t,
                double dt)
    requires(Method::remembers)
  {
    auto const region = this->begin_step(exec, spins, "::remember");
    this->require_other_memory(spins, next_);
    stage(exec, generator, predict_label_, method_.predict(), spins, spins, next_, t, dt);
    last_dt_ = dt;
  }

 private:
  using DefaultExec = typename Spins::memory_space::execution_space;

  template <class Exec, class Generator, class Rule>
  void stage(Exec const& exec, Generator const& generator, std::string const& label, Rule rule,
             Spins const& start, Spins const& level, Spins const& next, double t, double dt) {
    auto prepared = detail::prepare_term(generator, exec, level, t);
    using Kernel = detail::TwoPointStage<Rule, Isotropy, Rotation, decltype(prepared), Real>;
    Kernel const kernel{
        std::move(prepared),
        isotropy_,
        rule,
        start.array(),
        level.array(),
        kept_.output(streaming_ && !Rule::reads),
        next.output(streaming_ && next.allocation().data() != start.allocation().data()),
        static_cast<Real>(dt)};
    auto const& layout = start.layout();
    bool const predicts = !Rule::reads;
    detail::for_each_site<Real>(exec, label, layout, kernel, layout.own_and(predicts ? 1 : 0));
  }

  std::string predict_label_ = this->label("::predict"), correct_label_ = this->label("::correct"),
              step_label_ = this->label("::step");
  Method method_;
  Isotropy isotropy_;
  Spins next_, kept_;
  bool streaming_;  // stores to write-only fields bypass the caches
  double last_dt_ = 0;
};

/// The two-step method of Adams and Bashforth, order 2 with one evaluation per step:
/// m <- cay(dt * (3 * xi_n - xi_(n-1)) / 2) m, xi = A + sigma * m. If dt changes, the argument of
/// cay is dt * (xi_n + (dt / previous dt) * (xi_n - xi_(n-1)) / 2). The first step is a LieHeun
/// step.
template <class Spins, class Isotropy = isotropy::Zero, class Rotation = Cayley>
class LieAdamsBashforth2
    : public TwoPoint<Spins, detail::AdamsBashforthMethod, Isotropy, Rotation> {
 public:
  explicit LieAdamsBashforth2(Spins const& like, Isotropy isotropy = {}, Rotation = {})
      : LieAdamsBashforth2::TwoPoint("LieAdamsBashforth2", like, {}, isotropy) {}
};

}  // namespace cayspin::inline v0_2
