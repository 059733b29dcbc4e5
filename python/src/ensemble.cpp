// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "ensemble.hpp"

#include "arrays.hpp"
#include "io/relax.hpp"
#include "shared.hpp"
#include "simulation/ensemble_run.hpp"
#include "simulation/failure.hpp"

#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace cayspin::python {
namespace {

using namespace simulation;
using namespace nb::literals;

// Tells all threads of an interruption once one thread has seen it. Python handles signals only in
// its main thread, but replicas run in other threads, too.
class Interruption {
 public:
  std::function<bool()> question() {
    return [this] {
      if (!asked_ && interrupted()) asked_ = true;
      return asked_.load();
    };
  }

 private:
  std::atomic<bool> asked_ = false;
};

bool advance(EnsembleRun& run, std::int64_t count, bool until_torque) {
  Interruption interruption;
  Advanced ended;
  {
    nb::gil_scoped_release const released;
    ended = run.advance(count, run.looks(until_torque, interruption.question()));
  }
  rethrow_interruption();
  return ended == Advanced::at_rest;
}

std::vector<Minimum> relax(EnsembleRun& run, double torque, std::int64_t evaluations,
                           bool keep_saddles) {
  Interruption interruption;
  std::vector<Minimum> found;
  {
    nb::gil_scoped_release const released;
    found = run.relax({.torque = torque,
                       .evaluations = evaluations,
                       .keep_saddles = keep_saddles,
                       .interrupted = interruption.question()});
  }
  rethrow_interruption();
  return found;
}

template <class Real>
NumbersOut array_of_bytes(std::vector<std::byte> const& bytes, std::array<std::size_t, 5> shape) {
  auto* const numbers = new std::vector<Real>(bytes.size() / sizeof(Real));
  std::memcpy(numbers->data(), bytes.data(), bytes.size());
  nb::capsule const owner(
      numbers, [](void* held) noexcept { delete static_cast<std::vector<Real>*>(held); });
  return NumbersOut(numbers->data(), shape.size(), shape.data(), owner, nullptr, nb::dtype<Real>());
}

NumbersOut spins(EnsembleRun& run) {
  auto const& [nx, ny, nz] = run.first().scene().lattice.shape;
  std::array const shape{run.replicas(), static_cast<std::size_t>(nz), static_cast<std::size_t>(ny),
                         static_cast<std::size_t>(nx), std::size_t{3}};
  std::vector<std::byte> bytes;
  {
    nb::gil_scoped_release const released;
    bytes = run.spins();
  }
  return run.first().precision() == Precision::double_precision
             ? array_of_bytes<double>(bytes, shape)
             : array_of_bytes<float>(bytes, shape);
}

// Returns lists of the energies, the norm defects and the magnetizations of the replicas. The last
// list has three numbers for each replica, one after another.
nb::tuple sample(EnsembleRun& run) {
  std::vector<io::Scalars> scalars;
  {
    nb::gil_scoped_release const released;
    scalars = run.scalars();
  }
  std::vector<double> energies, defects, magnetizations;
  for (auto const& one : scalars) {
    energies.push_back(one.energy);
    defects.push_back(one.norm_defect);
    magnetizations.insert(magnetizations.end(), one.magnetization.begin(), one.magnetization.end());
  }
  return nb::make_tuple(energies, defects, magnetizations);
}

}  // namespace

void define_ensemble(nb::module_& module) {
  nb::class_<EnsembleRun>(module, "EnsembleRun")
      .def(nb::new_([](io::Scene const& scene, std::string const& precision,
                       std::optional<std::string> const& space, std::optional<int> threads) {
             if (!scene.ensemble.there())
               throw UsageError(
                   "EnsembleSimulation: the scene has no [ensemble]; accepted: Simulation");
             RunSettings const settings{precision_of(precision), space, threads};
             nb::gil_scoped_release const released;
             return shared(
                 std::make_unique<EnsembleRun>(scene, settings, !io::has_integrator(scene)));
           }),
           "scene"_a, "precision"_a, "space"_a.none(), "threads"_a.none())
      .def("continue_from", &EnsembleRun::continue_from, "file"_a,
           nb::call_guard<nb::gil_scoped_release>())
      .def("advance", advance, "count"_a, "until_torque"_a)
      .def("relax", relax, "torque"_a, "evaluations"_a, "keep_saddles"_a)
      .def("require_reachable", &EnsembleRun::require_reachable)
      .def("step_at", [](EnsembleRun& run, double t) { return run.first().step_at(t); })
      .def("warning", &EnsembleRun::warning, nb::call_guard<nb::gil_scoped_release>())
      .def("spins", spins)
      .def("sample", sample)
      .def_prop_ro("replicas", &EnsembleRun::replicas)
      .def_prop_ro("last_step", &EnsembleRun::last_step)
      .def_prop_ro("steps", &EnsembleRun::steps)
      .def_prop_ro("time", &EnsembleRun::time)
      .def_prop_ro("evaluations", &EnsembleRun::evaluations,
                   nb::call_guard<nb::gil_scoped_release>())
      .def_prop_ro("step_seconds", &EnsembleRun::step_seconds,
                   nb::call_guard<nb::gil_scoped_release>())
      .def_prop_ro("space", [](EnsembleRun& run) { return run.first().space(); })
      .def_prop_ro("threads", [](EnsembleRun& run) { return run.first().threads(); })
      .def_prop_ro("precision", [](EnsembleRun& run) {
        return std::string(to_string(run.first().precision()));
      });
}

}  // namespace cayspin::python
