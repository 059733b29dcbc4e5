// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "run_recorder.hpp"

#include <cayspin/version.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace cayspin::simulation {
namespace {

io::TrajectoryHeader header_of(SceneRun const& run, std::string const& git_commit) {
  io::TrajectoryHeader header;
  header.scene_text = run.scene().text;
  header.cayspin_version = CAYSPIN_VERSION_STRING;
  header.git_commit = git_commit;
  header.kokkos_version = fmt::format("{}.{}.{}", KOKKOS_VERSION / 10000,
                                      KOKKOS_VERSION / 100 % 100, KOKKOS_VERSION % 100);
  header.space = run.space();
  header.precision = to_string(run.precision());
  header.threads = run.threads();
  header.shape = run.scene().lattice.shape;
  return header;
}

io::Scalars as_scalars(Sample const& sample) {
  auto const& m = sample.magnetization;
  return {sample.energy.value, sample.norm_defect, {m.x, m.y, m.z}};
}

}  // namespace

RunRecorder::RunRecorder(SceneRun& run, std::int64_t end, std::filesystem::path const& path,
                         bool overwrite, std::string const& git_commit)
    : run_(run),
      first_(run.steps()),
      end_(end),
      evaluations_before_(run.evaluations()),
      seconds_before_(run.step_seconds()),
      file_(path, header_of(run, git_commit), overwrite) {}

std::int64_t RunRecorder::next() const {
  auto const& output = run_.scene().output;
  std::int64_t const now = run_.steps();
  auto const after = [&](std::int64_t every) { return (now / every + 1) * every; };
  return std::min({after(output.every), after(output.scalars_every), std::max(now, end_)});
}

void RunRecorder::look(bool last) {
  auto const& output = run_.scene().output;
  std::int64_t const now = run_.steps();
  if (now == written_) return;
  auto const due = [&](std::int64_t every) {
    return last || now == first_ || now == end_ || now % every == 0;
  };
  bool const frame = due(output.every), scalars = due(output.scalars_every);
  if (!frame && !scalars) return;
  auto const values = as_scalars(run_.sample());
  if (scalars) file_.write_scalars(now, run_.time(), values);
  if (!frame) return;
  written_ = now;
  auto const spins = run_.spins();
  if (run_.precision() == Precision::double_precision)
    file_.write_frame(now, run_.time(), values, packed<double>(spins.vectors).data());
  else
    file_.write_frame(now, run_.time(), values, packed<float>(spins.vectors).data());
}

void RunRecorder::finish(bool as_planned) {
  io::RunCost const cost{run_.evaluations() - evaluations_before_, clock_.seconds(),
                         run_.step_seconds() - seconds_before_};
  as_planned ? file_.finish(cost) : file_.close(cost);
}

}  // namespace cayspin::simulation
