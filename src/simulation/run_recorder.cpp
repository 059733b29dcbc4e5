// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "run_recorder.hpp"

#include "run_files.hpp"

#include <algorithm>

namespace cayspin::simulation {
RunRecorder::RunRecorder(SceneRun& run, std::int64_t end, std::filesystem::path const& path,
                         bool overwrite, std::string const& git_commit)
    : run_(run),
      first_(run.steps()),
      end_(end),
      evaluations_before_(run.evaluations()),
      seconds_before_(run.step_seconds()),
      file_(path, run_header(run.scene(), run.precision(), run.space(), run.threads(), git_commit),
            run_output_options(run.scene(), overwrite)) {}

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
  // run_.sample() is in the scene's units already.
  auto const values = as_scalars(run_.sample(), {});
  if (scalars) file_.write_scalars(now, run_.time(), values);
  if (frame) {
    auto const spins = run_.spins();
    if (run_.precision() == Precision::double_precision)
      std::ranges::copy(packed<double>(spins.vectors), file_.frame<double>());
    else
      std::ranges::copy(packed<float>(spins.vectors), file_.frame<float>());
    file_.write_frame(now, run_.time(), values);
    written_ = now;
  }
  // What runs between two looks may use HDF5, too.
  file_.frames();
}

void RunRecorder::finish(bool as_planned) {
  io::RunCost const cost{run_.evaluations() - evaluations_before_, clock_.seconds(),
                         run_.step_seconds() - seconds_before_};
  as_planned ? file_.finish(cost) : file_.close(cost);
}

}  // namespace cayspin::simulation
