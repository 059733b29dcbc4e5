// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "hdf5/real_dataset.hpp"
#include "trajectory_test.hpp"

namespace cayspin::inline v0_2::io {
namespace {

template <class Real>
class RoundTrip : public TrajectoryTest {
 public:
  std::string precision() const { return sizeof(Real) == 4 ? "single" : "double"; }
};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(RoundTrip, Precisions);

TYPED_TEST(RoundTrip, LastFrameKeepsItsBits) {
  auto const path = this->folder_ / "a.h5";
  auto const header = small_header(this->precision());
  TrajectoryFile file(path, header, false);
  for (int frame = 0; frame < 3; ++frame)
    file.write_frame(frame, 0.1 * frame, numbered_scalars(frame),
                     numbered_spins<TypeParam>(header, frame).data());
  file.finish({});

  auto const written = numbered_spins<TypeParam>(header, 2);
  EXPECT_EQ(read_spins(path, header.shape), std::vector<double>(written.begin(), written.end()));
}

TYPED_TEST(RoundTrip, InfoGivesHeaderAndFrames) {
  auto const path = this->folder_ / "a.h5";
  auto header = small_header(this->precision());
  header.resolved_scene = header.scene_text + "# resolved\n";
  header.units = {true, 5e-12, 4e-9, 1.25, 3e-20};
  TrajectoryFile file(path, header, false);
  std::vector<TypeParam> const spins = numbered_spins<TypeParam>(header, 0);
  for (int frame = 0; frame < 3; ++frame) {
    for (int sample = 0; sample < 5; ++sample)
      file.write_scalars(100 * frame + 20 * sample, frame + 0.2 * sample, numbered_scalars(frame));
    file.write_frame(100 * frame, 1.0 / 3 * frame, numbered_scalars(frame), spins.data());
  }
  EXPECT_EQ(file.frames(), 3);
  EXPECT_EQ(file.path(), path);
  file.finish({12345, 2.5, 1.25});

  auto const info = read_info(path);
  EXPECT_EQ(info.path, path);
  EXPECT_EQ(info.format, 1);
  EXPECT_EQ(info.header.scene_text, header.scene_text);
  EXPECT_EQ(info.header.resolved_scene, header.resolved_scene);
  EXPECT_EQ(info.header.cayspin_version, header.cayspin_version);
  EXPECT_EQ(info.header.git_commit, header.git_commit);
  EXPECT_EQ(info.header.kokkos_version, header.kokkos_version);
  EXPECT_EQ(info.header.space, header.space);
  EXPECT_EQ(info.header.threads, header.threads);
  EXPECT_EQ(info.header.precision, header.precision);
  EXPECT_EQ(info.header.shape, header.shape);
  EXPECT_EQ(info.header.units, header.units);
  EXPECT_EQ(info.cost.evaluations, 12345);
  EXPECT_EQ(info.cost.wall_seconds, 2.5);
  EXPECT_EQ(info.cost.step_seconds, 1.25);
  EXPECT_TRUE(info.complete);
  EXPECT_EQ(info.frames, 3);
  EXPECT_EQ(info.samples, 15);
  EXPECT_EQ(info.frame_steps, (std::vector<std::int64_t>{0, 100, 200}));
  EXPECT_EQ(info.frame_times, (std::vector<double>{0, 1.0 / 3, 1.0 / 3 * 2}));
  for (int frame = 0; frame < 3; ++frame) {
    auto const expected = numbered_scalars(frame);
    EXPECT_EQ(info.frame_scalars[frame].energy, expected.energy);
    EXPECT_EQ(info.frame_scalars[frame].norm_defect, expected.norm_defect);
    EXPECT_EQ(info.frame_scalars[frame].magnetization, expected.magnetization);
  }
}

TYPED_TEST(RoundTrip, OtherPrecisionIsRefused) {
  auto const header = small_header(this->precision());
  TrajectoryFile file(this->folder_ / "a.h5", header, false);
  using Other = std::conditional_t<sizeof(TypeParam) == 4, double, float>;
  auto const spins = numbered_spins<Other>(header, 0);
  EXPECT_THROW(file.write_frame(0, 0, {}, spins.data()), std::logic_error);
  EXPECT_EQ(file.frames(), 0);
}

// These are more samples than one chunk holds, and more than may wait in memory.
TEST_F(TrajectoryTest, ManySamples) {
  auto const path = folder_ / "a.h5";
  TrajectoryFile file(path, small_header(), false);
  for (int sample = 0; sample < 2000; ++sample)
    file.write_scalars(sample, 0.5 * sample, numbered_scalars(sample));
  file.finish({});
  EXPECT_EQ(read_info(path).samples, 2000);
  RealDataset const energy(path, "/scalars/energy");
  RealDataset const magnetization(path, "/scalars/magnetization");
  ASSERT_EQ(energy.extents(), (Extents{2000}));
  ASSERT_EQ(magnetization.extents(), (Extents{2000, 3}));
  auto const energies = energy.read();
  auto const means = magnetization.read();
  for (int sample = 0; sample < 2000; ++sample) {
    ASSERT_EQ(energies[sample], numbered_scalars(sample).energy);
    ASSERT_EQ(means[3 * sample], numbered_scalars(sample).magnetization[0]);
  }
}

}  // namespace
}  // namespace cayspin::inline v0_2::io
