// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "ranks.hpp"
#include "scene_field.hpp"
#include "scene_minimizer.hpp"

#include <cayspin/observer/record.hpp>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>

namespace cayspin::simulation {

/// Detects when a run with integrator.until_torque has reached a minimum of the energy. A small
/// torque is not enough, since it also vanishes at maxima and saddles, and spins leave these
/// slowly. So the torque must not have grown since the previous check, the energy must have fallen
/// (or the last change of the field must be over), and the search of `cayspin relax`, on a copy of
/// the spins, must find no descent direction. On several ranks there is no such search.
template <class Real, class Space>
class RestSearch {
  using Spins = SpinField<Real, typename Space::memory_space>;

 public:
  struct Found {
    bool at_minimum = false, at_saddle = false;
  };

  RestSearch(io::Scene const& scene, double bound) : scene_(scene), bound_(bound) {}

  /// Tells whether the spins are at a minimum or at a saddle. `torque`: max |m x H|. `fell`: the
  /// energy is below that of the first check or, if the field changes in time, the last change is
  /// over. `field`: made for FieldFor::energy. With `at_end`, reports a saddle even if no search is
  /// due.
  Found look(Space const& exec, Step const& step, Spins const& spins,
             SceneField<Spins> const& field, double torque, bool fell, bool at_end) {
    bool const grew = torque > last_torque_;
    last_torque_ = torque;
    if (!(torque < bound_)) {
      next_ = wait_ = 0;
      return {};
    }
    bool const may_be_at_rest = fell && !grew && step.number >= next_;
    if (!may_be_at_rest && !at_end) return {};
    bool const at_saddle = is_saddle(exec, step.time, spins, field);
    if (!may_be_at_rest || !at_saddle) return {may_be_at_rest && !at_saddle, at_saddle};
    // Spins may stay at a saddle for the rest of the run, so the intervals between searches grow.
    wait_ = std::max<std::int64_t>(1, 2 * wait_);
    next_ = step.number + wait_;
    return {.at_saddle = true};
  }

  /// Call it after the spins were replaced.
  void begin_again() {
    last_torque_ = std::numeric_limits<double>::infinity();
    next_ = wait_ = 0;
  }

  /// For cayspin::serialize.
  template <class Visit>
  void visit_memory(Visit const& visit) {
    visit("last_torque", last_torque_);
    visit("next", next_);
    visit("wait", wait_);
  }

 private:
  bool is_saddle(Space const& exec, double time, Spins const& spins,
                 SceneField<Spins> const& field) {
    // The search supports one rank only.
    if (spins.lattice().part != nullptr) return false;
    if (!minimizer_) {
      minimizer_.emplace(spins);
      moments_ = range_of_moments(io::all_moments(scene_, own_sites(spins.lattice())));
      trial_ = Spins("RestSearch::trial", spins.lattice());
    }
    // The search measures torques and curvatures of the energy, which are those of H times the
    // moments. With a bound on the torque that is too small it would only descend, because it looks
    // for a way off a saddle only below that bound. So the bound is that of the largest moment, and
    // is raised until the search looks. Curvatures are judged by the smallest moment, whatever the
    // bound on the torque.
    double bound = bound_ * moments_.largest;
    for (int attempt = 0; attempt < 30; ++attempt, bound *= 4) {
      Kokkos::deep_copy(exec, trial_.allocation(), spins.allocation());
      auto const found =
          minimizer_->minimize(exec, scene_, field, trial_,
                               {.torque = std::max(bound, Minimizer<Spins>::least_bound),
                                .time = time,
                                .least_curvature = bound_ * moments_.least,
                                .observer = [](Minimum const&) { return Next::stop; }});
      if (found.saddles > 0) return true;
      if (found.end != MinimizeEnd::interrupted) return false;
    }
    return false;
  }

  io::Scene scene_;
  double bound_;
  double last_torque_ = std::numeric_limits<double>::infinity();
  std::int64_t next_ = 0, wait_ = 0;  // earliest step of the next search; interval in steps
  std::optional<SceneMinimizer<Real, Space>> minimizer_;
  MomentRange moments_;
  Spins trial_;
};

}  // namespace cayspin::simulation
