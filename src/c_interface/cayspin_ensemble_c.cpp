// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "calls.hpp"
#include "io/relax.hpp"
#include "simulation/ensemble_run.hpp"

#include <cayspin/cayspin.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

using namespace cayspin::simulation;
using namespace cayspin::c_interface;
namespace io = cayspin::io;

struct cayspin_ensemble {
  cayspin_ensemble(io::Scene const& scene, RunSettings const& settings)
      : run(scene, settings, !io::has_integrator(scene)) {}

  std::mutex turn;  // serialises all calls that change an ensemble or read its spins
  EnsembleRun run;
  bool is_dt_accepted = false;
  std::optional<std::vector<std::byte>> borrowed;  // the spins of all replicas
};

namespace {

/// `opens_others`: the function to name if the scene has no [ensemble].
cayspin_ensemble* opened(io::Scene const& scene, cayspin_precision precision, char const* space,
                         std::string const& opens_others) {
  if (!scene.ensemble.there())
    throw io::scene_error(scene, "ensemble",
                          "is missing; accepted: a scene with [ensemble], or " + opens_others);
  return new cayspin_ensemble(scene, settings_of(precision, space));
}

EnsembleRun const& run_of(cayspin_ensemble const* ensemble) {
  return required(ensemble, "ensemble").run;
}

/// Calls work(ensemble) while no other thread is in a call that `turn` serialises.
template <class Work>
cayspin_status in_turn(cayspin_ensemble* pointer, Work const& work) {
  return guarded([&] {
    auto& ensemble = required(pointer, "ensemble");
    std::lock_guard const turn(ensemble.turn);
    work(ensemble);
  });
}

/// Throws for a dt that is too large in a replica if the scene sets refuse_unstable. The dt of an
/// ensemble does not change, and checking it in all replicas takes time: this is done once.
void require_stable(cayspin_ensemble& ensemble) {
  if (ensemble.is_dt_accepted) return;
  if (ensemble.run.first().scene().integrator.refuse_unstable) ensemble.run.warning();
  ensemble.is_dt_accepted = true;
}

}  // namespace

cayspin_status cayspin_ensemble_open_file(char const* path, cayspin_precision precision,
                                          char const* space, cayspin_ensemble** ensemble) {
  return guarded([&] {
    auto& result = required(ensemble, "ensemble");
    result = opened(io::read_scene_to_run_or_relax(&required(path, "path")), precision, space,
                    "cayspin_open_file");
  });
}

cayspin_status cayspin_ensemble_open_text(char const* text, char const* name,
                                          cayspin_precision precision, char const* space,
                                          cayspin_ensemble** ensemble) {
  return guarded([&] {
    auto& result = required(ensemble, "ensemble");
    auto const scene =
        io::parse_scene_to_run_or_relax(&required(text, "text"), name != nullptr ? name : "scene");
    result = opened(scene, precision, space, "cayspin_open_text");
  });
}

cayspin_status cayspin_ensemble_replicas(cayspin_ensemble const* ensemble, int64_t* replicas) {
  return guarded([&] {
    auto const& run = run_of(ensemble);
    required(replicas, "replicas") = static_cast<std::int64_t>(run.replicas());
  });
}

cayspin_status cayspin_ensemble_step(cayspin_ensemble* ensemble, int64_t count) {
  return in_turn(ensemble, [&](cayspin_ensemble& all) {
    all.borrowed.reset();
    all.run.require_reachable(count);
    require_stable(all);
    all.run.advance(count, all.run.looks(false, {}));
  });
}

cayspin_status cayspin_ensemble_relax(cayspin_ensemble* ensemble, double torque,
                                      int64_t evaluations, cayspin_minimum* found) {
  return in_turn(ensemble, [&](cayspin_ensemble& all) {
    required(found, "found");
    all.borrowed.reset();
    auto const minima = all.run.relax({.torque = torque, .evaluations = evaluations});
    std::ranges::transform(minima, found, [](cayspin::Minimum const& minimum) {
      return cayspin_minimum{minimum.end == cayspin::MinimizeEnd::converged, minimum.torque,
                             minimum.energy.value, minimum.evaluations};
    });
  });
}

cayspin_status cayspin_ensemble_time(cayspin_ensemble const* ensemble, double* time) {
  return guarded([&] {
    auto const& run = run_of(ensemble);
    required(time, "time") = run.time();
  });
}

cayspin_status cayspin_ensemble_steps(cayspin_ensemble const* ensemble, int64_t* steps) {
  return guarded([&] {
    auto const& run = run_of(ensemble);
    required(steps, "steps") = run.steps();
  });
}

cayspin_status cayspin_ensemble_borrow_spins(cayspin_ensemble* ensemble, int64_t replica,
                                             cayspin_array* spins) {
  return in_turn(ensemble, [&](cayspin_ensemble& all) {
    required(spins, "spins");
    auto const replicas = static_cast<std::int64_t>(all.run.replicas());
    if (replica < 0 || replica >= replicas)
      throw UsageError("replica " + std::to_string(replica) + "; accepted: 0 to " +
                       std::to_string(replicas - 1));
    if (!all.borrowed) all.borrowed = all.run.spins();
    auto const& one = all.run.first();
    auto const& [nx, ny, nz] = one.scene().lattice.shape;
    auto const bytes = all.borrowed->size() / all.run.replicas();
    bool const is_double = one.precision() == Precision::double_precision;
    *spins = {all.borrowed->data() + static_cast<std::size_t>(replica) * bytes,
              is_double ? CAYSPIN_DOUBLE : CAYSPIN_SINGLE,
              {nz, ny, nx, 3},
              {3 * nx * ny, 3 * nx, 3, 1}};
  });
}

cayspin_status cayspin_ensemble_energies(cayspin_ensemble* ensemble, double* energies) {
  return in_turn(ensemble, [&](cayspin_ensemble& all) {
    required(energies, "energies");
    std::ranges::transform(all.run.scalars(), energies, &io::Scalars::energy);
  });
}

cayspin_status cayspin_ensemble_magnetizations(cayspin_ensemble* ensemble, double* magnetizations) {
  return in_turn(ensemble, [&](cayspin_ensemble& all) {
    auto* to = &required(magnetizations, "magnetizations");
    for (auto const& scalars : all.run.scalars())
      to = std::ranges::copy(scalars.magnetization, to).out;
  });
}

cayspin_status cayspin_ensemble_close(cayspin_ensemble* ensemble) {
  return guarded([&] { delete ensemble; });
}
