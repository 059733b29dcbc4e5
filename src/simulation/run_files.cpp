// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "run_files.hpp"

#include "files/file_beside.hpp"
#include "io/ensemble_checkpoint.hpp"
#include "plan.hpp"
#include "single_terms.hpp"

#include <cayspin/version.hpp>

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <iterator>
#include <stdexcept>
#include <system_error>
#include <vector>

namespace cayspin::simulation {
namespace {

bool is_whole_checkpoint(std::filesystem::path const& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return false;
  try {
    return io::is_checkpoint(path) || io::is_ensemble_checkpoint(path);
  } catch (std::runtime_error const&) {
    return false;
  }
}

// Returns the positions in the order of the file: those of the cell's first site in all cells, then
// those of its next site.
std::vector<double> positions(io::Lattice const& lattice, io::Triple const& spacing) {
  auto const [nx, ny, planes] = lattice.shape;
  auto const nz = planes / std::ssize(lattice.basis);
  std::vector<double> numbers;
  numbers.reserve(static_cast<std::size_t>(3 * nx * ny * planes));
  for (auto const& fraction : lattice.basis)
    for (std::int64_t k = 0; k < nz; ++k)
      for (std::int64_t j = 0; j < ny; ++j)
        for (std::int64_t i = 0; i < nx; ++i)
          for (std::size_t c = 0; c < 3; ++c)
            numbers.push_back(((static_cast<double>(i) + fraction[0]) * lattice.cell[0][c] +
                               (static_cast<double>(j) + fraction[1]) * lattice.cell[1][c] +
                               (static_cast<double>(k) + fraction[2]) * lattice.cell[2][c]) *
                              spacing[c]);
  return numbers;
}

}  // namespace

void require_free_output(std::filesystem::path const& path, bool overwrite) {
  io::require_free(path, overwrite);
  auto const checkpoint = io::checkpoint_beside(path);
  io::require_free(checkpoint, overwrite || is_whole_checkpoint(checkpoint));
}

bool has_positions(io::Lattice const& lattice) {
  return lattice.basis.size() > 1 || lattice.cell != io::Lattice().cell;
}

std::int64_t position_bytes(io::Lattice const& lattice) {
  auto const& [nx, ny, nz] = lattice.shape;
  return has_positions(lattice) ? 3 * 8 * nx * ny * nz : 0;
}

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
  header.cell_sites = std::ssize(scene.lattice.basis);
  header.units = scene.units;
  header.more = more_scalars(scene);
  if (!scene.stages.empty() || scene.begin != io::StageBegin{}) header.stage = scene.begin;
  return header;
}

io::CheckpointHeader checkpoint_header(io::Scene const& scene, Precision precision,
                                       std::int64_t step, double time) {
  return {.scene_text = scene.text,
          .resolved_scene = {},
          .cayspin_version = CAYSPIN_VERSION_STRING,
          .precision = std::string(to_string(precision)),
          .shape = scene.lattice.shape,
          .cell_sites = std::ssize(scene.lattice.basis),
          .step = step,
          .time = time,
          .si = scene.units.si,
          .stage = scene.begin};
}

io::TrajectoryStorage storage_of(io::Scene const& scene) {
  auto const& output = scene.output;
  auto frames = frames_of(scene.integrator.steps, output.every);
  for (auto const& [name, relax, of] : scene.stages)
    frames += frames_of(of.integrator.steps, of.output.every);
  return {output.compression, output.chunk, frames, output.sync};
}

io::RunOutputOptions run_output_options(io::Scene const& scene, bool overwrite) {
  auto const& output = scene.output;
  auto spacing = scene.lattice.spacing;
  for (double& along_axis : spacing) along_axis *= scene.units.length;
  return {.overwrite = overwrite,
          .storage = storage_of(scene),
          .xdmf = output.xdmf,
          .table = output.table,
          .spacing = spacing,
          .positions = has_positions(scene.lattice) ? positions(scene.lattice, spacing)
                                                    : std::vector<double>()};
}

io::RunOutput open_output(std::filesystem::path const& path, io::TrajectoryHeader const& header,
                          io::RunOutputOptions const& options) {
  require_free_output(path, options.overwrite);
  io::RunOutput file(path, header, options);
  std::filesystem::remove(io::checkpoint_beside(path));
  return file;
}

std::optional<std::string> output_refusal(io::Output const& output) {
  if (!output.file) return std::nullopt;
  auto const& path = *output.file;
  auto const beside = [&](char const* extension) {
    return std::filesystem::path(path).replace_extension(extension);
  };
  try {
    require_free_output(path, false);
    if (output.xdmf) io::require_free(beside(".xdmf"), false);
    if (output.table) io::require_free(beside(".txt"), false);
  } catch (std::runtime_error const& error) {
    return error.what();
  }
  auto const folder = path.has_parent_path() ? path.parent_path() : ".";
  if (::access(folder.c_str(), W_OK | X_OK) == 0) return std::nullopt;
  return fmt::format("{}: cannot create the file: {}", path.string(), std::strerror(errno));
}

io::Scalars as_scalars(Sample const& sample, io::Units const& units) {
  auto const& m = sample.magnetization;
  return {sample.energy.value * units.energy, sample.norm_defect, {m.x, m.y, m.z}};
}

}  // namespace cayspin::simulation
