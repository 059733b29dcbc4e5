// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Writes a small trajectory for the scripts to draw: write_trajectory FILE.h5 SITES LENGTH
// CELL_SITES. All spins have the length LENGTH and turn about z, each with its own phase.
#include "io/trajectory.hpp"

#include <cmath>
#include <cstdlib>

int main(int count, char** words) {
  if (count != 5) return 2;
  int const cell_sites = std::atoi(words[4]), along_x = std::atoi(words[2]);
  int const sites = along_x * cell_sites;
  double const length = std::atof(words[3]);
  using namespace cayspin::io;
  TrajectoryHeader header;
  header.precision = "double";
  header.shape = {along_x, 1, cell_sites};
  header.cell_sites = cell_sites;
  TrajectoryFile file(words[1], header, true);
  std::vector<double> spins(3 * static_cast<std::size_t>(sites));
  for (int frame = 0; frame < 20; ++frame) {
    double const time = 0.1 * frame;
    for (int site = 0; site < sites; ++site) {
      spins[3 * site] = length * std::cos(time + site) * 0.8;
      spins[3 * site + 1] = length * std::sin(time + site) * 0.8;
      spins[3 * site + 2] = length * 0.6;
    }
    Scalars const scalars{
        1 - time, std::abs(length - 1), {0.3 * std::cos(time), 0.3 * std::sin(time), 0.6 * length}};
    file.write_scalars(frame, time, scalars);
    file.write_frame(frame, time, scalars, spins.data());
  }
  file.finish({});
}
