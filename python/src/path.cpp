// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "path.hpp"

#include "cayspin_git_commit.hpp"
#include "shared.hpp"
#include "simulation/failure.hpp"
#include "simulation/path_of_run.hpp"

#include <nanobind/stl/array.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <utility>

namespace cayspin::python {

using namespace simulation;

namespace {

EndOfPath end_of_path(char const* name, StateIn const& state) {
  if (auto const* const file = std::get_if<std::filesystem::path>(&state)) return {name, *file};
  return {name, vectors_of(std::get<NumbersIn>(state))};
}

nb::dict as_dict(io::Path path, std::array<std::int64_t, 3> const& shape) {
  auto const& [nx, ny, nz] = shape;
  auto const images = static_cast<std::int64_t>(path.energy.size());
  nb::dict all;
  all["end"] = path.end;
  all["converged"] = path.converged;
  all["evaluations"] = path.evaluations;
  all["energy"] = path.energy;
  all["distance"] = path.distance;
  all["spins"] = array_of(std::move(path.spins), {images * nz, ny, 3 * nx});
  nb::list saddles;
  for (auto const& one : path.saddles)
    saddles.append(nb::make_tuple(one.energy, one.curvature, one.next_curvature, one.image));
  all["saddles"] = saddles;
  all["saddle"] = array_of(std::move(path.saddle), {nz, ny, 3 * nx});
  if (auto const& rates = path.rates)
    all["rates"] = nb::make_tuple(rates->prefactor_forward, rates->prefactor_backward,
                                  rates->langer_forward, rates->langer_backward, rates->zero_modes);
  return all;
}

}  // namespace

nb::dict path(SceneRun const& run, StateIn const& start, std::optional<StateIn> const& end,
              std::int64_t images, double torque, std::int64_t evaluations, bool rates,
              std::optional<std::int64_t> const& modes) {
  auto const from = end_of_path("start", start);
  std::optional<EndOfPath> to;
  if (end) to = end_of_path("end", *end);
  std::optional<ScenePath> found;
  {
    nb::gil_scoped_release const released;
    ScenePathOptions const options{.images = images,
                                   .torque = torque,
                                   .evaluations = evaluations,
                                   .rates = rates,
                                   .modes = modes};
    found = path_of_run(run, from, to, options, interrupted, CAYSPIN_GIT_COMMIT);
  }
  rethrow_interruption();
  if (!found->rates_failed.empty()) throw NumbersFailed(found->rates_failed);
  return as_dict(std::move(found->path), run.scene().lattice.shape);
}

}  // namespace cayspin::python
