// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Values that samples have in addition to their scalars: those of regions and terms, and the shift.
#include "hdf5/attribute.hpp"
#include "hdf5/dataset.hpp"
#include "hdf5/handle.hpp"
#include "io/run_output.hpp"
#include "trajectory/scalar_series.hpp"
#include "trajectory_test.hpp"

#include <algorithm>
#include <fstream>
#include <numeric>
#include <string>
#include <vector>

namespace cayspin::inline v0_2::io {
namespace {

MoreScalars const all{.regions = 2, .terms = {"exchange", "applied", "z"}, .shift = true};

std::vector<double> numbers_at(std::int64_t step, std::size_t count) {
  std::vector<double> numbers(count);
  for (std::size_t i = 0; i < count; ++i)
    numbers[i] = static_cast<double>(step) + 0.125 * static_cast<double>(i);
  numbers.back() = static_cast<double>(-step);  // the shift, a whole number
  return numbers;
}

std::vector<double> values_of(hid_t group, char const* name, std::filesystem::path const& path) {
  auto const dataset = open_dataset(group, name, path);
  auto const extents = dataset_extents(dataset.get(), path);
  std::vector<double> values(elements(extents));
  read_block(dataset.get(), H5T_NATIVE_DOUBLE, Extents(extents.size(), 0), extents, values.data(),
             path);
  return values;
}

TEST_F(TrajectoryTest, MoreScalarsAreReadBack) {
  auto const path = folder_ / "a.h5";
  auto header = small_header();
  header.more = all;
  RunOutput output(path, header, {.table = true});
  constexpr std::int64_t samples = 1300;  // more than one write takes
  for (std::int64_t step = 0; step < samples; ++step)
    output.write_scalars(step, 0.5, numbered_scalars(1), numbers_at(step, all.count()));
  std::ranges::copy(numbered_spins<double>(header, 0), output.frame<double>());
  output.write_frame(samples, 0.5, numbered_scalars(0), {.shift = -7});
  output.finish({});

  auto const info = read_info(path);
  EXPECT_EQ(info.header.more.regions, 2);
  EXPECT_EQ(info.header.more.terms, all.terms);
  EXPECT_TRUE(info.header.more.shift);
  EXPECT_EQ(info.samples, samples);
  EXPECT_EQ(info.more_of_last_sample, numbers_at(samples - 1, all.count()));
  auto const file = open_file(path);
  GroupHandle const group(H5Gopen2(file.get(), "scalars", H5P_DEFAULT));
  auto const series = ScalarSeries::open(group.get(), path);
  EXPECT_EQ(series.more_count(), 12u);
  for (std::int64_t step : {0, 511, 512, 1299})
    EXPECT_EQ(series.read_more(step, step + 1, path), numbers_at(step, all.count())) << step;
  EXPECT_EQ(series.read(0, samples, path).size(), 1300u);

  auto const means = values_of(group.get(), "region_magnetization", path),
             energies = values_of(group.get(), "region_energy", path),
             terms = values_of(group.get(), "term_energy", path);
  EXPECT_EQ(means.size(), 6u * samples);
  EXPECT_EQ(means[6 * 3 + 4], 3.5);
  EXPECT_EQ(energies[2 * 3 + 1], 3.875);
  EXPECT_EQ(terms[3 * 3 + 2], 4.25);
  EXPECT_EQ(values_of(group.get(), "shift", path)[3], -3);
  EXPECT_EQ(values_of(file.get(), "shift", path), std::vector<double>{-7});

  std::ifstream stream(folder_ / "a.txt");
  std::string line;
  std::getline(stream, line);
  EXPECT_TRUE(contains(line,
                       "\tnorm_defect ()\tmx_region0 ()\tmy_region0 ()\tmz_region0 ()\t"
                       "mx_region1 ()\tmy_region1 ()\tmz_region1 ()\tE_region0 ()\t"
                       "E_region1 ()\tE_exchange ()\tE_applied ()\tE_z ()\tshift (cells)"));
  std::getline(stream, line);
  EXPECT_EQ(std::ranges::count(line, '\t'), 17);
  EXPECT_TRUE(line.ends_with("\t1.25\t0"));
}

TEST_F(TrajectoryTest, FramesOfRunsInStagesThatFollowHaveBoth) {
  auto const path = folder_ / "a.h5";
  auto header = small_header();
  header.more = {.shift = true};
  header.stage = StageBegin{};
  RunOutput output(path, header, {});
  for (std::int64_t frame = 0; frame < 3; ++frame) {
    output.write_scalars(frame, 0.5, numbered_scalars(1), {static_cast<double>(frame)});
    std::ranges::copy(numbered_spins<double>(header, 0), output.frame<double>());
    output.write_frame(frame, 0.5, numbered_scalars(0), {.shift = 7 - 5 * frame, .stage = frame});
  }
  output.finish({});
  auto const info = read_info(path);
  EXPECT_EQ(info.frame_shifts, (std::vector<std::int64_t>{7, 2, -3}));
  EXPECT_EQ(info.frame_stages, (std::vector<std::int64_t>{0, 1, 2}));
  EXPECT_EQ(info.header.more.count(), 1u);
  auto const file = open_file(path);
  GroupHandle const group(H5Gopen2(file.get(), "scalars", H5P_DEFAULT));
  EXPECT_EQ(H5Lexists(group.get(), "stage", H5P_DEFAULT), 0);
}

TEST_F(TrajectoryTest, AChangedNumberOfARegionIsNoticed) {
  auto const path = folder_ / "a.h5";
  auto header = small_header();
  header.more = {.regions = 2};
  TrajectoryFile file(path, header, false);
  auto const numbers = numbers_at(5, 8);
  file.write_scalars(5, 0.5, numbered_scalars(1), numbers);
  EXPECT_THROW(file.write_scalars(6, 0.5, numbered_scalars(1)), std::logic_error);
  file.finish({});
  auto const place = read_bytes(path).find(bytes_of(numbers[1]));
  ASSERT_NE(place, std::string::npos);
  overwrite(path, place, "\1");
  EXPECT_TRUE(contains(error_line(path, [&] { read_info(path); }), "its checksum differs"));
}

TEST_F(TrajectoryTest, FilesWithoutThemHaveNoSuchDatasets) {
  auto const path = folder_ / "a.h5";
  write_frames(path, 2).finish({});
  auto const info = read_info(path);
  EXPECT_EQ(info.header.more.count(), 0u);
  EXPECT_FALSE(info.last_sample);
  auto const file = open_file(path);
  EXPECT_EQ(H5Lexists(file.get(), "shift", H5P_DEFAULT), 0);
}

}  // namespace
}  // namespace cayspin::inline v0_2::io
