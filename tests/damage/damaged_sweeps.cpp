// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// A sweep that reads a damaged file of a run refuses it with one line, or copies it completely.
// CAYSPIN_DAMAGED_SWEEPS and CAYSPIN_SEED: number of files, and the seed.
#include "damaged_bytes.hpp"
#include "hdf5/real_dataset.hpp"
#include "io/sweep.hpp"
#include "support/reads_in_child.hpp"
#include "trajectory/trajectory_test.hpp"

#include <sys/syscall.h>

#include <cerrno>
#include <iostream>

namespace {

int error_of_sync = 0;  // what syncing a file returns; 0: it is synced

}  // namespace

extern "C" int fdatasync(int file) {
  if (error_of_sync == 0) return static_cast<int>(::syscall(SYS_fdatasync, file));
  errno = error_of_sync;
  return -1;
}

namespace cayspin::inline v0_2::io {
namespace {

using cayspin::test::Chance;
using cayspin::test::damaged;
using cayspin::test::number_from;
namespace fs = std::filesystem;

class DamagedSweeps : public TrajectoryTest {
 protected:
  DamagedSweeps() {
    fs::create_directory(sweep_folder(path_));
    sweep_.header.keys = {{"system.damping", {"0.1"}, {0.1}}};
    sweep_.header.precision = "double";
    sweep_.runs.resize(1);
    sweep_.runs[0].has_file = true;
    sweep_.complete = sweep_.one_file = true;
    auto const header = small_header("double");
    TrajectoryFile file(run_, header, false, {});
    for (int frame = 0; frame < 8; ++frame) {
      auto const spins = numbered_spins<double>(header, frame);
      file.write_frame(frame, 0.1 * frame, numbered_scalars(frame), spins.data());
      spins_.insert(spins_.end(), spins.begin(), spins.end());
    }
    file.finish({});
  }

  std::vector<double> spins_in_sweep() const {
    return RealDataset(path_, "/runs/0000/spins").read();
  }

  // Runs are copied before the end of a sweep only if the disk is far from full, so tests of these
  // copies fail on a full disk.
  bool has_plenty_of_room() const {
    return fs::space(folder_).available > std::uintmax_t{2} << 30U;
  }

  fs::path path_ = folder_ / "sweep.h5";
  fs::path copies_ = path_.string() + ".runs.partial";
  fs::path run_ = swept_run_file(path_, 0);
  SweepInfo sweep_;
  std::vector<double> spins_;
};

TEST_F(DamagedSweeps, TakeInAWholeRunOrRefuseIt) {
  auto const bytes = read_bytes(run_);
  for (bool const is_new : {true, false}) {
    sweep_.runs[0].is_new = is_new;
    ASSERT_TRUE(write_sweep(path_, sweep_));
    EXPECT_EQ(spins_in_sweep(), spins_);
  }
  Chance chance(static_cast<std::uint64_t>(number_from("CAYSPIN_SEED", 1)));
  int taken = 0, refused = 0;
  for (long count = number_from("CAYSPIN_DAMAGED_SWEEPS", 40); count > 0; --count) {
    auto const changed = damaged(bytes, chance);
    write_bytes(run_, changed);
    try {
      write_sweep(path_, sweep_);
      ++taken;
      EXPECT_EQ(spins_in_sweep(), spins_) << count;
    } catch (std::runtime_error const& error) {
      ++refused;
      std::string const message = error.what();
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
      EXPECT_NE(message.find("0000.h5"), std::string::npos) << message;
    }
    EXPECT_EQ(std::distance(fs::directory_iterator(sweep_folder(path_)), {}), 1) << "it left files";
  }
  std::cout << taken << " taken in as they were, " << refused << " refused\n";
  EXPECT_GT(taken, 0);
  EXPECT_GT(refused, 0);
}

// The runs' own files are removed after they are copied.
TEST_F(DamagedSweeps, KeepTheOldFileIfTheDiskRefusesTheCopies) {
  sweep_.complete = sweep_.one_file = false;
  ASSERT_TRUE(write_sweep(path_, sweep_));
  auto const before = read_bytes(path_);
  sweep_.complete = sweep_.one_file = true;
  error_of_sync = ENOSPC;
  EXPECT_TRUE(contains(error_line(path_, [&] { write_sweep(path_, sweep_); }),
                       "cannot write the file: No space left on device"));
  error_of_sync = 0;
  EXPECT_EQ(read_bytes(path_), before);
  EXPECT_FALSE(fs::exists(path_.string() + ".partial"));
}

TEST_F(DamagedSweeps, TakeOverCopiesOfRuns) {
  ASSERT_TRUE(has_plenty_of_room());
  write_bytes(copies_, "left by a kill");
  SweepCopies copies(path_);
  copies.add(0);
  fs::remove(run_);  // so that write_sweep() cannot copy it
  ASSERT_TRUE(write_sweep(path_, sweep_, {}, &copies));
  EXPECT_EQ(spins_in_sweep(), spins_);
  EXPECT_FALSE(fs::exists(copies_));
}

TEST_F(DamagedSweeps, RemoveCopiesThatAKillLeft) {
  write_bytes(copies_, "left by a kill");
  SweepCopies(folder_ / "other.h5").remove_left();
  EXPECT_TRUE(fs::exists(copies_));
  ASSERT_TRUE(write_sweep(path_, sweep_));
  SweepCopies(path_).remove_left();
  EXPECT_FALSE(fs::exists(copies_));
  EXPECT_TRUE(fs::exists(path_));
}

TEST_F(DamagedSweeps, LeaveNoCopiesThatNoSweepTakes) {
  ASSERT_TRUE(has_plenty_of_room());
  {
    SweepCopies copies(path_);
    copies.add(0);
    EXPECT_TRUE(fs::exists(copies_));
  }
  EXPECT_FALSE(fs::exists(copies_));
  EXPECT_FALSE(fs::exists(path_));
}

TEST_F(DamagedSweeps, CopyLaterWhatCannotBeCopiedAtOnce) {
  auto const bytes = read_bytes(run_);
  write_bytes(run_, bytes.substr(0, 1000));
  SweepCopies copies(path_);
  copies.add(0);
  EXPECT_FALSE(fs::exists(copies_));
  write_bytes(run_, bytes);
  ASSERT_TRUE(write_sweep(path_, sweep_, {}, &copies));
  EXPECT_EQ(spins_in_sweep(), spins_);
  EXPECT_FALSE(fs::exists(copies_));
}

}  // namespace
}  // namespace cayspin::inline v0_2::io
