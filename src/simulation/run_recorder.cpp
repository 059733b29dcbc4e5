// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "run_recorder.hpp"

#include "io/checkpoint.hpp"
#include "run_files.hpp"

#include <algorithm>

namespace cayspin::simulation {
namespace {

constexpr std::int64_t most_steps = 4096;  // between readings of the clock

}  // namespace

RunRecorder::RunRecorder(SceneRun& run, std::int64_t end, std::filesystem::path const& path,
                         bool overwrite, std::string const& git_commit)
    : run_(run),
      first_(run.steps()),
      end_(end),
      evaluations_before_(run.evaluations()),
      seconds_before_(run.step_seconds()),
      checkpoint_(io::checkpoint_beside(path)),
      checkpoints_(run.scene().output.checkpoint_every, first_),
      file_(open_output(
          path, run_header(run.scene(), run.precision(), run.space(), run.threads(), git_commit),
          run_output_options(run.scene(), overwrite))) {}

std::int64_t RunRecorder::next() const {
  auto const& output = run_.scene().output;
  std::int64_t const now = run_.steps();
  auto const after = [&](std::int64_t every) { return (now / every + 1) * every; };
  auto const& period = output.checkpoint_every;
  auto const frame_or_end =
      std::min({after(output.every), after(output.scalars_every), std::max(now, end_)});
  if (period.is_never()) return frame_or_end;
  return std::min(frame_or_end, after(period.steps > 0 ? period.steps : most_steps));
}

void RunRecorder::look(bool last) {
  auto const& output = run_.scene().output;
  std::int64_t const now = run_.steps();
  if (now == written_) return;
  auto const due = [&](std::int64_t every) {
    return last || now == first_ || now == end_ || now % every == 0;
  };
  bool const frame = due(output.every), scalars = now != sampled_ && due(output.scalars_every);
  bool const stored = checkpoints_.due({now, run_.time(), 0, last || now == end_});
  if (!frame && !scalars && !stored) return;
  // The sample is in the scene's units already.
  auto const values = as_scalars(run_.judged_sample(), {});
  if (stored) {
    run_.save(checkpoint_);
    checkpoints_.wait();
  }
  if (scalars) {
    file_.write_scalars(now, run_.time(), values, run_.more_of_sample());
    sampled_ = now;
  }
  if (frame) {
    auto const spins = run_.spins();
    if (run_.precision() == Precision::double_precision)
      std::ranges::copy(packed<double>(spins.vectors), file_.frame<double>());
    else
      std::ranges::copy(packed<float>(spins.vectors), file_.frame<float>());
    file_.write_frame(now, run_.time(), values, {.shift = run_.shift()});
    written_ = now;
  }
  // Waits until the frame is written, because the caller may use HDF5 between two calls.
  file_.frames();
}

void RunRecorder::finish(bool as_planned) {
  io::RunCost const cost{run_.evaluations() - evaluations_before_, clock_.seconds(),
                         run_.step_seconds() - seconds_before_};
  as_planned ? file_.finish(cost) : file_.close(cost);
  // A run whose numbers failed is past its last frame: the earlier checkpoint is kept.
  if (run_.scene().output.checkpoint_every.is_never() || written_ != run_.steps()) return;
  if (run_.remembers())
    run_.save(checkpoint_);
  else
    std::filesystem::remove(checkpoint_);
}

}  // namespace cayspin::simulation
