// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/minimize.hpp>
#include <cayspin/path/disturbance.hpp>
#include <cayspin/path/found.hpp>
#include <cayspin/path/images.hpp>
#include <cayspin/path/missed_saddle.hpp>
#include <cayspin/path/probed_field.hpp>
#include <cayspin/path/relax_end.hpp>
#include <cayspin/path/saddle.hpp>
#include <cayspin/path/string.hpp>

#include <Kokkos_Profiling_ScopedRegion.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

namespace cayspin::inline v0_2 {

namespace detail {

/// The search of a single call of minimum_energy_path.
template <class Exec, class Field, class Spins>
class PathFinder {
  using Real = typename Spins::value_type;

 public:
  /// `evaluations`: number of evaluations before this search; they count towards the limit.
  PathFinder(Exec const& exec, Field const& field, std::vector<Spins> const& images,
             PathOptions const& options, ProbedField<Spins> const& probed, std::int64_t evaluations)
      : exec_(exec),
        field_(field),
        options_(options),
        string_(images),
        saddle_(images.front().lattice()),
        probed_(probed),
        highest_("path::highest", images.front().lattice()),
        peak_("path::peak", images.front().lattice()) {
    found_.evaluations = evaluations;
  }

  /// Makes an image that is a saddle a fixed image of the path. Call it before find().
  void fix_saddle(std::size_t image, SaddleFound const& known) {
    string_.fix(image, known.energy);
    allow_for(known.energy);
    Kokkos::deep_copy(exec_, highest_.allocation(), string_.spins(image).allocation());
    found_.saddles.push_back(
        {known.energy.value, known.curvature, known.next_curvature, known.torque, 0});
  }

  MinimumEnergyPath find(Spins const& saddle, Energy const& from, Energy const& to) {
    std::size_t const last = string_.size() - 1;
    string_.fix(0, from);
    string_.fix(last, to);
    allow_for(from);
    allow_for(to);
    if (distance_between(exec_, string_.spins(0), string_.spins(last)) < 1e-3)
      return ended(PathEnd::same_ends, saddle);
    if (!options_.starts_from_images) make_start();
    auto end = search();
    if (end == PathEnd::converged || end == PathEnd::no_saddle) {
      found_.needs_images =
          string_.size() <= few_images && misses_saddle(
                                              exec_, string_, found_.saddles, saddle_, peak_,
                                              round_off_, [this] { return climb().is_saddle; },
                                              [this](Spins& spins) { return relaxed(spins); });
      if (found_.needs_images) end = PathEnd::unsettled;
      if (stopped_) end = PathEnd::interrupted;
    }
    return ended(end, saddle);
  }

 private:
  static constexpr double disturbance = 0.1;          // rad
  static constexpr double rough = 0.03, fine = 2e-3;  // gradients, relative to the strongest field
  static constexpr double longest_turn = 0.3;         // of a spin in a step, rad
  static constexpr std::size_t few_images = 8;        // of a path that may hide a saddle

  /// Places the images along the great circles of the spins, with a disturbance that is largest in
  /// the middle of the path.
  void make_start() {
    auto const &work = saddle_.spins(), &pattern = saddle_.vector();
    make_disturbance(exec_, probed_.preconditioner, work, pattern);
    for_each_site<Real>(
        exec_, "cayspin::path::keep_mobile", work.layout(),
        KeepMobile<Real>{pattern.array(), probed_.is_mobile.array(), pattern.output(false)});
    std::size_t const last = string_.size() - 1;
    for (std::size_t k = 1; k < last; ++k) {
      double const fraction = static_cast<double>(k) / static_cast<double>(last);
      point_between(exec_, string_.spins(0), string_.spins(last), fraction, work);
      for_each_site<Real>(
          exec_, "cayspin::path::disturb", work.layout(),
          TurnTowards<Real>{
              work.array(), pattern.array(), string_.spins(k).output(false),
              static_cast<Real>(disturbance * std::sin(std::numbers::pi * fraction))});
    }
  }

  /// Relaxes the string roughly. Then adds saddles and minima to it as fixed images, and relaxes it
  /// between them, until it is a minimum energy path without further maxima.
  PathEnd search() {
    double bound = rough;
    if (auto const end = relax(bound, true)) return *end;
    double smallest = 0.05;  // least prominence of a peak, relative to the range of energies
    for (int attempt = 0; attempt < 60; ++attempt) {
      auto const peak = next_peak(1, smallest);
      bool const added = peak ? add_saddle(*peak) : add_minimum(smallest);
      if (stopped_) return PathEnd::interrupted;
      std::optional<PathEnd> end;
      if (added) {
        if (auto const stopped = relax(rough, false, 10)) return *stopped;
        is_settled_ = false;
        continue;
      }
      bool const is_low = peak && !found_.saddles.empty() && peak->energy < found_.saddle().energy;
      if (peak && !(is_low && bound < fine)) {
        if (bound < fine) return PathEnd::no_saddle;
        bound *= 0.3;
        end = relax(bound, true);
      } else if (found_.saddles.empty()) {
        // A barrier may be low compared with the range of energies along the path.
        if (smallest <= 1e-3) return PathEnd::no_saddle;
        smallest = std::max(0.2 * smallest, 1e-3);
        bound = std::max(0.3 * bound, fine);
        end = relax(bound, true);
      } else {
        if (is_settled_) return PathEnd::converged;
        end = relax(fine, false);
        if (!end && !is_settled_) return PathEnd::unsettled;
        smallest = 1e-3;
      }
      if (end) return *end;
    }
    return PathEnd::no_saddle;
  }

  void allow_for(Energy const& energy) {
    auto const sites = static_cast<double>(highest_.lattice().sites());
    round_off_ = std::max(round_off_, round_off_of_energy<Real>(energy, sites));
  }

  /// Returns a limit on the sum of |g|^2 over the sites of an image, where g is the gradient across
  /// the path. This gradient raises the energy by up to about the sum / 2 c, where c is the field
  /// without exchange. If `bound` is `fine`, that is little compared with the lower barrier, unless
  /// there is hardly any barrier.
  double most_square(double bound) const {
    constexpr double little = 5e-3;
    double barrier = span_of(string_.profile());
    if (!found_.saddles.empty()) {
      double const higher = std::max(string_.energy(0), string_.energy(string_.size() - 1));
      barrier = std::clamp(found_.saddle().energy - higher, 1e-2 * barrier, barrier);
    }
    double const field = probed_.preconditioner.first_shift();
    double const energy = std::max({little * barrier, round_off_, 0.5 * fine * fine * field});
    return 2 * field * energy * std::pow(bound / fine, 2);
  }

  /// Relaxes the string until the gradient perpendicular to the path is below `bound` times the
  /// strongest field and below its most_square(): at the highest image if `of_highest`, otherwise
  /// at all images. Returns early after `most_steps` steps. Also returns early if the gradient
  /// stops falling; but unless `of_highest`, it first switches from L-BFGS to sweeps
  /// (PathString::sweep) and shortens their steps whenever the gradient stops falling again. Sets
  /// is_settled_ to true if all images reached the bound and `of_highest` is false. Returns the
  /// reason if the whole search must end, otherwise nothing.
  std::optional<PathEnd> relax(double bound, bool of_highest,
                               int most_steps = std::numeric_limits<int>::max()) {
    double share = 1, least = std::numeric_limits<double>::infinity();
    if (of_highest && string_.sweeps()) string_.sweep(0);
    auto const sites = static_cast<double>(highest_.lattice().sites());
    double const round_off = 64.0 * std::numeric_limits<Real>::epsilon() * probed_.strongest;
    auto const is_small = [&](double across, double square) {
      return across < std::max(bound * probed_.strongest, round_off) &&
             square < std::max(most_square(bound), sites * round_off * round_off);
    };
    for (int step = 0, since = 0;; ++step, ++since) {
      double const largest = string_.look(exec_, field_, options_.time);
      std::size_t highest = 0;
      double square = 0;
      for (std::size_t k = 1; k < string_.size(); ++k) {
        if (string_.energy(k) > string_.energy(highest)) highest = k;
        square = std::max(square, string_.square(k));
      }
      found_.across = largest;
      auto const so_far = found_.evaluations + string_.evaluations();
      if (!std::isfinite(largest)) return PathEnd::not_finite;
      is_settled_ = !of_highest && is_small(largest, square);
      if (is_settled_ ||
          (of_highest && step >= 5 && is_small(string_.across(highest), string_.square(highest))))
        return std::nullopt;
      if (step >= most_steps) return std::nullopt;
      if (so_far >= options_.evaluations) return PathEnd::evaluation_limit;
      if (!proceeds(so_far, string_.energy(highest), largest)) return PathEnd::interrupted;
      if (largest < 0.9 * least) since = 0;
      least = std::min(least, largest);
      if (since > 30) {
        if (share < 0.2 || of_highest) return std::nullopt;
        if (string_.sweeps()) share *= 0.5;
        string_.sweep(share);
        since = 0;
        least = std::numeric_limits<double>::infinity();
      }
      string_.step(exec_, probed_.preconditioner, probed_.is_mobile, longest_turn);
    }
  }

  bool proceeds(std::int64_t evaluations, double energy, double gradient) const {
    return !options_.observer ||
           options_.observer(PathProgress{evaluations, energy, gradient}) == Next::proceed;
  }

  /// Returns the highest maximum (sign 1) or the lowest minimum (sign -1) of the energy along the
  /// path that is not at a fixed image and is prominent enough.
  std::optional<Peak> next_peak(int sign, double smallest) const {
    auto points = string_.profile();
    for (auto& point : points) point.energy *= sign, point.slope *= sign;
    // The remaining gradient across the path can cause peaks up to this height.
    double const left =
        is_settled_ ? 2 * found_.across * found_.across / probed_.preconditioner.first_shift() : 0;
    double const least = std::max({smallest * span_of(points), left, round_off_});
    for (auto const& peak : peaks_of(points))
      if (peak.prominence > least) return peak;
    return std::nullopt;
  }

  static double span_of(std::vector<PointOfProfile> const& points) {
    auto const [low, high] = std::ranges::minmax(points, {}, &PointOfProfile::energy);
    return high.energy - low.energy;
  }

  bool is_known(Spins const& spins) const {
    for (std::size_t k = 0; k < string_.size(); ++k)
      if (string_.is_fixed(k) && distance_between(exec_, string_.spins(k), spins) < 1e-3)
        return true;
    return false;
  }

  /// Relaxes the state at the lowest minimum of the energy along the path, and adds the result as a
  /// fixed image, because the path may turn a corner there. Returns true if an image was added.
  bool add_minimum(double smallest) {
    auto const valley = next_peak(-1, smallest);
    if (!valley) return false;
    auto const& [image, fraction] = valley->place;
    auto& spins = saddle_.spins();
    point_between(exec_, string_.spins(image), string_.spins(image + 1), fraction, spins);
    auto const found = relaxed(spins);
    if (found.end != MinimizeEnd::converged || is_known(spins)) return false;
    is_settled_ = false;
    return string_.insert(exec_, spins, found.energy, image);
  }

  Minimum relaxed(Spins& spins) {
    auto const so_far = found_.evaluations + string_.evaluations();
    auto const found = minimize(
        exec_, field_, spins,
        {.torque = options_.torque,
         .evaluations = std::max<std::int64_t>(1, options_.evaluations - so_far),
         .time = options_.time,
         .preconditioned = options_.preconditioned,
         .observer = [this, so_far](Minimum const& now) {
           return proceeds(so_far + now.evaluations, now.energy.value, now.torque) ? Next::proceed
                                                                                   : Next::stop;
         }});
    found_.evaluations += found.evaluations;
    stopped_ = found.end == MinimizeEnd::interrupted;
    return found;
  }

  /// Climbs from the state saddle_.spins(), at first along saddle_.vector().
  SaddleFound climb() {
    std::int64_t const so_far = found_.evaluations + string_.evaluations();
    auto const climbed =
        saddle_.find(exec_, field_, probed_.is_mobile, probed_.preconditioner,
                     probed_.climb(options_.time, options_.torque, options_.evaluations - so_far),
                     [&](SaddleFound const& now) {
                       return proceeds(so_far + now.evaluations, now.energy.value, now.torque);
                     });
    found_.evaluations += climbed.evaluations;
    stopped_ = climbed.is_stopped;
    return climbed;
  }

  /// Climbs from a maximum of the energy along the path to a saddle, and adds the saddle as a fixed
  /// image. Returns true if it was added.
  bool add_saddle(Peak const& peak) {
    auto const& [image, fraction] = peak.place;
    auto const &before = string_.spins(image), &after = string_.spins(image + 1);
    point_between(exec_, before, after, fraction, saddle_.spins());
    find_direction(exec_, saddle_.spins(), before, after, saddle_.spins(), 1, 1, saddle_.vector());
    Kokkos::deep_copy(exec_, peak_.allocation(), saddle_.spins().allocation());
    auto const climbed = climb();
    if (!climbed.is_saddle) return false;
    // Rejects saddles far above the path, and those that are already on it.
    if (climbed.energy.value > peak.energy + 0.1 * span_of(string_.profile())) return false;
    if (is_known(saddle_.spins())) return false;
    find_direction(exec_, peak_, peak_, saddle_.spins(), peak_, 0, 1, saddle_.vector());
    bend(exec_, string_, saddle_.vector(), image, fraction);
    if (!string_.insert(exec_, saddle_.spins(), climbed.energy, image)) return false;
    is_settled_ = false;
    allow_for(climbed.energy);
    if (found_.saddles.empty() || climbed.energy.value > found_.saddle().energy)
      Kokkos::deep_copy(exec_, highest_.allocation(), saddle_.spins().allocation());
    found_.saddles.push_back(
        {climbed.energy.value, climbed.curvature, climbed.next_curvature, climbed.torque, 0});
    std::ranges::sort(found_.saddles, std::greater<>(), &PathSaddle::energy);
    return true;
  }

  MinimumEnergyPath ended(PathEnd end, Spins const& saddle) {
    found_.end = end;
    found_.evaluations += string_.evaluations();
    double at = 0;
    for (std::size_t k = 0; k < string_.size(); ++k) {
      if (k > 0) at += distance_between(exec_, string_.spins(k - 1), string_.spins(k));
      found_.distance.push_back(at);
      found_.energy.push_back(string_.energy(k));
    }
    std::vector<bool> is_taken(string_.size());  // several saddles may have equal energies
    for (auto& known : found_.saddles)
      for (std::size_t k = 0; k < string_.size(); ++k)
        if (!is_taken[k] && string_.is_fixed(k) && known.energy == string_.energy(k)) {
          known.image = k;
          is_taken[k] = true;
          break;
        }
    if (!found_.saddles.empty())
      Kokkos::deep_copy(exec_, saddle.allocation(), highest_.allocation());
    exec_.fence("cayspin::minimum_energy_path");
    return found_;
  }

  Exec const& exec_;
  Field const& field_;
  PathOptions const& options_;
  PathString<Spins> string_;
  SaddleSearch<Spins> saddle_;
  ProbedField<Spins> probed_;
  Spins highest_, peak_;
  bool stopped_ = false, is_settled_ = false;
  double round_off_ = 0;  // of energies
  MinimumEnergyPath found_;
};

}  // namespace detail

/// Returns how many fields of three numbers per site minimum_energy_path allocates in addition to
/// the images.
constexpr int path_work_fields(std::size_t images) {
  return 48 + detail::PathString<SpinField<double>>::fields_per_image * static_cast<int>(images);
}

/// Finds a minimum energy path between two states, and the saddles on it.
///
/// `minimize` relaxes the first and the last image; the images between them become the path. By
/// default, the search starts from a path on which each spin follows the great circle between its
/// two end directions (through x or y if they are opposite), with an asymmetric perturbation of up
/// to 0.1 rad. Preconditioned L-BFGS relaxes the images perpendicular to the path. From the energy
/// maxima along the path, Newton's method climbs to saddles until the torque is below
/// options.torque; then the images between the saddles are relaxed. `saddle` receives the highest
/// saddle, if one is found.
///   std::vector<Spins> images = ...;  // the first and the last are the states
///   Spins saddle("saddle", lattice);
///   auto const path = cayspin::minimum_energy_path(exec, field, images, saddle);
///   if (path.end == cayspin::PathEnd::converged) report(path.barrier_forward());
/// Waits. Throws std::invalid_argument for fewer than three images, images on different lattices or
/// in the same memory, as copies of one field are, parts of a lattice, replicas and invalid
/// options, and FieldNotFinite as minimize does.
template <class Exec, class Field, class Spins>
MinimumEnergyPath minimum_energy_path(Exec const& exec, Field const& field,
                                      std::vector<Spins>& images, Spins& saddle,
                                      PathOptions const& options = {}) {
  Kokkos::Profiling::ScopedRegion const region("cayspin::minimum_energy_path");
  detail::require_images("cayspin::minimum_energy_path", images, saddle);
  MinimumEnergyPath unfinished;
  std::array<Minimum, 2> ends;
  for (std::size_t i = 0; i < 2; ++i) {
    auto& end = i == 0 ? images.front() : images.back();
    ends[i] = detail::relax_end(exec, field, end, options, unfinished);
    if (ends[i].end != MinimizeEnd::converged) return unfinished;
  }
  detail::ProbedField<Spins> const probed(exec, field, images.front(), options.time,
                                          options.preconditioned);
  return detail::PathFinder(exec, field, images, options, probed,
                            unfinished.evaluations + probed.evaluations)
      .find(saddle, ends[0].energy, ends[1].energy);
}

}  // namespace cayspin::inline v0_2
