// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// write_seeds FOLDER: writes small HDF5 files as initial inputs of the fuzzers, and empty folders
// for their findings.
#include "io/sweep.hpp"
#include "io/trajectory.hpp"

#include <vector>

namespace io = cayspin::io;

int main(int, char** arguments) {
  std::filesystem::path const folder = arguments[1];
  std::filesystem::remove_all(folder);
  for (auto const* name : {"trajectory", "sweep"})
    std::filesystem::create_directories(folder / name);
  for (auto const* reader : {"scene", "expression", "ovf", "trajectory", "sweep"})
    std::filesystem::create_directories(folder / "found" / reader);
  io::TrajectoryHeader header;
  header.scene_text = "[system]\n";
  header.precision = "double";
  std::vector<double> const spins{0, 0, 1, 0, 1, 0};
  for (int compression : {0, 6, 1}) {
    auto const name = "level_" + std::to_string(compression) + ".h5";
    bool const crystal = compression == 1;
    header.shape =
        crystal ? std::array<std::int64_t, 3>{1, 1, 2} : std::array<std::int64_t, 3>{2, 1, 1};
    header.cell_sites = crystal ? 2 : 1;
    io::TrajectoryFile file(folder / "trajectory" / name, header, true,
                            {.compression = compression});
    for (int frame = 0; frame < 2; ++frame) file.write_frame(frame, frame, {}, spins.data());
    file.finish({});
  }
  io::SweepInfo sweep;
  sweep.header.keys = {{"system.damping", {"0.1", "0.2"}, {0.1, 0.2}}};
  sweep.runs.resize(2);
  io::write_sweep(folder / "sweep" / "two_runs.h5", sweep);
}
