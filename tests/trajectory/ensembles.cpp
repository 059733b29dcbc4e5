// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The file of an ensemble whose last frame is half written, or which another process is writing.
#include "hdf5/dataset.hpp"
#include "hdf5/error.hpp"
#include "hdf5/handle.hpp"
#include "io/ensemble_file.hpp"
#include "trajectory_test.hpp"

#include <sys/wait.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <iterator>
#include <span>
#include <thread>

namespace cayspin::inline v0_2::io {
namespace {

namespace fs = std::filesystem;

constexpr int replicas = 3;
constexpr char const* names_of_series[] = {"time", "step", "energy", "norm_defect",
                                           "magnetization"};

EnsembleFile write_ensemble(fs::path const& path, int frames) {
  Ensemble ensemble;
  ensemble.replicas = replicas;
  EnsembleFile file(path, small_header(), ensemble, {.overwrite = true});
  for (int frame = 0; frame < frames; ++frame) {
    std::vector<std::byte> all;
    for (int replica = 0; replica < replicas; ++replica) {
      auto const spins = numbered_spins<double>(small_header(), 10 * frame + replica);
      std::ranges::copy(std::as_bytes(std::span(spins)), std::back_inserter(all));
    }
    std::vector<Scalars> const scalars(replicas, numbered_scalars(frame));
    file.write_scalars(10 * frame, frame, scalars);
    file.write_frame(10 * frame, frame, scalars, all);
  }
  return file;
}

// Sets the number of rows of a dataset without writing any numbers, as a kill may leave it.
void set_rows(fs::path const& path, std::string const& name, hsize_t rows) {
  QuietErrors const quiet;
  FileHandle const file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT));
  ASSERT_GE(file.get(), 0);
  grow(open_dataset(file.get(), name.c_str(), path).get(), rows, path);
}

TEST_F(TrajectoryTest, AFrameOfAnEnsembleCountsOnceAllDatasetsHaveIt) {
  auto const path = folder_ / "all.h5";
  for (std::string const name : names_of_series) {
    SCOPED_TRACE(name);
    write_ensemble(path, 3).finish({});
    EXPECT_EQ(read_ensemble_info(path).frames, 3);
    set_rows(path, name, 2);
    set_rows(path, "scalars/" + name, 1);
    auto const info = read_ensemble_info(path);
    EXPECT_EQ(info.frames, 2);
    EXPECT_EQ(info.samples, 1);
    EXPECT_EQ(info.step, 10);
    EXPECT_EQ(info.time, 1);
    EXPECT_EQ(info.last.at(2).energy, numbered_scalars(1).energy);
    EXPECT_EQ(read_ensemble_spins(path, info, {2, 1}), numbered_spins<double>(small_header(), 12));
  }
}

TEST_F(TrajectoryTest, AFrameOfAnEnsembleWithoutItsNumbersDoesNotCount) {
  auto const path = folder_ / "all.h5";
  write_ensemble(path, 3).finish({});
  set_rows(path, "spins", 4);
  for (std::string const name : names_of_series) {
    set_rows(path, name, 4);
    set_rows(path, "scalars/" + name, 4);
  }
  auto const info = read_ensemble_info(path);
  EXPECT_EQ(info.frames, 3);
  EXPECT_EQ(info.samples, 3);
  EXPECT_EQ(info.step, 20);
  EXPECT_EQ(read_ensemble_spins(path, info, {0, 1}), numbered_spins<double>(small_header(), 20));
}

TEST_F(TrajectoryTest, SamplesOfAKilledEnsembleAreInTheFile) {
  auto const path = folder_ / "all.h5";
  auto const writer = ::fork();
  if (writer == 0) {
    Ensemble ensemble;
    ensemble.replicas = replicas;
    EnsembleFile file(path, small_header(), ensemble, {});
    for (int sample = 0; sample < 150; ++sample) {
      file.write_scalars(sample, sample, std::vector<Scalars>(replicas, numbered_scalars(sample)));
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    ::raise(SIGKILL);
  }
  ::waitpid(writer, nullptr, 0);
  EXPECT_GT(read_ensemble_info(path).samples, 1);
}

TEST_F(TrajectoryTest, AnEnsembleIsReadWhileAnotherProcessWritesIt) {
  auto const path = folder_ / "all.h5", trajectory = folder_ / "a.h5";
  write_frames(trajectory, 1).finish({});
  EXPECT_FALSE(read_ensemble_info_while_written(trajectory).has_value());
  int written[2] = {}, ended[2] = {};
  ASSERT_EQ(::pipe(written), 0);
  ASSERT_EQ(::pipe(ended), 0);
  auto const writer = ::fork();
  char byte = 0;
  if (writer == 0) {
    ::close(ended[1]);
    auto file = write_ensemble(path, 2);
    [[maybe_unused]] auto const told = ::write(written[1], &byte, 1);
    [[maybe_unused]] auto const heard = ::read(ended[0], &byte, 1);  // until the test closes it
    file.finish({});
    ::_exit(0);
  }
  ::close(written[1]);
  EXPECT_EQ(::read(written[0], &byte, 1), 1);
  EXPECT_EQ(is_being_written(path), true);
  EXPECT_THROW(read_ensemble_info(path), std::runtime_error);  // it would need a lock
  auto const info = read_ensemble_info_while_written(path);
  ::close(ended[1]);
  ::waitpid(writer, nullptr, 0);
  ASSERT_TRUE(info.has_value());
  EXPECT_FALSE(info->complete);
  EXPECT_EQ(info->frames, 2);
  EXPECT_EQ(info->samples, 2);
  EXPECT_EQ(info->step, 10);
  EXPECT_EQ(info->last.at(1).magnetization, numbered_scalars(1).magnetization);
  EXPECT_TRUE(read_ensemble_info(path).complete);
}

}  // namespace
}  // namespace cayspin::inline v0_2::io
