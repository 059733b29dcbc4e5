// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/checkpoint.hpp"
#include "io/run_output.hpp"
#include "io/scene.hpp"
#include "precision.hpp"

#include <cayspin/observer/record.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

// Contents of the files of every run, in the units of the scene.
namespace cayspin::simulation {

io::TrajectoryHeader run_header(io::Scene const& scene, Precision precision,
                                std::string const& space, int threads,
                                std::string const& git_commit);

/// Returns a header for the state after `step`, at `time` in the scene's units.
io::CheckpointHeader checkpoint_header(io::Scene const& scene, Precision precision,
                                       std::int64_t step, double time);

/// Returns true if files store the positions of the sites, because the sites do not form a
/// rectangular grid.
bool has_positions(io::Lattice const& lattice);
/// Returns the bytes of /positions in a file; 0 without them.
std::int64_t position_bytes(io::Lattice const& lattice);

/// Returns how the scene wants its frames stored.
io::TrajectoryStorage storage_of(io::Scene const& scene);

io::RunOutputOptions run_output_options(io::Scene const& scene, bool overwrite);

/// Throws std::runtime_error if the file `path`, or one with the name of its checkpoint, must not
/// be replaced.
void require_free_output(std::filesystem::path const& path, bool overwrite);

/// Opens the trajectory `path` of a new run, and its other files. Throws std::runtime_error if one
/// of them, or a file with the name of the checkpoint, must not be replaced. Removes an old
/// checkpoint, which would be taken for this run's.
io::RunOutput open_output(std::filesystem::path const& path, io::TrajectoryHeader const& header,
                          io::RunOutputOptions const& options);

/// Returns why a run could not write the files of its scene, in one line, or nothing.
std::optional<std::string> output_refusal(io::Output const& output);

io::Scalars as_scalars(Sample const& sample, io::Units const& units);

}  // namespace cayspin::simulation
