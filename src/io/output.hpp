// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/key.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>

namespace cayspin::inline v0_2::io {

/// The interval at which a run writes FILE.checkpoint.h5, in seconds or in steps; never if both are
/// 0. A run continued from that file gives bitwise the same results as an uninterrupted one.
struct CheckpointPeriod {
  double seconds = 600;
  std::int64_t steps = 0;

  bool is_never() const { return seconds == 0 && steps == 0; }
};

/// The table [output].
struct Output {
  std::optional<std::filesystem::path> file;  ///< as typed: relative to the working directory
  std::int64_t every = 1;          ///< steps between frames, >= 1; default: the steps of the run
  std::int64_t scalars_every = 1;  ///< steps between scalar samples, >= 1; default: `every`
  int compression = 0;             ///< compression level of /spins: 0 (none) to 9
  std::int64_t chunk = 0;          ///< planes along z in a chunk of /spins; 0: all
  bool xdmf = false;               ///< writes FILE.xdmf for viewers
  bool table = false;              ///< writes FILE.txt with the scalar samples
  bool sync = false;               ///< a power cut loses at most the frame being written
  bool regions = false;            ///< samples have the magnetization and energy of each region
  bool terms = false;              ///< samples have the energy of each term
  CheckpointPeriod checkpoint_every;

  static constexpr auto keys() {
    return std::to_array<Key<Output>>(
        {{"file"},
         {"every"},
         {"scalars_every"},
         {"compression", &Output::compression, {"a level from 0 (none) to 9", 0, 9}},
         {"chunk", &Output::chunk, {"a whole number of planes along z >= 1", 1}},
         {"checkpoint_every"},
         {"xdmf", &Output::xdmf},
         {"table", &Output::table},
         {"sync", &Output::sync},
         {"regions", &Output::regions},
         {"terms", &Output::terms}});
  }
};

}  // namespace cayspin::inline v0_2::io
