// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The module _cayspin: scenes and runs, wrapped by the package python/cayspin.
#include "arrays.hpp"
#include "cayspin_git_commit.hpp"
#include "ensemble.hpp"
#include "io/relax.hpp"
#include "path.hpp"
#include "shared.hpp"
#include "simulation/failure.hpp"
#include "simulation/guard.hpp"
#include "simulation/run_recorder.hpp"
#include "values_of_sites.hpp"

#include <cayspin/version.hpp>

#include <fmt/format.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/variant.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <variant>

namespace cayspin::python {

simulation::Precision precision_of(std::string const& name) {
  using simulation::Precision;
  for (auto const known : {Precision::double_precision, Precision::single_precision})
    if (to_string(known) == name) return known;
  throw simulation::UsageError("precision \"" + name + "\"; accepted: \"double\", \"single\"");
}

bool interrupted() {
  nb::gil_scoped_acquire const gil;
  return PyErr_CheckSignals() != 0;
}

void rethrow_interruption() {
  if (PyErr_Occurred()) throw nb::python_error();
}

namespace {

using namespace simulation;
using namespace nb::literals;

using Overrides = std::vector<std::string>;

bool advance(SceneRun& run, std::int64_t count, std::int64_t period, bool until_torque,
             std::int64_t run_end) {
  Advanced ended;
  {
    nb::gil_scoped_release const released;
    ended = run.advance(count, {.period = period,
                                .until_torque = until_torque,
                                .interrupted = interrupted,
                                .run_end = run_end});
  }
  rethrow_interruption();
  return ended == Advanced::at_rest;
}

Minimum relax(SceneRun& run, double torque, std::int64_t evaluations,
              std::optional<std::array<double, 3>> const& applied, bool keep_saddles) {
  Minimum found;
  {
    nb::gil_scoped_release const released;
    found = run.relax({torque, evaluations, applied, keep_saddles, interrupted});
  }
  rethrow_interruption();
  return found;
}

Next poll() { return interrupted() ? Next::stop : Next::proceed; }

ModesOptions modes_options(std::int64_t count, double tolerance, std::int64_t evaluations) {
  return {.count = static_cast<std::size_t>(std::max<std::int64_t>(count, 0)),
          .tolerance = tolerance,
          .evaluations = evaluations,
          .poll = poll};
}

// Returns frequencies, decays, errors, shapes, whether all modes have converged, and evaluations.
nb::tuple modes(SceneRun& run, std::int64_t count, double tolerance, std::int64_t evaluations) {
  FoundModes found;
  {
    nb::gil_scoped_release const released;
    found = run.modes(modes_options(count, tolerance, evaluations));
  }
  rethrow_interruption();
  auto const& [nx, ny, nz] = run.scene().lattice.shape;
  nb::list shapes;
  for (auto& shape : found.shapes) shapes.append(array_of(std::move(shape), {nz, ny, 6 * nx}));
  return nb::make_tuple(found.frequencies, found.decays, found.errors, shapes,
                        found.end == ModesEnd::converged, found.evaluations);
}

// Returns curvatures, their errors, those of the vectors, the vectors, whether all have converged,
// and evaluations.
nb::tuple curvatures(SceneRun& run, std::int64_t count, double tolerance,
                     std::int64_t evaluations) {
  FoundCurvatures found;
  {
    nb::gil_scoped_release const released;
    found = run.curvatures(modes_options(count, tolerance, evaluations));
  }
  rethrow_interruption();
  auto const& [nx, ny, nz] = run.scene().lattice.shape;
  nb::list vectors;
  for (auto& vector : found.vectors) vectors.append(array_of(std::move(vector), {nz, ny, 3 * nx}));
  return nb::make_tuple(found.values, found.value_errors, found.errors, vectors,
                        found.end == ModesEnd::converged, found.evaluations);
}

// Returns the frequencies and decays of each wave vector, and evaluations.
nb::tuple bands(SceneRun& run, std::vector<std::array<double, 3>> const& wave_vectors) {
  FoundBands found;
  {
    nb::gil_scoped_release const released;
    found = run.bands(wave_vectors, poll);
  }
  rethrow_interruption();
  return nb::make_tuple(found.frequencies, found.decays, found.evaluations);
}

// Returns the scene. Refuses a list of applied fields, which needs a search for each of them.
io::Scene with_one_field(io::Scene scene) {
  if (!scene.field.applied_in_turn.empty())
    throw io::scene_error(scene, "field.applied",
                          "a list of fields is for cayspin relax; accepted: three numbers or "
                          "expressions in t, and Simulation.relax(applied=...) for each of a list");
  return scene;
}

template <auto Member>
auto without_gil(SceneRun& run) {
  nb::gil_scoped_release const released;
  return (run.*Member)();
}

void define_scene(nb::module_& module) {
  nb::class_<io::Scene>(module, "Scene")
      .def_static(
          "read",
          [](std::filesystem::path const& path, Overrides const& overrides,
             std::optional<NumbersIn> const& spins, ArraysIn const& numbers) {
            auto const arrays = given(spins, numbers);
            nb::gil_scoped_release const released;
            return with_one_field(io::read_scene_to_run_or_relax(path, overrides, arrays));
          },
          "path"_a, "overrides"_a, "spins"_a.none(), "numbers"_a)
      .def_static(
          "parse",
          [](std::string const& text, std::filesystem::path const& name, Overrides const& overrides,
             std::optional<NumbersIn> const& spins, ArraysIn const& numbers) {
            auto const arrays = given(spins, numbers);
            nb::gil_scoped_release const released;
            return with_one_field(io::parse_scene_to_run_or_relax(text, name, overrides, arrays));
          },
          "text"_a, "name"_a, "overrides"_a, "spins"_a.none(), "numbers"_a)
      .def("with_overrides",
           [](io::Scene const& scene, Overrides const& overrides) {
             return io::with_overrides(scene, overrides);
           })
      .def(
          "set_own_field",
          [](io::Scene& scene, nb::object uniform, nb::object nonlocal) {
            auto const note = [&](char const* key, nb::object const& function) {
              if (!function.is_none())
                scene.text += fmt::format("# field.{}: a function of the program\n", key);
            };
            note("applied", uniform);
            note("nonlocal", nonlocal);
            scene.field.own = own_field(std::move(uniform), std::move(nonlocal));
            io::check_combination(scene);
          },
          "uniform"_a.none(), "nonlocal_"_a.none())
      .def("at_sites", at_sites)
      .def("moments_over_g", moments_over_g)
      .def_prop_ro("given_start",
                   [](io::Scene const& scene) {
                     return std::holds_alternative<io::GivenStart>(scene.initial);
                   })
      .def_ro("text", &io::Scene::text)
      .def_ro("path", &io::Scene::path)
      .def_prop_ro("shape",
                   [](io::Scene const& scene) {
                     auto const& [nx, ny, nz] = scene.lattice.shape;
                     return nb::make_tuple(nz, ny, nx);
                   })
      .def_prop_ro("cell_sites",
                   [](io::Scene const& scene) { return std::ssize(scene.lattice.basis); })
      .def_prop_ro("cell",
                   [](io::Scene const& scene) {
                     auto cell = scene.lattice.cell;
                     for (auto& vector : cell)
                       for (std::size_t c = 0; c < 3; ++c)
                         vector[c] *= scene.lattice.spacing[c] * scene.units.length;
                     return cell;
                   })
      .def_prop_ro("basis", [](io::Scene const& scene) { return scene.lattice.basis; })
      .def_prop_ro("units",
                   [](io::Scene const& scene) {
                     auto const& units = scene.units;
                     return nb::make_tuple(units.si, units.time, units.energy);
                   })
      .def_prop_ro("has_integrator", io::has_integrator)
      .def_prop_ro("has_torque", [](io::Scene const& scene) { return io::has_torque(scene.field); })
      .def_prop_ro(
          "method",
          [](io::Scene const& scene) { return std::string(scene.integrator.method->word); })
      .def_prop_ro("dt",
                   [](io::Scene const& scene) { return scene.integrator.dt * scene.units.time; })
      .def_prop_ro("steps", [](io::Scene const& scene) { return scene.integrator.steps; })
      .def_prop_ro("output", [](io::Scene const& scene) { return scene.output.file; })
      .def_prop_ro("guard_period",
                   [](io::Scene const& scene) { return Guard::period_of(io::sites(scene)); });
}

// Calls work() and turns std::runtime_error into UsageError. Releases the GIL, because work() may
// wait for another run or for HDF5 while the thread that uses them needs the GIL.
template <class Work>
auto as_error(Work const& work) {
  try {
    nb::gil_scoped_release const released;
    return work();
  } catch (UsageError const&) {
    throw;
  } catch (NumbersFailed const&) {
    throw;
  } catch (io::SceneError const&) {
    throw;
  } catch (std::runtime_error const& error) {
    throw UsageError(error.what());
  }
}

void define_run(nb::module_& module) {
  nb::class_<SceneRun>(module, "Run", nb::is_weak_referenceable())
      .def(nb::new_([](io::Scene const& scene, std::string const& precision,
                       std::optional<std::string> const& space, std::optional<int> threads,
                       std::optional<std::filesystem::path> const& restart) {
             RunSettings const settings{precision_of(precision), space, threads, restart};
             if (restart) return shared(as_error([&] { return SceneRun::open(scene, settings); }));
             nb::gil_scoped_release const released;
             return shared(SceneRun::open(scene, settings));
           }),
           "scene"_a, "precision"_a, "space"_a.none(), "threads"_a.none(), "restart"_a.none())
      .def("save",
           [](SceneRun& run, std::filesystem::path const& checkpoint) {
             as_error([&] { run.save(checkpoint); });
           })
      .def("require_reachable",
           [](SceneRun const& run, std::int64_t count) { run.require_reachable(count); })
      .def("change",
           [](SceneRun& run, Overrides const& overrides, ArraysIn const& numbers) {
             auto const arrays = given(std::nullopt, numbers);
             nb::gil_scoped_release const released;
             run.change(overrides, arrays);
           })
      .def_prop_ro("scene", &SceneRun::typed_scene)
      .def_prop_ro("last_step", &SceneRun::last_step)
      .def("advance", advance, "count"_a, "period"_a, "until_torque"_a, "run_end"_a)
      .def("relax", relax, "torque"_a, "evaluations"_a, "applied"_a.none(), "keep_saddles"_a)
      .def("modes", modes, "count"_a, "tolerance"_a, "evaluations"_a)
      .def("curvatures", curvatures, "count"_a, "tolerance"_a, "evaluations"_a)
      .def("bands", bands, "wave_vectors"_a)
      .def("path", path, "start"_a, "end"_a.none(), "images"_a, "torque"_a, "evaluations"_a,
           "rates"_a, "modes"_a.none())
      .def("warning", &SceneRun::warning)
      .def("restart_warning", &SceneRun::restart_warning)
      .def("step_at", &SceneRun::step_at)
      .def("spins", [](SceneRun& run) { return array_of(without_gil<&SceneRun::spins>(run)); })
      .def("set_spins",
           [](SceneRun& run, NumbersIn const& spins) {
             auto const vectors = vectors_of(spins);
             nb::gil_scoped_release const released;
             run.set_spins(vectors);
           })
      .def("field", [](SceneRun& run) { return array_of(without_gil<&SceneRun::field>(run)); })
      .def("energies",
           [](SceneRun& run) {
             nb::dict all;
             for (auto const& [name, value] : without_gil<&SceneRun::energies>(run))
               all[name.c_str()] = value;
             return all;
           })
      .def("sample",
           [](SceneRun& run) {
             auto const now = without_gil<&SceneRun::sample>(run);
             auto const& m = now.magnetization;
             return nb::make_tuple(now.energy.value, now.norm_defect,
                                   nb::make_tuple(m.x, m.y, m.z));
           })
      .def_prop_ro("steps", &SceneRun::steps)
      .def_prop_ro("time", &SceneRun::time)
      .def_prop_ro("evaluations", &SceneRun::evaluations)
      .def_prop_ro("step_seconds", &SceneRun::step_seconds)
      .def_prop_ro("space", &SceneRun::space)
      .def_prop_ro("threads", &SceneRun::threads)
      .def_prop_ro("precision",
                   [](SceneRun const& run) { return std::string(to_string(run.precision())); });
}

void define_minimum(nb::module_& module) {
  nb::class_<Minimum>(module, "Minimum")
      .def_prop_ro("end", [](Minimum const& found) { return std::string(to_string(found.end)); })
      .def_ro("torque", &Minimum::torque)
      .def_prop_ro("energy", [](Minimum const& found) { return found.energy.value; })
      .def_ro("iterations", &Minimum::iterations)
      .def_ro("evaluations", &Minimum::evaluations)
      .def_ro("saddles", &Minimum::saddles)
      .def_ro("curvature", &Minimum::curvature);
}

void define_recorder(nb::module_& module) {
  nb::class_<RunRecorder>(module, "Recorder")
      .def(nb::new_([](SceneRun& run, std::int64_t end, std::filesystem::path const& path,
                       bool overwrite) {
             return as_error([&] {
               return std::make_unique<RunRecorder>(run, end, path, overwrite, CAYSPIN_GIT_COMMIT);
             });
           }),
           "run"_a, "end"_a, "path"_a, "overwrite"_a, nb::keep_alive<0, 1>())
      .def_prop_ro("next", &RunRecorder::next)
      .def("look", [](RunRecorder& recorder, bool last) { as_error([&] { recorder.look(last); }); })
      .def("finish",
           [](RunRecorder& one, bool planned) { as_error([&] { one.finish(planned); }); });
}

// Removes "Scene:12: " from a message: scenes given as tables have no lines.
std::string without_line_of_tables(std::string_view line) {
  constexpr std::string_view name = "Scene:";
  if (!line.starts_with(name)) return std::string(line);
  auto const end = line.find_first_not_of("0123456789", name.size());
  if (end == name.size() || end == line.npos || !line.substr(end).starts_with(": "))
    return std::string(line);
  return std::string(line.substr(end + 2));
}

void define_scene_error(nb::module_& module, nb::handle base) {
  nb::exception<io::SceneError> const error(module, "SceneError", base);
  nb::register_exception_translator(
      [](std::exception_ptr const& thrown, void* type) {
        try {
          std::rethrow_exception(thrown);
        } catch (io::SceneError const& scene) {
          PyErr_SetString(static_cast<PyObject*>(type),
                          without_line_of_tables(scene.what()).c_str());
        }
      },
      error.ptr());
}

}  // namespace
}  // namespace cayspin::python

NB_MODULE(_cayspin, module) {
  using namespace cayspin;
  namespace nb = nanobind;
  nb::set_leak_warnings(false);  // a field that refers to its own simulation counts as a leak
  nb::exception<simulation::UsageError> const base(module, "CayspinError");
  python::define_scene_error(module, base);
  nb::exception<simulation::NumbersFailed>(module, "NumbersFailed", base);
  module.attr("version") = CAYSPIN_VERSION_STRING;
  module.attr("git_commit") = CAYSPIN_GIT_COMMIT;
  python::define_scene(module);
  python::define_minimum(module);
  python::define_run(module);
  python::define_recorder(module);
  python::define_ensemble(module);
  module.def("complete_file", [](std::filesystem::path const& path) {
    python::as_error([&] { io::complete_file(path); });
  });
}
