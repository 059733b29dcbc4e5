// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/for_each_site.hpp>
#include <cayspin/detail/ghosts.hpp>
#include <cayspin/field/field_of_sites.hpp>
#include <cayspin/field/forwarding.hpp>
#include <cayspin/field/host_field.hpp>
#include <cayspin/field/multirate_weights.hpp>
#include <cayspin/optional_members.hpp>
#include <cayspin/spin_field.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <utility>

namespace cayspin::inline v0_2 {

namespace detail {

/// Functor that writes the weighted sum of the first `count` arrays.
template <class Real>
struct CombineFields {
  static constexpr std::size_t most = most_multirate_values;
  SiteArray<Real, 3> values[most];
  Real weights[most];
  int count;
  OutputArray<Real, 3> output;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    using Value = typename Site::value_type;
    Vec3<Value> sum = Value(weights[0]) * site.load(values[0]);
    for (int i = 1; i < count; ++i)
      sum = multiply_add(Value(weights[i]), site.load(values[i]), sum);
    site.store(sum, output);
  }
};

/// Returns the ratio of a site's E to m.H, for a term whose energy follows from its degree.
template <class Term>
double energy_factor_of(Term const& term) {
  if constexpr (requires { term.energy_factor; }) {
    return term.energy_factor;
  } else {
    static_assert(
        requires { requires Term::degree == 1 || Term::degree == 2; },
        "SlowField needs a term with a static constexpr int degree: 1 for H independent of the "
        "spins, 2 for H linear in them.");
    return Term::degree == 1 ? -1.0 : -0.5;
  }
}

}  // namespace detail

/// A field term that costs more than the rest, for example a demagnetising field by FFTs. In its
/// first step, Multirate evaluates it in every stage; afterwards only once a step, and interpolates
/// it in time for the stages. Outside of Multirate it behaves like the term itself; for example,
/// every evaluation of the energy recomputes it. A SlowField is a handle: the copies in an
/// EffectiveField and in a Multirate share their memory.
///
/// Term: HostField, or a term with a static `degree`, 1 or 2 (concepts.hpp).
template <class Spins, class Term>
class SlowField {
  using Real = typename Spins::value_type;
  static constexpr std::size_t most = detail::most_multirate_values;
  struct State {
    using Weights = detail::MultirateWeights (*)(double x, std::span<double const> nodes);
    State(char const* label, Lattice const& lattice) : field(label, lattice) {}

    Spins field;
    double energy_factor = -0.5;
    std::int64_t evaluations = 0;

    std::array<Spins, most> values;
    std::array<double, most> nodes{};
    Weights weights = nullptr;
    std::size_t count = 0;  // 0: the term itself is evaluated
    double begin = 0, dt = 0;
    double at = 0;  // time of `field`
    std::int64_t reads = 0;
  };

 public:
  using spins_type = Spins;
  using Weights = typename State::Weights;
  static constexpr bool is_conservative = detail::is_conservative<Term>;
  static constexpr bool depends_on_time = detail::depends_on_time<Term>;

  SlowField(Lattice const& lattice, Term term)
      : term_(std::move(term)), state_(std::make_shared<State>("SlowField::field", lattice)) {}
  /// Makes a field with the lattice, precision and memory space of the spins `like`.
  SlowField(Spins const& like, Term term) : SlowField(like.lattice(), std::move(term)) {}

  template <class Others>
  void check_spins(Others const& spins) const {
    static_assert(std::is_same_v<Others, Spins>,
                  "SlowField was made for spins of another precision or memory space.");
    require_lattice("cayspin::SlowField", state_->field.lattice(), spins.lattice());
    detail::check_spins(term_, spins);
  }

  template <class Exec, class Others>
  detail::StoredField<Real> prepare(Exec const& exec, Others const& spins, double t) const {
    static_assert(std::is_same_v<Others, Spins>,
                  "SlowField was made for spins of another precision or memory space.");
    if (is_interpolated())
      interpolate(exec, t);
    else
      evaluate(exec, spins, t, state_->field);
    return {state_->field.array(), state_->energy_factor};
  }
  template <class Exec, class Others>
  bool needs_only_time(Exec const&, Others const&) const {
    return false;  // the stored field depends on the spins
  }
  bool is_affine() const { return true; }  // by the term's degree
  /// Returns true while an Interpolated exists, so that the term is not evaluated.
  bool is_interpolated() const { return state_->count > 0; }

  friend auto parts_of(SlowField const*) {
    // A HostField's solver leaves out vacant spins itself.
    if constexpr (detail::is_local<Term> || detail::is_host_field<Term>)
      return detail::PartsOf<Term>();
    else
      return detail::PartsOf<Term, detail::SeesAllSpins<Term>>();
  }

  /// Returns how often the term was evaluated so far, by all copies.
  std::int64_t evaluations_done() const { return state_->evaluations; }

  // The members below are for Multirate.

  /// Writes the term's field into `output`, ghosts included.
  template <class Exec>
  void evaluate(Exec const& exec, Spins const& spins, double t, Spins const& output) const {
    auto prepared = detail::prepare_term(term_, exec, spins, t);
    state_->energy_factor = detail::energy_factor_of(prepared);
    detail::for_each_site<Real>(exec, "cayspin::SlowField::evaluate", spins.layout(),
                                detail::FieldOfSites<decltype(prepared), Real>{
                                    std::move(prepared), spins.array(), output.output(false)},
                                spins.layout().own);
    detail::update_ghosts(exec, output.lattice(), output);
    ++state_->evaluations;
  }

  /// While this object lives, the field is not evaluated but interpolated: it is the sum of
  /// `values`, at most 5, with the weights `weights((t - begin) / dt, nodes)`. `nodes`: the times
  /// of the values, as (t - begin) / dt. The default weights are those of the polynomial through
  /// the values.
  class Interpolated {
   public:
    Interpolated(SlowField const& slow, std::span<Spins const> values,
                 std::span<double const> nodes, double begin, double dt,
                 Weights weights = detail::interpolating_weights)
        : state_(*slow.state_) {
      std::ranges::copy(values, state_.values.begin());
      std::ranges::copy(nodes, state_.nodes.begin());
      state_.weights = weights;
      state_.begin = begin;
      state_.dt = dt;
      state_.at = std::numeric_limits<double>::quiet_NaN();
      state_.reads = 0;
      state_.count = nodes.size();
    }
    Interpolated(Interpolated const&) = delete;
    Interpolated& operator=(Interpolated const&) = delete;
    ~Interpolated() { state_.count = 0; }

    /// Returns true if the interpolated field was used since this object was constructed.
    bool was_read() const { return state_.reads > 0; }

   private:
    State& state_;
  };

 private:
  template <class Exec>
  void interpolate(Exec const& exec, double t) const {
    State& state = *state_;
    ++state.reads;
    // The end of a substep and the start of the next are equal times up to rounding.
    if (std::abs(t - state.at) <= 1e-12 * std::abs(state.dt)) return;
    state.at = t;
    auto const weights =
        state.weights((t - state.begin) / state.dt, {state.nodes.data(), state.count});
    detail::CombineFields<Real> combine{
        {}, {}, static_cast<int>(state.count), state.field.output(false)};
    for (std::size_t i = 0; i < state.count; ++i) {
      combine.values[i] = state.values[i].array();
      combine.weights[i] = static_cast<Real>(weights[i]);
    }
    detail::for_each_site<Real>(exec, "cayspin::SlowField::interpolate", state.field.layout(),
                                combine);
  }

  Term term_;
  std::shared_ptr<State> state_;
};

/// Deduces double precision in the default memory space when no spins are given.
template <class Term>
SlowField(Lattice, Term) -> SlowField<SpinField<double>, Term>;

}  // namespace cayspin::inline v0_2
