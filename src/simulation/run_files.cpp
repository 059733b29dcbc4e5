// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "run_files.hpp"

#include <cayspin/version.hpp>

#include <fmt/format.h>

namespace cayspin::simulation {

io::TrajectoryHeader run_header(io::Scene const& scene, Precision precision,
                                std::string const& space, int threads,
                                std::string const& git_commit) {
  io::TrajectoryHeader header;
  header.scene_text = scene.text;
  header.cayspin_version = CAYSPIN_VERSION_STRING;
  header.git_commit = git_commit;
  header.kokkos_version = fmt::format("{}.{}.{}", KOKKOS_VERSION / 10000,
                                      KOKKOS_VERSION / 100 % 100, KOKKOS_VERSION % 100);
  header.space = space;
  header.precision = to_string(precision);
  header.threads = threads;
  header.shape = scene.lattice.shape;
  header.units = scene.units;
  return header;
}

io::RunOutputOptions run_output_options(io::Scene const& scene, bool overwrite) {
  auto const& output = scene.output;
  auto spacing = scene.lattice.spacing;
  for (double& along_axis : spacing) along_axis *= scene.units.length;
  return {.overwrite = overwrite,
          .storage = {output.compression, output.chunk},
          .xdmf = output.xdmf,
          .table = output.table,
          .spacing = spacing};
}

io::Scalars as_scalars(Sample const& sample, io::Units const& units) {
  auto const& m = sample.magnetization;
  return {sample.energy.value * units.energy, sample.norm_defect, {m.x, m.y, m.z}};
}

}  // namespace cayspin::simulation
