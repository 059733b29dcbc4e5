// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/minimum_energy_path.hpp>

#include <Kokkos_Profiling_ScopedRegion.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace cayspin::inline v0_2 {

namespace detail {

/// The search of a single call of lowest_escape, from a relaxed state.
template <class Exec, class Field, class Spins>
class EscapeSearch {
  using Real = typename Spins::value_type;

 public:
  /// `evaluations`: number of evaluations before this search; they count towards the limit.
  EscapeSearch(Exec const& exec, Field const& field, Spins const& state, Energy const& rest,
               PathOptions const& options, ProbedField<Spins> const& probed,
               std::int64_t evaluations)
      : exec_(exec),
        field_(field),
        state_(state),
        rest_(rest),
        options_(options),
        climber_(state.lattice()),
        probed_(probed),
        saddle_("escape::saddle", state.lattice()),
        beyond_("escape::beyond", state.lattice()),
        sides_{Spins("escape::one_side", state.lattice()),
               Spins("escape::other_side", state.lattice())},
        evaluations_(evaluations) {}

  /// Climbs along the directions, both ways. Returns converged if a saddle leads out of the state.
  PathEnd find(std::vector<Spins> const& directions) {
    for (auto const& direction : directions) {
      double const longest = largest_length(exec_, direction);
      if (!(longest > 0)) continue;
      for (double const step : {push / longest, -push / longest}) {
        climb(direction, step);
        if (is_stopped_) return PathEnd::interrupted;
        if (evaluations_ >= options_.evaluations) return PathEnd::evaluation_limit;
      }
    }
    return lowest_ ? PathEnd::converged : PathEnd::no_saddle;
  }

  std::int64_t evaluations() const { return evaluations_; }
  Energy const& energy_beyond() const { return energy_beyond_; }
  SaddleFound const& lowest() const { return *lowest_; }

  /// Writes images from the state over the saddle to the state beyond it, along great circles.
  /// Returns the index of the saddle.
  std::size_t write(std::vector<Spins> const& images) const {
    double const before = distance_between(exec_, state_, saddle_),
                 after = distance_between(exec_, saddle_, beyond_);
    std::size_t const last = images.size() - 1;
    auto const wanted = std::llround(static_cast<double>(last) * before / (before + after));
    auto const top = std::clamp<std::size_t>(static_cast<std::size_t>(wanted), 1, last - 1);
    auto const fraction = [](std::size_t part, std::size_t whole) {
      return static_cast<double>(part) / static_cast<double>(whole);
    };
    for (std::size_t k = 1; k < top; ++k)
      point_between(exec_, state_, saddle_, fraction(k, top), images[k]);
    Kokkos::deep_copy(exec_, images[top].allocation(), saddle_.allocation());
    for (std::size_t k = top + 1; k < last; ++k)
      point_between(exec_, saddle_, beyond_, fraction(k - top, last - top), images[k]);
    Kokkos::deep_copy(exec_, images.back().allocation(), beyond_.allocation());
    return top;
  }

 private:
  static constexpr std::int64_t climb_evaluations = 600;  // most of one climb
  static constexpr double zero_curvature = 1e-4;          // relative to the field without exchange
  static constexpr double push = 0.2;                     // turn of a spin away from the state, rad
  static constexpr double fall = 0.1;                     // turn of a spin away from a saddle, rad
  static constexpr double same = 1e-3;                    // distance of equal states, rad

  std::int64_t left() const {
    return std::max<std::int64_t>(1, options_.evaluations - evaluations_);
  }

  bool proceeds(std::int64_t more_evaluations, double energy, double gradient) const {
    auto const& observer = options_.observer;
    return !observer ||
           observer({evaluations_ + more_evaluations, energy, gradient}) == Next::proceed;
  }

  void turn(Spins const& from, Spins const& vector, double step, Spins const& to) const {
    for_each_site<Real>(
        exec_, "cayspin::escape::turn", from.layout(),
        TurnTowards<Real>{from.array(), vector.array(), to.output(false), static_cast<Real>(step)});
  }

  /// Climbs from the state turned by step * direction. Keeps the saddle if it leads out of the
  /// state and is the lowest so far.
  void climb(Spins const& direction, double step) {
    turn(state_, direction, step, climber_.spins());
    combine(exec_, step, direction, 0, direction, climber_.vector());
    auto const climbed = climber_.find(
        exec_, field_, probed_.is_mobile, probed_.preconditioner,
        probed_.climb(options_.time, options_.torque, std::min(left(), climb_evaluations)),
        [&](SaddleFound const& now) {
          return proceeds(now.evaluations, now.energy.value, now.torque);
        });
    evaluations_ += climbed.evaluations;
    is_stopped_ = climbed.is_stopped;
    double const barrier = climbed.energy.value - rest_.value;
    if (is_stopped_ || !climbed.is_saddle || !(barrier > 4 * round_off())) return;
    // A texture that slides over the lattice has such saddles everywhere.
    if (-climbed.curvature < zero_curvature * probed_.preconditioner.first_shift()) return;
    if (lowest_ && !(climbed.energy.value < lowest_->energy.value)) return;
    std::array<Minimum, 2> ends;
    double const down = fall / largest_length(exec_, climber_.vector());
    for (std::size_t side = 0; side < 2; ++side) {
      turn(climber_.spins(), climber_.vector(), side == 0 ? down : -down, sides_[side]);
      ends[side] = relax(sides_[side]);
      if (ends[side].end != MinimizeEnd::converged) return;
    }
    std::array<double, 2> way{};
    std::array<bool, 2> comes_back{};
    for (std::size_t side = 0; side < 2; ++side) {
      way[side] = distance_between(exec_, state_, sides_[side]);
      // A state that can move without a barrier may come back elsewhere, so the energies are
      // compared. The torque that is left of either state changes the energy on the way.
      double const left_torque = options_.torque * std::sqrt(sites()) * way[side];
      double const most = std::min(1e-6 * barrier + left_torque, 1e-2 * barrier);
      comes_back[side] =
          std::abs(ends[side].energy.value - rest_.value) <= std::max(round_off(), most);
    }
    if (!comes_back[0] && !comes_back[1]) return;
    bool const both = comes_back[0] && comes_back[1];
    std::size_t const out = both ? (way[0] < way[1] ? 1 : 0) : (comes_back[0] ? 1 : 0);
    if (way[out] < same) return;
    lowest_ = climbed;
    energy_beyond_ = ends[out].energy;
    Kokkos::deep_copy(exec_, saddle_.allocation(), climber_.spins().allocation());
    Kokkos::deep_copy(exec_, beyond_.allocation(), sides_[out].allocation());
  }

  double sites() const { return static_cast<double>(state_.lattice().sites()); }

  double round_off() const { return round_off_of_energy<Real>(rest_, sites()); }

  Minimum relax(Spins& spins) {
    auto const found = minimize(exec_, field_, spins,
                                {.torque = options_.torque,
                                 .evaluations = left(),
                                 .time = options_.time,
                                 .preconditioned = options_.preconditioned,
                                 .observer = [this](Minimum const& now) {
                                   return proceeds(now.evaluations, now.energy.value, now.torque)
                                              ? Next::proceed
                                              : Next::stop;
                                 }});
    evaluations_ += found.evaluations;
    is_stopped_ = found.end == MinimizeEnd::interrupted;
    return found;
  }

  Exec const& exec_;
  Field const& field_;
  Spins const& state_;
  Energy rest_;  // of the state
  PathOptions const& options_;
  SaddleSearch<Spins> climber_;
  ProbedField<Spins> probed_;
  Spins saddle_, beyond_;
  std::array<Spins, 2> sides_;
  std::int64_t evaluations_;
  std::optional<SaddleFound> lowest_;
  Energy energy_beyond_ = {};
  bool is_stopped_ = false;
};

/// lowest_escape from a relaxed first image of the energy `rest`. `before`: a search so far, whose
/// evaluations count towards the limit.
template <class Exec, class Field, class Spins>
MinimumEnergyPath escape_from_rest(Exec const& exec, Field const& field, Energy const& rest,
                                   std::vector<Spins> const& directions, std::vector<Spins>& images,
                                   Spins& saddle, PathOptions const& options,
                                   ProbedField<Spins> const& probed, MinimumEnergyPath before) {
  EscapeSearch search(exec, field, images.front(), rest, options, probed, before.evaluations);
  before.end = search.find(directions);
  before.evaluations = search.evaluations();
  if (before.end != PathEnd::converged) return before;
  auto const top = search.write(images);
  auto between = options;
  between.starts_from_images = true;
  PathFinder path(exec, field, images, between, probed, before.evaluations);
  path.fix_saddle(top, search.lowest());
  return path.find(saddle, rest, search.energy_beyond());
}

}  // namespace detail

/// Number of fields of three numbers per site that lowest_escape allocates in addition to what
/// minimum_energy_path does.
inline constexpr int escape_work_fields = detail::SaddleSearch<SpinField<double>>::work_fields + 5;

/// Finds a way out of a state when no other state is known: the lowest saddle around it, another
/// state beyond that saddle, and the minimum energy path between the two states.
///
/// Relaxes the first image, and climbs from it along each direction and its opposite to a saddle,
/// as minimum_energy_path does from a maximum of the energy. Each direction has a tangent vector
/// for each site; the modes of lowest curvature are a good choice, but not zero modes, along which
/// there is nothing to climb. From a saddle, the spins are relaxed on both sides. One side must
/// lead back to a state of the same energy. The lowest such saddle counts, though there may be
/// lower ones that no direction leads to; saddles with almost no curvature do not count. The other
/// images become the path over it, from the state to that on the other side. If there is no such
/// saddle, `end` is no_saddle, and the path has no energies.
///   std::vector<Spins> images = ...;  // the first one is the state
///   std::vector<Spins> directions;
///   for (auto const& one : cayspin::lowest_curvatures(exec, field, images[0]).curvatures)
///     directions.push_back(one.vector);
///   auto const path = cayspin::lowest_escape(exec, field, directions, images, saddle);
/// options.starts_from_images is ignored. Waits. Throws like minimum_energy_path, and for
/// directions on another lattice.
template <class Exec, class Field, class Spins>
MinimumEnergyPath lowest_escape(Exec const& exec, Field const& field,
                                std::vector<Spins> const& directions, std::vector<Spins>& images,
                                Spins& saddle, PathOptions const& options = {}) {
  Kokkos::Profiling::ScopedRegion const region("cayspin::lowest_escape");
  detail::require_images("cayspin::lowest_escape", images, saddle);
  for (auto const& direction : directions)
    require_lattice("cayspin::lowest_escape", direction.lattice(), saddle.lattice());
  auto& state = images.front();
  MinimumEnergyPath unfinished;
  auto const rest = detail::relax_end(exec, field, state, options, unfinished);
  if (rest.end != MinimizeEnd::converged) return unfinished;
  detail::ProbedField<Spins> const probed(exec, field, state, options.time, options.preconditioned);
  unfinished.evaluations += probed.evaluations;
  return detail::escape_from_rest(exec, field, rest.energy, directions, images, saddle, options,
                                  probed, unfinished);
}

}  // namespace cayspin::inline v0_2
