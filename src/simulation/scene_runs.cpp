// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Several runs together: their steps, searches for equilibria and samples.
#include "scene_run.hpp"
#include "side_by_side.hpp"
#include "turn.hpp"

#include <algorithm>
#include <atomic>
#include <exception>

namespace cayspin::simulation {

std::vector<SceneRun::Outcome> SceneRun::advance_all(std::span<SceneRun* const> runs,
                                                     std::int64_t count, Looks const& looks) {
  Turn const turn;
  std::vector<Outcome> outcomes(runs.size());
  std::atomic<bool> interrupted = false;
  side_by_side(runs, [&](std::size_t number) {
    auto& [advanced, error] = outcomes[number];
    auto& run = *runs[number];
    interrupted = interrupted || (looks.interrupted && looks.interrupted());
    if (interrupted) {
      advanced = Advanced::interrupted;
      return;
    }
    try {
      run.require_reachable(count);
      advanced = run.advance_to(run.number_ + count, looks);
    } catch (...) {
      error = std::current_exception();
    }
    interrupted = interrupted || advanced == Advanced::interrupted;
  });
  return outcomes;
}

std::vector<SceneRun::Relaxed> SceneRun::relax_all(std::span<SceneRun* const> runs,
                                                   RelaxSettings const& settings) {
  Turn const turn;
  std::vector<Relaxed> all(runs.size());
  std::atomic<bool> interrupted = false;
  side_by_side(runs, [&](std::size_t number) {
    auto& [minimum, error] = all[number];
    interrupted = interrupted || (settings.interrupted && settings.interrupted());
    if (interrupted) {
      minimum.end = MinimizeEnd::interrupted;
      return;
    }
    try {
      minimum = runs[number]->relaxed(settings);
    } catch (...) {
      error = std::current_exception();
    }
    interrupted = interrupted || minimum.end == MinimizeEnd::interrupted;
  });
  return all;
}

void SceneRun::side_by_side(std::span<SceneRun* const> runs,
                            std::function<void(std::size_t)> const& work) {
  std::int64_t sites = 0;
  for (auto const* const run : runs) sites = std::max(sites, run->plan().lattice.sites());
  if (!runs.empty()) for_each_small_run(runs.front()->space_, sites, runs.size(), work);
}

std::vector<std::vector<Sample>> SceneRun::sample_columns(std::span<ColumnsToSample const> all) {
  Turn const turn;
  std::vector<std::vector<Sample>> samples(all.size());
  std::vector<SceneRun*> ones;
  for (auto const& columns : all) ones.push_back(columns.one);
  side_by_side(ones, [&](std::size_t number) {
    auto const& [columns, one, count] = all[number];
    for (std::int64_t column = 0; column < count; ++column) {
      one->take_column(*columns, column);
      samples[number].push_back(one->sampled());
    }
  });
  return samples;
}

}  // namespace cayspin::simulation
