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

// What every run of a scene puts into its files, in the units of the scene.
namespace cayspin::simulation {

io::TrajectoryHeader run_header(io::Scene const& scene, Precision precision,
                                std::string const& space, int threads,
                                std::string const& git_commit);

/// After `step`, at `time` in the scene's units.
io::CheckpointHeader checkpoint_header(io::Scene const& scene, Precision precision,
                                       std::int64_t step, double time);

/// Does a file say where the sites are? They are on no regular grid.
bool has_positions(io::Lattice const& lattice);
/// Bytes of /positions, once in a file; 0 without them.
std::int64_t position_bytes(io::Lattice const& lattice);

/// With the frames that the scene asks for.
io::TrajectoryStorage storage_of(io::Scene const& scene);

io::RunOutputOptions run_output_options(io::Scene const& scene, bool overwrite);

/// The trajectory `path` of a new run, and the files beside it. Throws if one of them, or what is
/// named like its checkpoint, must not be replaced. A checkpoint whose trajectory is gone may be:
/// that of another run would be taken for one of this file.
io::RunOutput open_output(std::filesystem::path const& path, io::TrajectoryHeader const& header,
                          io::RunOutputOptions const& options);

/// Why a run could not write the files that its scene names, in one line, or nothing.
std::optional<std::string> output_refusal(io::Output const& output);

io::Scalars as_scalars(Sample const& sample, io::Units const& units);

}  // namespace cayspin::simulation
