// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Several runs together: their steps, searches for equilibria and samples.
#include "failure.hpp"
#include "scene_run.hpp"
#include "side_by_side.hpp"
#include "turn.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <functional>

namespace cayspin::simulation {
namespace {

// Returns a function that returns true if any of several runs was interrupted, or if asked() has
// returned true.
std::function<bool()> or_asked(std::atomic<bool>& interrupted, std::function<bool()> const& asked) {
  return [&] {
    if (!interrupted && asked && asked()) interrupted = true;
    return interrupted.load();
  };
}

}  // namespace

std::vector<SceneRun::Outcome> SceneRun::advance_all(std::span<SceneRun* const> runs,
                                                     std::int64_t target, Looks const& looks,
                                                     SideBySide side) {
  Turn const turn;
  std::vector<Outcome> outcomes(runs.size());
  std::atomic<bool> interrupted = false;
  auto asking = looks;
  asking.interrupted = or_asked(interrupted, looks.interrupted);
  for_each_run(runs, side, [&](std::size_t number) {
    auto& [advanced, error] = outcomes[number];
    auto& run = *runs[number];
    if (asking.interrupted()) {
      advanced = Advanced::interrupted;
      return;
    }
    if (run.number_ >= target) return;
    try {
      run.require_reachable(target - run.number_);
      advanced = run.advance_to(target, asking);
    } catch (NumbersFailed const&) {
      error = std::current_exception();
    } catch (...) {
      error = std::current_exception();
      interrupted = true;  // an error of the calling program: the other runs stop, too
    }
    if (advanced == Advanced::interrupted) interrupted = true;
  });
  return outcomes;
}

std::vector<SceneRun::Relaxed> SceneRun::relax_all(std::span<SceneRun* const> runs,
                                                   RelaxSettings const& settings) {
  Turn const turn;
  std::vector<Relaxed> all(runs.size());
  std::atomic<bool> interrupted = false;
  auto asking = settings;
  asking.interrupted = or_asked(interrupted, settings.interrupted);
  // With these terms a search frees memory. Kokkos then waits for all kernels, and would wait for
  // ever for the kernel in which the runs are side by side.
  bool const frees_memory = std::ranges::any_of(runs, [](SceneRun const* run) {
    return io::needs_pass(run->scene_) || io::is_nonlocal(run->scene_.field);
  });
  auto const relax_one = [&](std::size_t number) {
    auto& [minimum, error] = all[number];
    if (asking.interrupted()) {
      minimum.end = MinimizeEnd::interrupted;
      return;
    }
    try {
      minimum = runs[number]->relaxed(asking);
    } catch (NumbersFailed const&) {
      error = std::current_exception();
    } catch (...) {
      error = std::current_exception();
      interrupted = true;
    }
    if (minimum.end == MinimizeEnd::interrupted) interrupted = true;
  };
  if (!frees_memory) {
    for_each_run(runs, SideBySide::small, relax_one);
    return all;
  }
  for (std::size_t number = 0; number < runs.size(); ++number) {
    Turn::Work const of_the_turn;
    relax_one(number);
  }
  return all;
}

void SceneRun::for_each_run(std::span<SceneRun* const> runs, SideBySide side,
                            std::function<void(std::size_t)> const& work) {
  std::int64_t sites = 0;
  for (auto const* const run : runs) sites = std::max(sites, run->plan().lattice.sites());
  if (runs.empty()) return;
  simulation::for_each_run(runs.front()->space_, sites, side == SideBySide::all, runs.size(),
                           [&](std::size_t number) {
                             Turn::Work const of_the_turn;
                             work(number);
                           });
}

std::vector<std::vector<Sample>> SceneRun::sample_columns(std::span<ColumnsToSample const> all) {
  Turn const turn;
  std::vector<std::vector<Sample>> samples(all.size());
  std::vector<SceneRun*> ones;
  for (auto const& columns : all) ones.push_back(columns.one);
  for_each_run(ones, SideBySide::small, [&](std::size_t number) {
    auto const& [columns, one, first, count, values] = all[number];
    bool const differ = !values->applied.empty() || !values->constants.empty();
    for (std::int64_t column = 0; column < count; ++column) {
      if (differ) one->sample_in(*values, static_cast<std::size_t>(first + column));
      one->take_column(*columns, column);
      samples[number].push_back(one->sampled());
    }
  });
  return samples;
}

}  // namespace cayspin::simulation
