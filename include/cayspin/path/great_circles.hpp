// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/for_each_site.hpp>
#include <cayspin/detail/narrowing_store.hpp>
#include <cayspin/detail/reduce_sites.hpp>
#include <cayspin/minimizer/trial.hpp>
#include <cayspin/rotation/exponential.hpp>

#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

// Great circles between the spins of two states: distances, intermediate states, and the direction
// of a path at one of its states.
namespace cayspin::inline v0_2::detail {

/// Returns the tangent vector at m that leads to p along the shorter arc of the great circle; its
/// length is the angle. Between opposite spins all great circles are equally long. The one through
/// x is taken, or through y if |m_x| > 0.9.
template <class Value>
KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> way_to(Vec3<Value> const& m, Vec3<Value> const& p) {
  using Scalar = scalar_t<Value>;
  constexpr Scalar smallest_sine = sizeof(Scalar) == sizeof(double) ? Scalar(1e-7) : Scalar(1e-3f);
  Value const none(Scalar(0)), one(Scalar(1));
  Vec3<Value> const axis = cross(m, p);
  Value const sine = square_root<Value>(dot(axis, axis)), cosine = dot(m, p);
  Value const angle(Kokkos::atan2(sine, cosine));
  Value const ratio =
      select<Value>(sine == none, one, angle / (sine + select<Value>(sine == none, one, none)));
  Vec3<Value> const usual = ratio * cross(axis, m);
  auto const is_along_x = Value(Scalar(0.81)) < m.x * m.x;
  Vec3<Value> const beside{select<Value>(is_along_x, none, one),
                           select<Value>(is_along_x, one, none), none};
  Vec3<Value> const across = tangent(m, beside);
  Value const half_turn = Value(static_cast<Scalar>(std::numbers::pi)) /
                          square_root<Value>(square_to_divide_by(across));
  Value const opposite = select<Value>(sine < Value(smallest_sine), -cosine, none);
  return select<Value>(none < opposite, Vec3<Value>(half_turn * across), usual);
}

/// Returns the point to which a tangent vector at m leads.
template <class Value>
KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> end_of_way(Vec3<Value> const& m, Vec3<Value> const& way) {
  using Scalar = scalar_t<Value>;
  Vec3<Value> const end = Exponential::rotate(cross(m, way), m);
  Value const half_excess = Value(Scalar(0.5)) * (Value(Scalar(1)) - dot(end, end));
  return multiply_add(half_excess, end, end);
}

/// Functor that computes the state at a fraction of the way between two states.
template <class Real>
struct PointBetween {
  SiteArray<Real, 3> from, to;
  Real fraction;
  OutputArray<Real, 3> output;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    using Value = typename Site::value_type;
    Vec3<Value> const m = site.load(from);
    site.store(end_of_way(m, Vec3<Value>(Value(fraction) * way_to(m, Vec3<Value>(site.load(to))))),
               output);
  }
};

template <class Real>
struct SquareOfAngle {
  SiteArray<Real, 3> from, to;

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Value* values) const {
    Vec3<Value> const way = way_to(Vec3<Value>(site.load(from)), Vec3<Value>(site.load(to)));
    values[0] = dot(way, way);
  }
};

/// Functor that computes the direction t of a path at one of its states, from the vectors to the
/// states before and after it. Sums t.t and t.g.
template <class Real>
struct DirectionOfPath {
  SiteArray<Real, 3> spins, before, after, gradient;
  double weight_before, weight_after;
  SiteArray<Real, 3> direction;

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Value* values) const {
    Vec3<Value> const m = site.load(spins);
    Vec3<Value> const on = way_to(m, Vec3<Value>(site.load(after)));
    Vec3<Value> const back = way_to(m, Vec3<Value>(site.load(before)));
    Vec3<Value> const t =
        multiply_add(Value(weight_after), on, Vec3<Value>(Value(-weight_before) * back));
    values[0] = dot(t, t);
    values[1] = dot(t, Vec3<Value>(site.load(gradient)));
    store_narrowed(t, site, direction);
  }
};

/// Writes the state at a fraction of the way between two states.
template <class Exec, class Spins>
void point_between(Exec const& exec, Spins const& from, Spins const& to, double fraction,
                   Spins const& output) {
  using Real = typename Spins::value_type;
  for_each_site<Real>(exec, "cayspin::path::point_between", from.layout(),
                      PointBetween<Real>{from.array(), to.array(), static_cast<Real>(fraction),
                                         output.output(false)});
}

/// Returns the distance between two states along the great circles of all spins: the root of the
/// sum of the squared angles. Waits.
template <class Exec, class Spins>
double distance_between(Exec const& exec, Spins const& from, Spins const& to) {
  using Real = typename Spins::value_type;
  return std::sqrt(reduce_sites<Sum, 1>(exec, "cayspin::path::distance", from.layout(),
                                        SquareOfAngle<Real>{from.array(), to.array()})[0]);
}

/// The sums t.t and t.g over the sites, for the direction t of a path and the gradient g of the
/// energy.
struct Along {
  double square, slope;
};

template <class Exec, class Spins>
Along find_direction(Exec const& exec, Spins const& spins, Spins const& before, Spins const& after,
                     Spins const& gradient, double weight_before, double weight_after,
                     Spins const& direction) {
  using Real = typename Spins::value_type;
  auto const [square, slope] = reduce_sites<Sum, 2>(
      exec, "cayspin::path::direction", spins.layout(),
      DirectionOfPath<Real>{spins.array(), before.array(), after.array(), gradient.array(),
                            weight_before, weight_after, direction.array()});
  return {square, slope};
}

/// Turns the images of a path along a tangent vector, fully at one point of the path, and by less
/// and less towards the nearest fixed images on both sides. The point is at `fraction` of the way
/// from image `after` to the next one.
template <class Exec, class Path, class Spins>
void bend(Exec const& exec, Path const& path, Spins const& vector, std::size_t after,
          double fraction) {
  using Real = typename Spins::value_type;
  double const peak = static_cast<double>(after) + fraction;
  std::size_t begin = after, end = after + 1;
  while (!path.is_fixed(begin)) --begin;
  while (!path.is_fixed(end)) ++end;
  for (std::size_t k = begin + 1; k < end; ++k) {
    auto const at = static_cast<double>(k);
    double const first = static_cast<double>(begin), last = static_cast<double>(end);
    double const weight = at < peak ? (at - first) / (peak - first) : (last - at) / (last - peak);
    auto const& spins = path.spins(k);
    for_each_site<Real>(exec, "cayspin::path::bend", spins.layout(),
                        TurnTowards<Real>{spins.array(), vector.array(), spins.output(false),
                                          static_cast<Real>(weight)});
  }
}

}  // namespace cayspin::inline v0_2::detail
