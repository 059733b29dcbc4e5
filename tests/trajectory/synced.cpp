// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Files with sync, and their journals. tests/damage/power_cuts.cpp simulates power cuts.
#include "trajectory_test.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace cayspin::inline v0_2::io {
namespace {

namespace fs = std::filesystem;

class Synced : public TrajectoryTest {
 protected:
  static fs::path journal_of(fs::path const& path) { return path.string() + ".journal"; }

  static TrajectoryFile begin(fs::path const& path, int frames, bool overwrite = false) {
    return write_frames(path, frames, {.sync = true}, overwrite);
  }

  // Returns a file with its journal as a power cut may leave them: a sector that the last frame
  // overwrites is zero.
  fs::path half_written(std::string const& name, int frames) const {
    auto const whole = folder_ / ("whole_" + name), path = folder_ / name;
    auto file = begin(whole, frames);
    fs::copy_file(whole, path);
    fs::copy_file(journal_of(whole), journal_of(path));
    file.finish({});
    auto const journal = read_bytes(journal_of(path));
    std::uint64_t sectors = 0, offset = 0;
    std::memcpy(&sectors, &journal.at(24), sizeof sectors);
    std::memcpy(&offset, &journal.at(40 + 520 * (sectors - 1)), sizeof offset);
    overwrite(path, offset, std::string(512, '\0'));
    return path;
  }

  static void expect_frames(fs::path const& path, int frames) {
    EXPECT_EQ(read_info(path).frames, frames);
    EXPECT_EQ(read_spins(path, small_header().shape),
              numbered_spins<double>(small_header(), frames - 1));
  }
};

TEST_F(Synced, HoldsTheSameAndLeavesNoJournal) {
  auto const path = folder_ / "a.h5";
  auto file = begin(path, 3);
  EXPECT_TRUE(fs::exists(journal_of(path)));
  file.finish({7, 2, 1});
  EXPECT_FALSE(fs::exists(journal_of(path)));
  expect_frames(path, 3);
  EXPECT_TRUE(read_info(path).complete);
  EXPECT_EQ(read_info(path).cost.evaluations, 7);
}

TEST_F(Synced, EndsWholeWithoutAnEnd) {
  auto const path = folder_ / "a.h5";
  begin(path, 2);
  EXPECT_FALSE(fs::exists(journal_of(path)));
  expect_frames(path, 2);
}

TEST_F(Synced, AnyReaderCompletesTheFile) {
  auto const info = half_written("info.h5", 4), spins = half_written("spins.h5", 4),
             other = half_written("other.h5", 4);
  EXPECT_EQ(read_info(info).frames, 4);
  EXPECT_EQ(read_spins(spins, small_header().shape), numbered_spins<double>(small_header(), 3));
  complete_file(other);
  for (auto const& path : {info, spins, other}) {
    EXPECT_FALSE(fs::exists(journal_of(path)));
    expect_frames(path, 4);
  }
}

TEST_F(Synced, ALinkLeadsToTheJournalOfItsFile) {
  auto const path = half_written("a.h5", 4);
  fs::create_directory(folder_ / "elsewhere");
  fs::create_symlink(path, folder_ / "elsewhere" / "link.h5");
  expect_frames(folder_ / "elsewhere" / "link.h5", 4);
  EXPECT_FALSE(fs::exists(journal_of(path)));
}

TEST_F(Synced, ReadersLeaveTheJournalToALivingWriter) {
  auto const path = folder_ / "a.h5";
  auto file = begin(path, 2);
  complete_file(path);
  EXPECT_TRUE(fs::exists(journal_of(path)));
  file.finish({});
  expect_frames(path, 2);
}

TEST_F(Synced, TheJournalOfAnotherFileIsLeftAlone) {
  auto const cut = half_written("cut.h5", 4), path = folder_ / "a.h5";
  write_frames(path, 2).finish({});
  fs::rename(journal_of(cut), journal_of(path));
  expect_frames(path, 2);
  EXPECT_TRUE(fs::exists(journal_of(path)));
  fs::rename(journal_of(path), journal_of(cut));
  expect_frames(cut, 4);
}

TEST_F(Synced, AJournalThatIsNotWholeIsNotNeeded) {
  auto const path = folder_ / "a.h5";
  write_frames(path, 2).finish({});
  write_bytes(journal_of(path), "half of something");
  expect_frames(path, 2);
  EXPECT_FALSE(fs::exists(journal_of(path)));
}

// Root may write any file, so as root the child becomes an ordinary user. It ends without exit
// handlers, since those of a sanitizer would need root's rights.
[[noreturn]] void read_without_rights(fs::path const& path) {
  if (::geteuid() == 0 && ::seteuid(65534) != 0) std::_Exit(1);
  try {
    read_info(path);
    std::_Exit(0);
  } catch (std::runtime_error const& error) {
    std::fputs(error.what(), stderr);
    std::_Exit(3);
  }
}

TEST_F(Synced, AFileThatCannotBeCompletedSaysSo) {
  auto const path = half_written("a.h5", 4);
  ::chmod(path.c_str(), 0444);
  EXPECT_EXIT(read_without_rights(path), testing::ExitedWithCode(3),
              "cannot complete the file from .*a.h5.journal: Permission denied$");
}

TEST_F(Synced, AFailedOverwriteCompletesTheOldFile) {
  auto const path = half_written("a.h5", 4);
  fs::create_directory(path.string() + ".partial");
  error_line(path, [&] { begin(path, 1, true); });
  expect_frames(path, 4);
}

}  // namespace
}  // namespace cayspin::inline v0_2::io
