// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "trajectory/new_file.hpp"
#include "trajectory_test.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>

namespace cayspin::inline v0_2::io {
namespace {

namespace fs = std::filesystem;

TrajectoryFile create(fs::path const& path, bool overwrite = false) {
  return TrajectoryFile(path, small_header(), overwrite);
}

std::vector<std::string> names_in(fs::path const& folder) {
  std::vector<std::string> names;
  for (auto const& entry : fs::directory_iterator(folder))
    names.push_back(entry.path().filename().string());
  return names;
}

TEST_F(TrajectoryTest, ExistingFileIsKept) {
  auto const path = folder_ / "a.h5";
  write_bytes(path, "precious");
  auto const message = error_line(path, [&] { create(path); });
  EXPECT_TRUE(contains(message, "--overwrite"));
  EXPECT_EQ(read_bytes(path), "precious");
  EXPECT_EQ(names_in(folder_), std::vector<std::string>{"a.h5"});
}

TEST_F(TrajectoryTest, OverwriteReplacesTheFileAtOnce) {
  auto const path = folder_ / "a.h5";
  write_frames(path, 3).finish({});
  auto const file = create(path, true);
  EXPECT_EQ(names_in(folder_), std::vector<std::string>{"a.h5"});
}

TEST_F(TrajectoryTest, OverwrittenFileHoldsTheNewRun) {
  auto const path = folder_ / "a.h5";
  write_frames(path, 3).finish({});
  create(path, true).close({});
  auto const info = read_info(path);
  EXPECT_EQ(info.frames, 0);
  EXPECT_FALSE(info.complete);
}

TEST_F(TrajectoryTest, OverwriteFollowsALink) {
  auto const path = folder_ / "a.h5";
  auto const link = folder_ / "link.h5";
  write_bytes(path, "old");
  fs::create_symlink("a.h5", link);
  create(link, true).finish({});
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_TRUE(read_info(path).complete);
}

TEST_F(TrajectoryTest, CreationFollowsALinkToNoFile) {
  auto const link = folder_ / "link.h5";
  fs::create_symlink("other.h5", folder_ / "a.h5");
  fs::create_symlink("a.h5", link);
  create(link).finish({});
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(folder_ / "other.h5")));
  EXPECT_TRUE(read_info(link).complete);
}

TEST_F(TrajectoryTest, FileOfAnotherWriterIsKept) {
  auto const path = folder_ / "a.h5";
  write_bytes(path, "precious");
  int const writer = ::open(path.c_str(), O_RDWR);
  ASSERT_EQ(::flock(writer, LOCK_EX), 0);
  auto const message = error_line(path, [&] { create(path, true); });
  ::close(writer);
  EXPECT_TRUE(contains(message, "this program or another one has it open"));
  EXPECT_EQ(read_bytes(path), "precious");
  EXPECT_EQ(names_in(folder_), std::vector<std::string>{"a.h5"});
}

TEST_F(TrajectoryTest, MissingFolder) {
  auto const path = folder_ / "missing" / "a.h5";
  auto const message = error_line(path, [&] { create(path); });
  EXPECT_TRUE(contains(message, (folder_ / "missing").string() + " does not exist"));
  EXPECT_TRUE(names_in(folder_).empty());
}

TEST_F(TrajectoryTest, FolderThatIsAFile) {
  write_bytes(folder_ / "file", "");
  auto const path = folder_ / "file" / "a.h5";
  EXPECT_TRUE(contains(error_line(path, [&] { create(path); }), "is a file"));
}

TEST_F(TrajectoryTest, NameThatIsAFolderOrADevice) {
  EXPECT_TRUE(contains(error_line(folder_, [&] { create(folder_, true); }), "not a regular file"));
  fs::path const device = "/dev/full";
  EXPECT_TRUE(contains(error_line(device, [&] { create(device, true); }), "not a regular file"));
}

TEST_F(TrajectoryTest, NameTooLong) {
  auto const path = folder_ / std::string(300, 'a');
  EXPECT_TRUE(contains(error_line(path, [&] { create(path); }), "too long"));
}

// Root may write anywhere, so as root the child becomes an ordinary user. `withheld`: permissions
// that new files do not get.
int create_without_permission(fs::path const& path, mode_t withheld, bool overwrite) {
  if (::geteuid() == 0 && ::seteuid(65534) != 0) return 2;
  ::umask(withheld);
  auto const message = error_line(path, [&] { create(path, overwrite); });
  return contains(message, "cannot create the file: Permission denied") ? 0 : 1;
}

TEST_F(TrajectoryTest, NoPermission) {
  ASSERT_EQ(::chmod(folder_.c_str(), 0555), 0);
  EXPECT_EXIT(std::_Exit(create_without_permission(folder_ / "a.h5", 0, false)),
              testing::ExitedWithCode(0), "");
  EXPECT_TRUE(names_in(folder_).empty());
  ::chmod(folder_.c_str(), 0755);
}

TEST_F(TrajectoryTest, ProtectedFileIsKept) {
  auto const path = folder_ / "a.h5";
  write_bytes(path, "precious");
  ASSERT_EQ(::chmod(path.c_str(), 0444), 0);
  ASSERT_EQ(::chmod(folder_.c_str(), 0777), 0);
  EXPECT_EXIT(std::_Exit(create_without_permission(path, 0, true)), testing::ExitedWithCode(0), "");
  EXPECT_EQ(read_bytes(path), "precious");
  EXPECT_EQ(names_in(folder_), std::vector<std::string>{"a.h5"});
}

// The new file may be written but not read, and HDF5 has to read it.
TEST_F(TrajectoryTest, FileThatHdf5CannotOpenIsRemoved) {
  ASSERT_EQ(::chmod(folder_.c_str(), 0777), 0);
  EXPECT_EXIT(std::_Exit(create_without_permission(folder_ / "a.h5", 0444, false)),
              testing::ExitedWithCode(0), "");
  EXPECT_TRUE(names_in(folder_).empty());
}

TEST_F(TrajectoryTest, FileInTheMakingHasOneWriter) {
  auto const path = folder_ / "a.h5";
  NewFile first(path, false);
  EXPECT_TRUE(contains(error_line(path, [&] { NewFile(path, false); }),
                       "another program is writing " + path.string() + ".partial"));
  first.commit();
  EXPECT_EQ(names_in(folder_), std::vector<std::string>{"a.h5"});
}

TEST_F(TrajectoryTest, FileThatCameMeanwhileIsKept) {
  auto const path = folder_ / "a.h5";
  {
    NewFile file(path, false);
    write_bytes(path, "precious");
    EXPECT_TRUE(contains(error_line(path, [&] { file.commit(); }), "File exists"));
  }
  EXPECT_EQ(read_bytes(path), "precious");
  EXPECT_EQ(names_in(folder_), std::vector<std::string>{"a.h5"});
}

}  // namespace
}  // namespace cayspin::inline v0_2::io
