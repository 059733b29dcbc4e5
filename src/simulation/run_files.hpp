// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "precision.hpp"

#include <cayspin/io/run_output.hpp>
#include <cayspin/io/scene.hpp>
#include <cayspin/observer/record.hpp>

#include <string>

// What every run of a scene puts into its files, in the units of the scene.
namespace cayspin::simulation {

io::TrajectoryHeader run_header(io::Scene const& scene, Precision precision,
                                std::string const& space, int threads,
                                std::string const& git_commit);

io::RunOutputOptions run_output_options(io::Scene const& scene, bool overwrite);

io::Scalars as_scalars(Sample const& sample, io::Units const& units);

}  // namespace cayspin::simulation
