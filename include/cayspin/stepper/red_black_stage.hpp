// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/for_each_site_of_colour.hpp>
#include <cayspin/detail/varied_stencil.hpp>
#include <cayspin/field/parts.hpp>
#include <cayspin/generator/landau_lifshitz.hpp>
#include <cayspin/stencil.hpp>
#include <cayspin/stepper/exact_flow.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <utility>

namespace cayspin::inline v0_2::detail {

/// One pass over the spins of a colour. Each spin moves by one flow (its exact motion in a fixed
/// field), or by two where one step of order 2 ends and the next one starts. `length` of a flow is
/// its duration, and `middle` is the time from the start of the step to the midpoint of the flow.
/// Both are in units of dt. `of_one_step`: the flows belong to one call of `step`, not to
/// consecutive steps of a batch.
struct ColourPass {
  std::int32_t colour = 0, flows = 1;
  bool of_one_step = true;
  double length[2] = {0, 0}, middle[2] = {0, 0};
};

/// Returns the passes of a step. Order 2: colour 0 over dt/2, colour 1 over dt, colour 0 over dt/2.
/// Order 4: five such steps, with a * dt, a * dt, (1 - 4 * a) * dt, a * dt and a * dt in place of
/// dt, where a = 1 / (4 - 4^(1/3)) (Suzuki 1990). Adjacent flows of colour 0 share a pass.
/// RedBlackStage joins them into one flow, unless the field depends on the spin itself or on t. If
/// it depends on the spin itself, a flow is only accurate to order 2, and joined flows would spoil
/// the cancellation of errors between the five steps.
template <int Order>
constexpr auto colour_passes() {
  constexpr std::size_t steps = Order == 2 ? 1 : 5;
  constexpr double a = 0.41449077179437573714;
  std::array<ColourPass, 2 * steps + 1> passes{};
  double begin = 0;
  for (std::size_t k = 0; k < steps; ++k) {
    double const length = Order == 2 ? 1 : k == 2 ? 1 - 4 * a : a;
    ColourPass& first = passes[2 * k];
    int const flow = k == 0 ? 0 : 1;
    first.flows = flow + 1;
    first.length[flow] = length / 2;
    first.middle[flow] = begin + length / 4;
    passes[2 * k + 1] = {1, 1, true, {length, 0}, {begin + length / 2, 0}};
    passes[2 * k + 2].length[0] = length / 2;
    passes[2 * k + 2].middle[0] = begin + 3 * length / 4;
    begin += length;
  }
  return passes;
}

/// Calls visit(pass) for the passes of `count` steps. Where two steps meet, the last flow of one
/// and the first flow of the next share a pass; the result is bitwise identical to that of separate
/// passes.
template <int Order, class Visit>
void for_each_colour_pass(std::int64_t count, Visit const& visit) {
  constexpr auto passes = colour_passes<Order>();
  constexpr ColourPass meeting{
      0, 2, false, {passes.back().length[0], passes.front().length[0]}, {}};
  visit(passes.front());
  for (std::int64_t step = 0; step < count; ++step) {
    for (std::size_t k = 1; k + 1 < passes.size(); ++k) visit(passes[k]);
    visit(step + 1 < count ? meeting : passes.back());
  }
}

template <class Value>
KOKKOS_FORCEINLINE_FUNCTION Value largest_component(Vec3<Value> const& v) {
  return maximum<Value>(Kokkos::abs(v.x), maximum<Value>(Kokkos::abs(v.y), Kokkos::abs(v.z)));
}

/// Functor that moves the spins of one colour in the fields of their neighbours.
///
/// H at a site is N + D(q), where N is the field of the neighbours, and D(q) is the local field,
/// which may depend on the spin q itself. Multiples of the spin are omitted, because they do not
/// move it. The spin moves from q to q' by the exact flow in the fixed field N + D(mean), where
/// mean = (q + q')/2 is found by iteration. Then (q' - q).(N + D(mean)) is zero without damping,
/// and not negative with damping if dt > 0. An energy that is at most quadratic in the spins falls
/// by exactly this number in every move.
template <class Generator, class Real>
struct RedBlackStage {
  Generator generators[2];  // prepared for the midpoints of the flows
  SiteArray<Real, 3> spins;
  bool changes;  // true if the two generators may differ
  Real dt[2];
  std::int32_t flows, colour;
  bool joined;  // true if two flows may become one: they belong to one step, in equal fields

  void set(ColourPass const& pass, double step) {
    for (int flow = 0; flow < 2; ++flow) dt[flow] = static_cast<Real>(pass.length[flow] * step);
    flows = pass.flows;
    colour = pass.colour;
    joined = pass.of_one_step && !changes;
  }

  static constexpr bool takes_pairs = true;

  /// Moves one pack of spins, or two packs whose operations alternate.
  template <class Site, class... Second>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Second const&... second) const {
    Moving<Site> of_site(*this, site);
    auto const move = [&](auto&... moving) {
      bool const at_once = flows == 2 && joined && !(moving.varies(*this) || ...);
      for (std::int32_t which = 0; which < (at_once ? 1 : flows); ++which) {
        Real const step = at_once ? dt[0] + dt[1] : dt[which];
        (moving.begin(*this, which, step), ...);
        bool const varies = (moving.varies(*this) || ...);
        (moving.turn(), ...);
        // & does not short-circuit: each pack must take its next iterate.
        for (int i = 0; varies && !(int{moving.settles()} & ...) && i < most_iterations; ++i)
          (moving.turn(), ...);
        (moving.arrive(), ...);
      }
      (moving.store(*this), ...);
    };
    if constexpr (sizeof...(Second) == 0) {
      move(of_site);
    } else {
      Moving<Second...> of_second(*this, second...);
      move(of_site, of_second);
    }
  }

 private:
  static constexpr int most_iterations = 60;
  using Field = std::remove_cvref_t<decltype(std::declval<Generator const&>().field())>;

  /// A pack of spins while it moves.
  template <class Site>
  class Moving {
    using Value = typename Site::value_type;
    using Mask = typename ValueTraits<Value>::mask;
    using Vector = Vec3<Value>;
    static constexpr bool in_parts = comes_in_parts<Field, Stencil<Site, Real>>();
    struct Nothing {
      KOKKOS_FORCEINLINE_FUNCTION Nothing(Site const&, SiteArray<Real, 3> const&) {}
    };

   public:
    KOKKOS_FORCEINLINE_FUNCTION Moving(RedBlackStage const& stage, Site const& site)
        : site_(site), q_(site.load(stage.spins)), neighbors_(site, stage.spins) {}

    KOKKOS_FORCEINLINE_FUNCTION static bool varies(RedBlackStage const& stage) {
      if constexpr (in_parts)
        return local_field_varies(stage.generators[0].field());
      else
        return true;
    }

    KOKKOS_FORCEINLINE_FUNCTION void begin(RedBlackStage const& stage, std::int32_t which,
                                           Real step) {
      Generator const& generator = stage.generators[which];
      field_ = &generator.field();
      flow_ = {generator.template damping<Value>(site_), step, generator.has_precession(),
               generator.is_damped()};
      if constexpr (!in_parts)
        of_neighbors_ = field_->field(VariedStencil(neighbors_, zero<Value>()));
      else if (which == 0 || stage.changes)
        of_neighbors_ = neighbor_field(*field_, Stencil<Site, Real>(site_, stage.spins));
      d_ = own(q_);
      if (!varies(stage)) return;

      // A change of d_ below enough_ is about the rounding error of the field, or moves the spin by
      // about a quarter of an epsilon.
      constexpr Real epsilon = std::numeric_limits<Real>::epsilon();
      Value const rate = flow_.damping + Value(Real(flow_.precession ? 1 : 0));
      enough_ =
          multiply_add(Value(8 * epsilon), largest_component(d_) + largest_component(of_neighbors_),
                       Value(epsilon / 4) / (Value(step < 0 ? -step : step) * rate));
      d_ = own(flow_.middle(of_neighbors_ + d_, q_));
    }

    KOKKOS_FORCEINLINE_FUNCTION void turn() { end_ = flow_(of_neighbors_ + d_, q_, outside()); }
    /// Returns true when the field at the mean has converged. Each lane stops independently, so
    /// that its result does not depend on the other lanes.
    KOKKOS_FORCEINLINE_FUNCTION bool settles() {
      Vector const next = own(Value(Real(0.5)) * (q_ + end_));
      Mask const rests = largest_component(next - d_) < enough_;
      d_ = select<Value>(rests, d_, next);
      return holds_everywhere(Mask(rests || outside()));
    }
    KOKKOS_FORCEINLINE_FUNCTION void arrive() { q_ = end_; }
    KOKKOS_FORCEINLINE_FUNCTION void store(RedBlackStage const& stage) const {
      site_.store(q_, OutputArray<Real, 3>{stage.spins, false});
    }

   private:
    /// Returns D(m), the local part of the field at the spin m.
    KOKKOS_FORCEINLINE_FUNCTION Vector own(Vector const& m) const {
      if constexpr (in_parts)
        return local_field(*field_, SpinAlone<Site>(site_, m));
      else
        return across(field_->field(VariedStencil(neighbors_, m)) - of_neighbors_, m);
    }
    /// Returns the mask of the lanes that are not sites.
    KOKKOS_FORCEINLINE_FUNCTION Mask outside() const {
      if constexpr (Site::lanes == 1)
        return false;
      else
        return !site_.inside();
    }

    Site const& site_;
    Vector q_, of_neighbors_, d_, end_;
    Value enough_;
    ExactFlow<Value> flow_;
    Field const* field_ = nullptr;
    std::conditional_t<in_parts, Nothing, NeighborsOfSite<Site, Real>> neighbors_;
  };

  /// Returns d without its part along m.
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> across(Vec3<Value> const& d,
                                                        Vec3<Value> const& m) {
    constexpr Real tiny = std::numeric_limits<Real>::min();
    Value const along = dot(d, m) / (dot(m, m) + Value(tiny));
    return multiply_add(Value(Value(Real(0)) - along), m, d);
  }
};

/// Functor that takes `count` steps of few spins on a host, in one launch.
template <int Order, class Stage, class Real>
struct RedBlackSteps {
  ColourRowLoop<Real, Stage> loop;
  double dt;
  std::int64_t count;

  void operator()(std::int64_t) const {
    auto local = loop;
    std::int64_t const tasks = loop.blocks.count();
    for_each_colour_pass<Order>(count, [&](ColourPass const& pass) {
      local.functor.set(pass, dt);
      for (std::int64_t task = 0; task < tasks; ++task) local(task);
    });
  }
};

}  // namespace cayspin::inline v0_2::detail
