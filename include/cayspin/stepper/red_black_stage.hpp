// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/exact_flow.hpp>
#include <cayspin/detail/for_each_site_of_colour.hpp>
#include <cayspin/detail/varied_stencil.hpp>
#include <cayspin/generator/landau_lifshitz.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace cayspin::detail {

/// One pass over a colour, over parts of a step's length: one flow of every spin, or one after the
/// other of two steps that meet there. `middle`: of each flow, in steps from the step's begin.
struct RedBlackSweep {
  std::int32_t colour = 0, flows = 1;
  double length[2] = {0, 0}, middle[2] = {0, 0};
};

/// Half of colour 0, colour 1, half of colour 0; for order 4 five times, over a, a, 1 - 4 a, a, a
/// of the step with a = 1/(4 - 4^(1/3)) (Suzuki 1990). Halves that meet share a sweep and stay two
/// flows: a flow with on-site terms is of order 2, and its errors cancel within a step of its own.
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
    sweeps[2 * k + 1] = {1, 1, {length, 0}, {begin + length / 2, 0}};
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
  constexpr RedBlackSweep meeting{0, 2, {sweeps.back().length[0], sweeps.front().length[0]}, {}};
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
/// With H(q) the field at a site whose spin is q, its neighbours as they are, the part that depends
/// on q is D(q) = H(q) - H(0). What it has along q moves nothing and is left out. The spin moves by
/// the exact flow in the fixed field H(0) + D(mean), mean = (q + q')/2 of its own begin and end q';
/// solved by iteration. Then (q' - q).(H(0) + D(mean)) is zero without damping and positive with
/// it, and where the energy is quadratic in the spins that is what it loses, in any step.
template <class Generator, class Real>
struct RedBlackStage {
  Generator generators[2];  // prepared for the middles of the flows
  SiteArray<Real, 3> spins;
  Real dt[2];
  std::int32_t flows, colour;

  void take(RedBlackSweep const& sweep, double step) {
    for (int flow = 0; flow < 2; ++flow) dt[flow] = static_cast<Real>(sweep.length[flow] * step);
    flows = sweep.flows;
    colour = sweep.colour;
  }

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    auto const mine = site.of_colour(colour);
    Vec3<typename Site::value_type> q = site.load_center(spins);
    for (std::int32_t flow = 0; flow < flows; ++flow)
      q = moved(generators[flow], site, !mine, q, dt[flow]);
    site.store_where(mine, q, spins);
  }

 private:
  static constexpr int most_iterations = 60;

  template <class Site, class Mask, class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> moved(Generator const& generator, Site const& site,
                                                Mask const& others, Vec3<Value> const& q,
                                                Real step) const {
    constexpr Real epsilon = std::numeric_limits<Real>::epsilon();
    ExactFlow<Value> const flow{generator.template damping<Value>(site), step,
                                generator.has_precession(), generator.is_damped()};
    NeighborsOfSite<Site, Real> const neighbors(site, spins);
    auto const field = [&](Vec3<Value> const& m) {
      return generator.field().field(VariedStencil(neighbors, m));
    };
    Value const zero(Real(0));
    Vec3<Value> const of_neighbors = field({zero, zero, zero}), at_begin = field(q);
    Vec3<Value> own = across(at_begin - of_neighbors, q);

    // Settled: what is left changes the spin less than the rounding of the field does.
    Value const rate = flow.damping + Value(Real(flow.precession ? 1 : 0));
    Value const settled = multiply_add(
        Value(8 * epsilon), largest_component(at_begin) + largest_component(of_neighbors),
        Value(epsilon / 4) / (Value(step < 0 ? -step : step) * rate));
    for (int i = 0;; ++i) {
      Vec3<Value> const end = flow(of_neighbors + own, q, others);
      Vec3<Value> const mean = Value(Real(0.5)) * (q + end);
      Vec3<Value> const next = across(field(mean) - of_neighbors, mean);
      // Each lane stops by itself, whatever the spins beside it need.
      auto const rests = largest_component(next - own) < settled;
      if (i == most_iterations || holds_everywhere(Mask(rests || others))) return end;
      own = {select<Value>(rests, own.x, next.x), select<Value>(rests, own.y, next.y),
             select<Value>(rests, own.z, next.z)};
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
