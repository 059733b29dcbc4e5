// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "hdf5/error.hpp"
#include "trajectory/scalar_series.hpp"
#include "trajectory/stored_spins.hpp"
#include "trajectory/trajectory_test.hpp"

namespace cayspin::inline v0_2::io {

/// A run with known numbers: those of a frame or sample follow from its step.
struct KnownRun {
  TrajectoryHeader header = small_header();
  TrajectoryStorage storage = {};
  std::int64_t first_step = 0;
  std::int64_t frames = 0;
  int samples = 0;       // for each frame
  int last_samples = 0;  // after the last frame; only if `samples` > 0
  bool replaces = false;
};

/// The reports of a writer: frames and samples that it has written.
struct Told {
  bool created = false, finished = false;
  std::int64_t frames = 0, samples = 0;
};

template <class Real>
std::vector<Real> spins_at(TrajectoryHeader const& header, std::int64_t step) {
  std::vector<Real> spins(3 * header.shape[0] * header.shape[1] * header.shape[2]);
  for (std::size_t i = 0; i < spins.size(); ++i)
    spins[i] = Real(1) / Real(3 + i + static_cast<std::size_t>(step));
  return spins;
}

inline double time_at(std::int64_t step) { return 0.1 * static_cast<double>(step); }
inline Scalars scalars_at(std::int64_t step) { return numbered_scalars(static_cast<int>(step)); }

template <class Real, class Tell>
void write_known_run(std::filesystem::path const& path, KnownRun const& run, Tell const& tell) {
  TrajectoryFile file(path, run.header, run.replaces, run.storage);
  Told told{.created = true};
  tell(told);
  for (std::int64_t frame = 0; frame < run.frames; ++frame) {
    auto const step = run.first_step + frame;
    for (int sample = 0; sample < run.samples; ++sample)
      file.write_scalars(step, time_at(step), scalars_at(step));
    file.write_frame(step, time_at(step), scalars_at(step),
                     spins_at<Real>(run.header, step).data());
    told.frames = frame + 1;
    told.samples += run.samples;
    tell(told);
  }
  for (int sample = 0; sample < run.last_samples; ++sample) {
    auto const step = run.first_step + run.frames + sample / run.samples;
    file.write_scalars(step, time_at(step), scalars_at(step));
  }
  file.finish({7, 2, 1});
  told.finished = true;
  tell(told);
}

template <class Tell>
void write_known_run(std::filesystem::path const& path, KnownRun const& run, Tell const& tell) {
  run.header.precision == "single" ? write_known_run<float>(path, run, tell)
                                   : write_known_run<double>(path, run, tell);
}

inline void require(bool is_so, char const* kind, std::string const& what) {
  if (!is_so) throw std::runtime_error(std::string(kind) + ": " + what);
}

inline bool equal(Scalars const& a, Scalars const& b) {
  return a.energy == b.energy && a.norm_defect == b.norm_defect &&
         a.magnetization == b.magnetization;
}

/// Returns the spins as a reader returns them: in double.
inline std::vector<double> read_back_at(TrajectoryHeader const& header, std::int64_t step) {
  if (header.precision != "single") return spins_at<double>(header, step);
  auto const given = spins_at<float>(header, step);
  return {given.begin(), given.end()};
}

inline void require_known_samples(std::filesystem::path const& path, KnownRun const& run,
                                  std::int64_t samples) {
  QuietErrors const quiet;
  auto const file = open_file(path);
  GroupHandle const group(H5Gopen2(file.get(), "scalars", H5P_DEFAULT));
  std::int64_t number = 0;
  for (auto const& sample : ScalarSeries::open(group.get(), path).read(0, samples, path)) {
    auto const step = run.first_step + number++ / run.samples;
    require(sample.step == step && sample.time == time_at(step) &&
                equal(sample.scalars, scalars_at(step)),
            "wrong", "sample " + std::to_string(number - 1));
  }
}

/// Throws std::runtime_error unless everything reported is in the file, and all that is in the file
/// is correct.
inline void require_known(std::filesystem::path const& path, KnownRun const& run,
                          Told const& told) {
  auto const info = read_info(path);
  if (info.header.scene_text != run.header.scene_text) {
    require(run.replaces && !told.created, "lost", "the older file is there");
    require(info.complete && info.frames == 1, "wrong", "the older file is another");
    return;
  }
  require(info.header.cell_sites == run.header.cell_sites, "wrong", "the sites of a cell");
  require(info.frames >= told.frames, "lost", "frames");
  require(info.samples >= told.samples, "lost", "samples");
  require(info.complete || !told.finished, "lost", "the end");
  require(info.frames <= run.frames, "wrong", "frames that were not written");
  auto const all_samples = run.frames * run.samples + run.last_samples;
  require(!info.complete || (info.frames == run.frames && info.samples == all_samples &&
                             info.cost.evaluations == 7),
          "wrong", "what is in a complete file");
  require_known_samples(path, run, info.samples);
  if (info.frames == 0) return;
  StoredSpins const stored(path, info.header.shape, info.header.cell_sites);
  for (std::int64_t frame = 0; frame < info.frames; ++frame) {
    auto const at = static_cast<std::size_t>(frame);
    auto const step = run.first_step + frame;
    require(info.frame_steps[at] == step && info.frame_times[at] == time_at(step) &&
                equal(info.frame_scalars[at], scalars_at(step)),
            "wrong", "scalars of frame " + std::to_string(frame));
    require(stored.frame(frame) == read_back_at(info.header, step), "wrong",
            "spins of frame " + std::to_string(frame));
  }
}

/// Writes a complete file that a run may replace.
inline void write_older_file(std::filesystem::path const& path, bool sync) {
  auto const header = small_header();
  TrajectoryFile file(path, header, false, {.sync = sync});
  file.write_frame(0, 0, {}, spins_at<double>(header, 0).data());
  file.finish({});
}

}  // namespace cayspin::inline v0_2::io
