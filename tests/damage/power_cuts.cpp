// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Files written with `sync`, after a power cut at a random moment: any part of the data written
// since the last synchronisation may be there. CAYSPIN_POWER_CUTS and CAYSPIN_SEED: number of cuts,
// and the seed.
#include "damaged_bytes.hpp"
#include "hdf5/guarded_reading.hpp"
#include "known_run.hpp"
#include "memory_folder.hpp"
#include "recorded_disk.hpp"
#include "support/reads_in_child.hpp"

#include <iostream>

namespace cayspin::inline v0_2::io {
namespace {

using namespace cayspin::test;
namespace fs = std::filesystem;

struct Recording {
  KnownRun run = {};
  std::vector<DiskEvent> events = {};
  std::vector<Told> told = {};  // indexed by the numbers given to note_told
  std::size_t first_cut = 0;    // the events before this one write an older file

  Told told_before(std::size_t cut) const {
    for (auto i = cut; i-- > 0;)
      if (events[i].kind == DiskEvent::told) return told[events[i].offset];
    return {};
  }
};

class PowerCuts : public testing::Test {
 protected:
  PowerCuts() { fs::create_directories(folder_ / "cut"); }

  Recording record(KnownRun run) {
    run.storage.sync = true;
    run.header.scene_text += "# of this run\n";
    Recording recording{.run = run};
    auto const folder = folder_ / "recorded";
    fs::create_directories(folder);
    record_disk(folder);
    if (run.replaces) {
      write_older_file(folder / "a.h5", true);
      recording.first_cut = note_told(0);
      recording.told.emplace_back();
    }
    write_known_run(folder / "a.h5", run, [&](Told const& told) {
      note_told(recording.told.size());
      recording.told.push_back(told);
    });
    recording.events = stop_recording();
    fs::remove_all(folder);
    return recording;
  }

  fs::path path() const { return folder_ / "cut" / "a.h5"; }

  void put_on_disk(DiskState const& state) const {
    for (auto const& entry : fs::directory_iterator(folder_ / "cut")) fs::remove(entry.path());
    for (auto const& [name, bytes] : state) write_bytes(folder_ / "cut" / name, bytes);
  }

  void expect_nothing_lost(Recording const& recording, std::size_t cut) {
    auto const told = recording.told_before(cut);
    if (!fs::exists(path())) {
      EXPECT_FALSE(told.created);
      lost_ += told.created;
      return;
    }
    auto const needed = fs::exists(path().string() + ".journal");
    try {
      try_reading(path(), [&] { require_known(path(), recording.run, told); });
      completed_ += needed && !fs::exists(path().string() + ".journal");
      frames_ += told.frames;
    } catch (std::runtime_error const& error) {
      std::string const message = error.what();
      ++(message.starts_with("wrong") ? wrong_ : lost_);
      ADD_FAILURE() << message << ", cut before event " << cut << " of " << recording.events.size()
                    << ", after " << told.frames << " frames";
    }
  }

  // Continues the run from its last frame, in a file that replaces this one.
  void expect_to_go_on(KnownRun run) const {
    auto const info = read_info(path());
    if (info.frames == 0 || info.header.shape != run.header.shape) return;
    auto const last = info.frame_steps.back();
    EXPECT_EQ(read_spins(path(), info.header.shape), read_back_at(info.header, last));
    run.first_step = last;
    run.frames = 2;
    run.replaces = true;
    Told told;
    write_known_run(path(), run, [&](Told const& now) { told = now; });
    EXPECT_NO_THROW(require_known(path(), run, told));
    EXPECT_FALSE(fs::exists(path().string() + ".journal"));
  }

  void cut_at_random(Recording const& recording, long histories) {
    for (long history = 0; history < histories; ++history) {
      auto const cut =
          recording.first_cut + chance_.below(recording.events.size() + 1 - recording.first_cut);
      auto const share = chance_.below(5) * 25;  // percentage of sectors that are there
      auto const any = [&](std::size_t end) { return chance_.below(end); };
      auto const there = [&](std::size_t end) {
        return end == 2 ? std::size_t{chance_.below(100) < share} : chance_.below(end);
      };
      auto state = after_power_cut(recording.events, cut, there, any);
      put_on_disk(state);
      if (history % 4 == 2) cut_while_completing(state, there, any);
      expect_nothing_lost(recording, cut);
      if (HasFailure() || !fs::exists(path())) continue;
      if (history % 8 == 0) keep_for_h5py();
      if (history % 8 == 1) expect_to_go_on(recording.run);
    }
  }

  // Cuts the power again, while a reader completes the file.
  void cut_while_completing(DiskState const& state, Choose const& there, Choose const& any) {
    record_disk(folder_ / "cut", state);
    auto const first = note_told(0);
    complete_file(path());
    auto const events = stop_recording();
    cut_twice_ += events.size() > first;
    auto const cut = first + chance_.below(events.size() + 1 - first);
    put_on_disk(after_power_cut(events, cut, there, any));
  }

  void keep_for_h5py() { fs::copy_file(path(), folder_ / (std::to_string(kept_++) + ".h5")); }

  void expect_h5py_opens_all() const {
    auto const command =
        std::string(CAYSPIN_PYTHON) + " -B " + CAYSPIN_OPEN_ALL + " " + folder_.string() + "/*.h5";
    EXPECT_EQ(std::system(command.c_str()), 0);
  }

  MemoryFolder memory_{"power_cuts"};
  fs::path folder_ = memory_.path();
  Chance chance_{static_cast<std::uint64_t>(number_from("CAYSPIN_SEED", 1))};
  std::int64_t lost_ = 0, wrong_ = 0, completed_ = 0, cut_twice_ = 0, frames_ = 0, kept_ = 0;
};

TrajectoryHeader header_of(std::array<std::int64_t, 3> const& shape, char const* precision,
                           std::int64_t cell_sites = 1) {
  auto header = small_header(precision);
  header.shape = shape;
  header.cell_sites = cell_sites;
  return header;
}

// Frames that share a chunk, frames that fill several chunks, compressed frames, and frames beyond
// the first blocks of HDF5's index; more samples than a chunk holds; a file that replaces another;
// cells of two sites.
TEST_F(PowerCuts, LoseAtMostTheFrameBeingWritten) {
  std::vector<KnownRun> const runs{
      {.header = header_of({4, 3, 2}, "double"), .frames = 12, .samples = 3},
      {.header = header_of({10, 3, 1}, "single"), .storage = {.frames = 50'000}, .frames = 30},
      {.header = header_of({16, 16, 5}, "double"), .storage = {.chunk = 2}, .frames = 8},
      {.header = header_of({16, 8, 2}, "single"), .storage = {.compression = 1}, .frames = 40},
      {.header = header_of({5, 1, 1}, "double"), .frames = 4, .samples = 300},
      {.header = header_of({4, 4, 1}, "double"), .frames = 3, .samples = 1, .replaces = true},
      {.header = header_of({16, 16, 6}, "double", 2), .storage = {.chunk = 2}, .frames = 6},
  };
  auto const histories = number_from("CAYSPIN_POWER_CUTS", 1000);
  auto const count = static_cast<long>(runs.size());
  for (long i = 0; i < count; ++i)
    cut_at_random(record(runs[static_cast<std::size_t>(i)]),
                  histories / count + (i < histories % count));
  if (kept_ > 0) expect_h5py_opens_all();
  EXPECT_EQ(lost_ + wrong_, 0);
  EXPECT_GT(completed_, histories / 10);
  std::cout << "power cut replay, " << histories << " histories: " << lost_
            << " lost before the last sync, " << wrong_ << " wrong; " << frames_ << " frames, "
            << completed_ << " files beside a journal, " << cut_twice_
            << " cut again while completed\n";
}

// A Choose that goes through every possible sequence of choices. advance() starts the next
// sequence; it returns false after the last one.
class AllChoices {
 public:
  std::size_t operator()(std::size_t end) {
    if (next_ == chosen_.size()) chosen_.push_back({0, end});
    return chosen_[next_++].first;
  }

  bool advance() {
    next_ = 0;
    while (!chosen_.empty() && chosen_.back().first + 1 == chosen_.back().second)
      chosen_.pop_back();
    if (chosen_.empty()) return false;
    ++chosen_.back().first;
    return true;
  }

 private:
  std::vector<std::pair<std::size_t, std::size_t>> chosen_;
  std::size_t next_ = 0;
};

// At each cut for which few sequences of choices are possible, tries all of them. The writes reach
// the disk in a fixed order.
TEST_F(PowerCuts, LoseNothingWhateverOfFewWritesIsThere) {
  auto const recording = record(
      {.header = header_of({2, 1, 1}, "double"), .frames = 2, .samples = 1, .replaces = true});
  auto const last = [](std::size_t end) { return end - 1; };
  double const most = std::getenv("CAYSPIN_POWER_CUTS") ? 4096 : 32;
  long histories = 0, cuts = 0;
  for (auto cut = recording.first_cut; cut <= recording.events.size() && !HasFailure(); ++cut) {
    double count = 1;  // number of sequences of choices, if all names are there
    auto const counted = [&](std::size_t end) {
      count *= static_cast<double>(end);
      return end - 1;
    };
    after_power_cut(recording.events, cut, counted, last);
    if (count > most) continue;
    ++cuts;
    AllChoices each;
    auto const next = [&](std::size_t end) { return each(end); };
    do {
      put_on_disk(after_power_cut(recording.events, cut, next, last));
      expect_nothing_lost(recording, cut);
      ++histories;
    } while (each.advance());
  }
  EXPECT_GT(cuts, 20);
  std::cout << "all of " << histories << " histories of " << cuts << " cuts: " << lost_ << " lost, "
            << wrong_ << " wrong\n";
}

}  // namespace
}  // namespace cayspin::inline v0_2::io
