// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "arrays.hpp"
#include "simulation/scene_run.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <variant>

namespace cayspin::python {

/// An end of a path: the spins of all sites, or a file that initial.file accepts.
using StateIn = std::variant<NumbersIn, std::filesystem::path>;

/// Finds a minimum energy path from one state to another, or over the lowest saddle to which
/// `modes` lead.
nb::dict path(simulation::SceneRun const& run, StateIn const& start,
              std::optional<StateIn> const& end, std::int64_t images, double torque,
              std::int64_t evaluations, bool rates, std::optional<std::int64_t> const& modes);

}  // namespace cayspin::python
