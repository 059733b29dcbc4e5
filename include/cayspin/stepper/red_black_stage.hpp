// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/exact_flow.hpp>
#include <cayspin/detail/for_each_site_of_colour.hpp>
#include <cayspin/detail/local_part.hpp>
#include <cayspin/detail/varied_stencil.hpp>
#include <cayspin/generator/landau_lifshitz.hpp>
#include <cayspin/stencil.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

namespace cayspin::detail {

/// One pass over a colour, over parts of a step's length: one flow of every spin, or one after the
/// other of two steps that meet there. `middle`: of each flow, in steps from the step's begin.
struct RedBlackSweep {
  std::int32_t colour = 0, flows = 1;
  bool of_one_step = true;
  double length[2] = {0, 0}, middle[2] = {0, 0};
};

/// Half of colour 0, colour 1, half of colour 0; for order 4 five times, over a, a, 1 - 4 a, a, a
/// of the step with a = 1/(4 - 4^(1/3)) (Suzuki 1990). Halves that meet share a sweep and stay two
/// flows where the field changes with the spin itself: then a flow is of order 2, and its errors
/// cancel within a step of its own.
template <int Order>
constexpr auto red_black_sweeps() {
  constexpr int steps = Order == 2 ? 1 : 5;
  constexpr double a = 0.41449077179437573714;
  std::array<RedBlackSweep, 2 * steps + 1> sweeps{};
  double begin = 0;
  for (int k = 0; k < steps; ++k) {
    double const length = Order == 2 ? 1 : k == 2 ? 1 - 4 * a : a;
    RedBlackSweep& first = sweeps[2 * k];
    int const flow = k == 0 ? 0 : 1;
    first.flows = flow + 1;
    first.length[flow] = length / 2;
    first.middle[flow] = begin + length / 4;
    sweeps[2 * k + 1] = {1, 1, true, {length, 0}, {begin + length / 2, 0}};
    sweeps[2 * k + 2].length[0] = length / 2;
    sweeps[2 * k + 2].middle[0] = begin + 3 * length / 4;
    begin += length;
  }
  return sweeps;
}

/// Calls visit(sweep) for the sweeps of `count` steps. Where two steps meet, the last flow of one
/// and the first of the next share a sweep, to the same bits.
template <int Order, class Visit>
void for_each_sweep(std::int64_t count, Visit const& visit) {
  constexpr auto sweeps = red_black_sweeps<Order>();
  constexpr RedBlackSweep meeting{
      0, 2, false, {sweeps.back().length[0], sweeps.front().length[0]}, {}};
  visit(sweeps.front());
  for (std::int64_t step = 0; step < count; ++step) {
    for (std::size_t k = 1; k + 1 < sweeps.size(); ++k) visit(sweeps[k]);
    visit(step + 1 < count ? meeting : sweeps.back());
  }
}

template <class Value>
KOKKOS_FORCEINLINE_FUNCTION Value largest_component(Vec3<Value> const& v) {
  return maximum<Value>(Kokkos::abs(v.x), maximum<Value>(Kokkos::abs(v.y), Kokkos::abs(v.z)));
}

/// The spins of one colour move in the fields of their neighbours.
///
/// H at a site is N + D(q): the neighbours' field, and what depends on the spin itself, up to
/// multiples of the spin, which do not move it. The spin moves by the exact flow in the fixed field
/// N + D(mean), mean = (q + q')/2 of its own begin and end q'; solved by iteration. Then
/// (q' - q).(N + D(mean)) is zero without damping and positive with it, and where the energy is
/// quadratic in the spins that is what it loses, in any step.
template <class Generator, class Real>
struct RedBlackStage {
  Generator generators[2];  // prepared for the middles of the flows
  SiteArray<Real, 3> spins;
  bool changes;  // from one of them to the other
  Real dt[2];
  std::int32_t flows, colour;
  bool joined;  // flows in one field are one flow

  void take(RedBlackSweep const& sweep, double step) {
    for (int flow = 0; flow < 2; ++flow) dt[flow] = static_cast<Real>(sweep.length[flow] * step);
    flows = sweep.flows;
    colour = sweep.colour;
    joined = sweep.of_one_step && !changes;
  }

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    using Value = typename Site::value_type;
    using StencilHere = Stencil<Site, Real>;
    using Field = std::remove_cvref_t<decltype(generators[0].field())>;
    StencilHere const stencil(site, spins);
    Vec3<Value> q = stencil.center();
    if constexpr (comes_in_parts<Field, StencilHere>) {
      Vec3<Value> of_neighbors = neighbor_field(generators[0].field(), stencil);
      bool const varies = local_field_varies(generators[0].field());
      bool const at_once = !varies && flows == 2 && joined;
      for (std::int32_t which = 0; which < (at_once ? 1 : flows); ++which) {
        Field const& field = generators[which].field();
        if (which > 0 && changes) of_neighbors = neighbor_field(field, stencil);
        auto const own = [&](Vec3<Value> const& m) {
          return local_field(field, SpinAlone<Site>(site, m));
        };
        auto const flow = flow_of<Value>(which, site, at_once ? dt[0] + dt[1] : dt[which]);
        q = varies ? moved(flow, site, q, of_neighbors, own)
                   : flow(of_neighbors + own(q), q, outside(site));
      }
    } else {
      NeighborsOfSite<Site, Real> const neighbors(site, spins);
      for (std::int32_t which = 0; which < flows; ++which) {
        Field const& field = generators[which].field();
        Vec3<Value> const of_neighbors =
            field.field(VariedStencil(neighbors, zero_vector<Value>()));
        auto const flow = flow_of<Value>(which, site, dt[which]);
        q = moved(flow, site, q, of_neighbors, [&](Vec3<Value> const& m) {
          return across(field.field(VariedStencil(neighbors, m)) - of_neighbors, m);
        });
      }
    }
    site.store(q, OutputArray<Real, 3>{spins, false});
  }

 private:
  static constexpr int most_iterations = 60;

  template <class Value, class Site>
  KOKKOS_FORCEINLINE_FUNCTION ExactFlow<Value> flow_of(std::int32_t which, Site const& site,
                                                       Real step) const {
    Generator const& generator = generators[which];
    return {generator.template damping<Value>(site), step, generator.has_precession(),
            generator.is_damped()};
  }

  /// The lanes that are no sites.
  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION static auto outside(Site const& site) {
    if constexpr (Site::lanes == 1)
      return false;
    else
      return !site.inside();
  }

  /// Where q ends; own(m) is D at a spin m.
  template <class Site, class Value, class Own>
  KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> moved(ExactFlow<Value> const& flow,
                                                       Site const& site, Vec3<Value> const& q,
                                                       Vec3<Value> const& of_neighbors,
                                                       Own const& own) {
    using Mask = typename ValueTraits<Value>::mask;
    constexpr Real epsilon = std::numeric_limits<Real>::epsilon();
    auto const others = outside(site);
    Vec3<Value> d = own(q);

    // Settled: what is left changes the spin less than the rounding of the field does.
    Value const rate = flow.damping + Value(Real(flow.precession ? 1 : 0));
    Value const settled =
        multiply_add(Value(8 * epsilon), largest_component(d) + largest_component(of_neighbors),
                     Value(epsilon / 4) / (Value(flow.dt < 0 ? -flow.dt : flow.dt) * rate));
    d = own(flow.middle(of_neighbors + d, q));
    for (int i = 0;; ++i) {
      Vec3<Value> const end = flow(of_neighbors + d, q, others);
      Vec3<Value> const next = own(Value(Real(0.5)) * (q + end));
      // Each lane stops by itself, whatever the spins beside it need.
      auto const rests = largest_component(next - d) < settled;
      if (i == most_iterations || holds_everywhere(Mask(rests || others))) return end;
      d = {select<Value>(rests, d.x, next.x), select<Value>(rests, d.y, next.y),
           select<Value>(rests, d.z, next.z)};
    }
  }

  /// d without its part along m.
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> across(Vec3<Value> const& d,
                                                        Vec3<Value> const& m) {
    constexpr Real tiny = std::numeric_limits<Real>::min();
    Value const along = dot(d, m) / (dot(m, m) + Value(tiny));
    return multiply_add(Value(Value(Real(0)) - along), m, d);
  }
};

/// Steps of few spins on a host, in one launch.
template <int Order, class Stage, class Real>
struct RedBlackSteps {
  ColourRowLoop<Real, Stage> loop;
  double dt;
  std::int64_t count;

  void operator()(std::int64_t) const {
    auto local = loop;
    std::int64_t const tasks = loop.blocks.count();
    for_each_sweep<Order>(count, [&](RedBlackSweep const& sweep) {
      local.functor.take(sweep, dt);
      for (std::int64_t task = 0; task < tasks; ++task) local(task);
    });
  }
};

}  // namespace cayspin::detail
