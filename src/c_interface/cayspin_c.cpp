// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "calls.hpp"
#include "cayspin_git_commit.hpp"
#include "io/relax.hpp"
#include "simulation/guard.hpp"
#include "simulation/run_recorder.hpp"

#include <cayspin/cayspin.h>
#include <cayspin/version.hpp>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <system_error>

using namespace cayspin::simulation;
using namespace cayspin::c_interface;
namespace io = cayspin::io;

struct cayspin_simulation {
  std::mutex turn;  // serialises all calls but cayspin_time, cayspin_steps, cayspin_close
  std::unique_ptr<SceneRun> run;
  std::optional<LentVectors> borrowed, borrowed_field;
};

namespace {

/// `opens_ensembles`: the function to name if the scene has [ensemble].
cayspin_simulation* opened(io::Scene const& scene, cayspin_precision precision, char const* space,
                           std::string const& opens_ensembles) {
  if (scene.ensemble.there())
    throw io::scene_error(
        scene, "ensemble",
        "a simulation has no replicas; accepted: no such table, or " + opens_ensembles);
  if (!scene.field.applied_in_turn.empty())
    throw io::scene_error(scene, "field.applied",
                          "a list of fields is for cayspin relax; accepted: three numbers or "
                          "expressions in t, and cayspin_relax for each of a list");
  auto simulation = std::make_unique<cayspin_simulation>();
  simulation->run = SceneRun::open(scene, settings_of(precision, space));
  return simulation.release();
}

SceneRun& run_of(cayspin_simulation const* simulation) {
  return *required(simulation, "simulation").run;
}

/// Calls work(run) while no other thread is in a call that `turn` serialises.
template <class Work>
cayspin_status in_turn(cayspin_simulation* simulation, Work const& work) {
  return guarded([&] {
    auto& run = run_of(simulation);
    std::lock_guard const turn(simulation->turn);
    work(run);
  });
}

/// Calls work(run) after taking back borrowed spins.
template <class Work>
cayspin_status changing(cayspin_simulation* simulation, Work const& work) {
  return in_turn(simulation, [&](SceneRun& run) {
    simulation->borrowed.reset();
    work(run);
  });
}

cayspin_array array_of(io::HostVectors const& vectors) {
  auto const& [nz, ny, nx] = vectors.shape;
  cayspin_array array{
      vectors.data, vectors.is_double ? CAYSPIN_DOUBLE : CAYSPIN_SINGLE, {nz, ny, nx, 3}, {}};
  std::ranges::copy(vectors.strides, array.strides);
  return array;
}

/// Throws for a dt that is too large if the scene sets refuse_unstable.
void require_stable(SceneRun const& run) {
  if (run.scene().integrator.refuse_unstable) run.warning();
}

/// Throws UsageError for an output file that the scene reads.
void require_not_read(io::Scene const& scene, std::filesystem::path const& output) {
  auto read = scene.files;
  read.push_back(scene.path);
  std::error_code ignored;
  for (auto const& file : read)
    if (std::filesystem::equivalent(file, output, ignored))
      throw UsageError(file.string() +
                       ": the scene reads it, and the run would replace it; accepted: another "
                       "output");
}

void run_to_end(SceneRun& run, RunRecorder& recorder) {
  Looks const looks{.period = Guard::period_of(io::sites(run.scene())), .until_torque = true};
  recorder.look();
  while (recorder.next() > run.steps()) {
    bool const at_rest = run.advance(recorder.next() - run.steps(), looks) == Advanced::at_rest;
    recorder.look(at_rest);
    if (at_rest) return;
  }
}

void run_with_file(SceneRun& run, std::filesystem::path const& path, bool overwrite) {
  RunRecorder recorder(run, run.last_step(), path, overwrite, CAYSPIN_GIT_COMMIT);
  try {
    run_to_end(run, recorder);
  } catch (...) {
    try {
      recorder.finish(false);
    } catch (...) {  // the first exception says why the run ended
    }
    throw;
  }
  recorder.finish();
}

}  // namespace

char const* cayspin_last_error(void) { return last_error().c_str(); }

char const* cayspin_version(void) { return CAYSPIN_VERSION_STRING; }

cayspin_status cayspin_open_file(char const* path, cayspin_precision precision, char const* space,
                                 cayspin_simulation** simulation) {
  return guarded([&] {
    auto& result = required(simulation, "simulation");
    result = opened(io::read_scene_to_run_or_relax(&required(path, "path")), precision, space,
                    "cayspin_ensemble_open_file");
  });
}

cayspin_status cayspin_open_text(char const* text, char const* name, cayspin_precision precision,
                                 char const* space, cayspin_simulation** simulation) {
  return guarded([&] {
    auto& result = required(simulation, "simulation");
    auto const scene =
        io::parse_scene_to_run_or_relax(&required(text, "text"), name != nullptr ? name : "scene");
    result = opened(scene, precision, space, "cayspin_ensemble_open_text");
  });
}

cayspin_status cayspin_step(cayspin_simulation* simulation, int64_t count) {
  return changing(simulation, [&](SceneRun& run) {
    run.require_reachable(count);
    require_stable(run);
    run.advance(count);
  });
}

cayspin_status cayspin_run(cayspin_simulation* simulation, char const* output, int overwrite) {
  return changing(simulation, [&](SceneRun& run) {
    if (!io::has_integrator(run.scene()))
      throw UsageError("the scene has no table [integrator]; accepted: cayspin_relax");
    auto const& file = run.scene().output.file;
    if (output == nullptr && !file)
      throw UsageError("output is NULL and the scene has no output.file; accepted: either");
    if (run.steps() > run.last_step() || run.scene().integrator.steps == 0)
      throw UsageError("the simulation is at step " + std::to_string(run.steps()) +
                       " and the scene ends at step " + std::to_string(run.last_step()) +
                       "; accepted: a later end");
    auto const path = output != nullptr ? std::filesystem::path(output) : *file;
    require_not_read(run.scene(), path);
    require_stable(run);
    run_with_file(run, path, overwrite != 0);
  });
}

cayspin_status cayspin_relax(cayspin_simulation* simulation, double torque, int64_t evaluations,
                             double const* applied, cayspin_minimum* found) {
  return in_turn(simulation, [&](SceneRun& run) {
    required(found, "found");
    RelaxSettings settings;
    settings.torque = torque;
    settings.evaluations = evaluations;
    if (applied != nullptr) settings.applied = {applied[0], applied[1], applied[2]};
    simulation->borrowed.reset();
    auto const minimum = run.relax(settings);
    *found = {minimum.end == cayspin::MinimizeEnd::converged, minimum.torque, minimum.energy.value,
              minimum.evaluations};
  });
}

cayspin_status cayspin_time(cayspin_simulation const* simulation, double* time) {
  return guarded([&] {
    auto const& run = run_of(simulation);
    required(time, "time") = run.time();
  });
}

cayspin_status cayspin_steps(cayspin_simulation const* simulation, int64_t* steps) {
  return guarded([&] {
    auto const& run = run_of(simulation);
    required(steps, "steps") = run.steps();
  });
}

cayspin_status cayspin_borrow_spins(cayspin_simulation* simulation, cayspin_array* spins) {
  return in_turn(simulation, [&](SceneRun& run) {
    required(spins, "spins");
    // On a device, run.spins() makes a host copy. The copy lent before must stay valid when the
    // spins are borrowed again.
    if (!simulation->borrowed) simulation->borrowed.emplace(run.spins());
    *spins = array_of(simulation->borrowed->vectors);
  });
}

cayspin_status cayspin_borrow_field(cayspin_simulation* simulation, cayspin_array* field) {
  return in_turn(simulation, [&](SceneRun& run) {
    required(field, "field");
    *field = array_of(simulation->borrowed_field.emplace(run.field()).vectors);
  });
}

cayspin_status cayspin_set_spins(cayspin_simulation* simulation, cayspin_array const* spins) {
  return in_turn(simulation, [&](SceneRun& run) {
    required(spins, "spins");
    required(static_cast<char const*>(spins->data), "spins->data");
    if (spins->shape[3] != 3)
      throw UsageError("spins of " + std::to_string(spins->shape[3]) +
                       " components; accepted: shape[3] = 3");
    io::HostVectors vectors;
    vectors.data = const_cast<void*>(spins->data);  // only read
    vectors.is_double = precision_of(spins->precision) == Precision::double_precision;
    vectors.shape = {spins->shape[0], spins->shape[1], spins->shape[2]};
    std::ranges::copy(spins->strides, vectors.strides.begin());
    // `spins` may be the borrowed spins, so these are kept until `spins` has been read.
    run.set_spins(vectors);
    simulation->borrowed.reset();
  });
}

cayspin_status cayspin_energy(cayspin_simulation* simulation, double* energy) {
  return in_turn(simulation, [&](SceneRun& run) {
    required(energy, "energy");
    *energy = run.sample().energy.value;
  });
}

cayspin_status cayspin_magnetization(cayspin_simulation* simulation, double magnetization[3]) {
  return in_turn(simulation, [&](SceneRun& run) {
    required(magnetization, "magnetization");
    auto const m = run.sample().magnetization;
    magnetization[0] = m.x;
    magnetization[1] = m.y;
    magnetization[2] = m.z;
  });
}

cayspin_status cayspin_close(cayspin_simulation* simulation) {
  return guarded([&] { delete simulation; });
}
