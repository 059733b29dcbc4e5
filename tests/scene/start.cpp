// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "hdf5_file.hpp"
#include "io/ovf.hpp"
#include "scene_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <memory>
#include <numbers>

namespace cayspin::inline v0_2::io::test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

std::vector<double> start(std::string const& initial, std::string const& shape = "[4, 3, 2]") {
  return initial_spins(
      scene_of(llg_scene, {"lattice={shape=" + shape + "}", "initial=" + initial}));
}

std::string from(std::filesystem::path const& file) { return "{file='" + file.string() + "'}"; }

TEST(Start, UniformIsTheNormalisedVectorEverywhere) {
  auto const spins = start("{uniform=[3, 0, -4]}");
  ASSERT_EQ(spins.size(), 72U);
  for (std::size_t site = 0; site < 24; ++site) {
    EXPECT_EQ(spins[3 * site], 0.6);
    EXPECT_EQ(spins[3 * site + 1], 0);
    EXPECT_EQ(spins[3 * site + 2], -0.8);
  }
}

TEST(Start, NormalisesWithoutOverflowOrUnderflow) {
  for (std::string const scale : {"1e308", "8e307", "1e-307", "3e-308", "1e-308", "5e-324"}) {
    auto const spins = start("{uniform=[" + scale + ", 0, " + scale + "]}", "[1]");
    EXPECT_NEAR(spins[0], std::sqrt(0.5), 2 * eps) << scale;
    EXPECT_EQ(spins[0], spins[2]) << scale;
  }
}

TEST(Start, ExpressionsSeePositionAndIndexWithXFastest) {
  auto const spins = start(R"toml({expression=["1+i+10*x", "2+j+10*y", "3+k+10*z"]})toml");
  std::size_t at = 0;
  for (int k = 0; k < 2; ++k) {
    for (int j = 0; j < 3; ++j) {
      for (int i = 0; i < 4; ++i, at += 3) {
        Triple const m = {1 + i + 10 * (i + 0.5) / 4, 2 + j + 10 * (j + 0.5) / 3,
                          3 + k + 10 * (k + 0.5) / 2};
        double const norm = std::hypot(m[0], m[1], m[2]);
        for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(spins[at + c], m[c] / norm, 4 * eps);
      }
    }
  }
}

TEST(Start, ExpressionThatFailsNamesTheSiteAndTheLine) {
  auto const refused = [](std::string const& expressions) {
    auto const scene =
        scene_of(replaced(llg_scene, "uniform = [0.3, 0.5, 0.8]", "expression = " + expressions),
                 {"lattice={shape=[4, 3, 2]}"});
    return refusal([&] { initial_spins(scene); });
  };
  std::string const place = "scene.toml:19: initial.expression: ";
  EXPECT_EQ(refused("['i-2', 'j-1', 'k']"),
            place +
                "the spin of site (2, 1, 0) is (0, 0, 0); accepted: a finite vector that is "
                "not zero");
  EXPECT_EQ(refused("['1/(i-1)', '1', '1']"),
            place +
                "expression \"1/(i-1)\" is not finite at x = 0.375, y = 0.16666666666666666, "
                "z = 0.25, i = 1, j = 0, k = 0");
}

TEST(Start, RandomIsReproducibleAndFollowsTheSeed) {
  auto const first = start("{random={seed=1}}");
  EXPECT_EQ(first, start("{random={seed=1}}"));
  EXPECT_NE(first, start("{random={seed=2}}"));
  auto const longer = start("{random={seed=1}}", "[100]");
  EXPECT_TRUE(std::equal(first.begin(), first.end(), longer.begin()));
}

// With seed 0 the first value of SplitMix64 is 0xe220a8397b1dcdaf, published with the generator.
TEST(Start, RandomStartsFromThePublishedSequence) {
  double const u = std::ldexp(static_cast<double>(0xe220a8397b1dcdafULL >> 11U), -53);
  EXPECT_NEAR(start("{random={seed=0}}", "[1]")[2], 2 * u - 1, 2 * eps);
}

// On the sphere a component c has <c> = 0, <c^2> = 1/3, <c^4> = 1/5, and <c d> = 0, <c^2 d^2> =
// 1/15 with another component d. Means over n sites then scatter by sqrt(1/(3n)),
// sqrt((1/5 - 1/9)/n) and sqrt(1/(15n)); the bound is five times these.
TEST(Start, RandomIsUniformOnTheSphere) {
  constexpr std::size_t n = 100000;
  for (std::string const seed : {"1", "2", "3"}) {
    auto const spins = start("{random={seed=" + seed + "}}", "[100000]");
    double mean[3] = {};
    double second[3][3] = {};
    double neighbor = 0;
    for (std::size_t site = 0; site < n; ++site) {
      auto const* const m = spins.data() + 3 * site;
      EXPECT_NEAR(std::hypot(m[0], m[1], m[2]), 1, 4 * eps);
      for (int c = 0; c < 3; ++c) {
        mean[c] += m[c] / n;
        for (int d = 0; d < 3; ++d) second[c][d] += m[c] * m[d] / n;
        if (site > 0) neighbor += m[c] * m[c - 3] / n;
      }
    }
    for (int c = 0; c < 3; ++c) {
      EXPECT_LT(std::abs(mean[c]), 5 * std::sqrt(1.0 / (3 * n)));
      EXPECT_LT(std::abs(second[c][c] - 1.0 / 3), 5 * std::sqrt((1.0 / 5 - 1.0 / 9) / n));
      EXPECT_LT(std::abs(second[c][(c + 1) % 3]), 5 * std::sqrt(1.0 / (15 * n)));
    }
    EXPECT_LT(std::abs(neighbor), 5 * std::sqrt(1.0 / (3 * n)));
  }
}

TEST(Start, GivenNumbersAreThreeForEachSite) {
  auto scene = scene_of(llg_scene, {"lattice={shape=[4, 3, 2]}"});
  for (std::size_t const size : {0, 3, 71, 73, 144}) {
    scene.initial = GivenStart{std::make_shared<std::vector<double> const>(size, 1.0)};
    expect_holds(refusal([&] { initial_spins(scene); }),
                 ": initial.given: " + std::to_string(size) +
                     " numbers were given; accepted: 72, three for each site");
  }
  scene.initial = GivenStart{std::make_shared<std::vector<double> const>(72, 2.0)};
  EXPECT_NEAR(initial_spins(scene).at(71), std::sqrt(1.0 / 3), 2 * eps);
}

TEST(Start, FileComesBackNormalised) {
  Folder const folder;
  auto const spins = start("{random={seed=7}}");
  auto doubled = spins;
  for (auto& value : doubled) value *= 2;
  write_dataset(folder / "state.h5", "/spins", {2, 3, 4, 3}, doubled);
  auto const back = start(from(folder / "state.h5"));
  ASSERT_EQ(back.size(), spins.size());
  for (std::size_t n = 0; n < spins.size(); ++n) EXPECT_NEAR(back[n], spins[n], 2 * eps);
}

TEST(Start, FileOfFloatFramesGivesTheLastFrame) {
  Folder const folder;
  auto const last = start("{random={seed=7}}");
  auto frames = start("{random={seed=8}}");
  frames.insert(frames.end(), last.begin(), last.end());
  write_dataset(folder / "state.h5", "/spins", {2, 2, 3, 4, 3}, frames, H5T_IEEE_F32LE);
  auto const back = start(from(folder / "state.h5"));
  double const rounding = std::numeric_limits<float>::epsilon();
  for (std::size_t n = 0; n < last.size(); ++n) EXPECT_NEAR(back[n], last[n], rounding);
}

TEST(Start, OvfFileComesBackNormalised) {
  Folder const folder;
  auto const spins = start("{random={seed=7}}");
  OvfField field;
  field.mesh.nodes = {4, 3, 2};
  for (auto const value : spins) field.values.push_back(4 * value);
  for (auto const& [name, format] : words<OvfFormat>()) {
    write_ovf(folder / "state.ovf", field, format, true);
    auto const back = start(from(folder / "state.ovf"));
    double const rounding = format == OvfFormat::binary4 ? 1e-7 : 2 * eps;
    for (std::size_t n = 0; n < spins.size(); ++n) EXPECT_NEAR(back[n], spins[n], rounding) << name;
  }
}

TEST(Start, OvfFileOfVersion1IsRead) {
  Folder const folder;
  auto const spins = start("{random={seed=9}}");
  std::string text =
      "# OOMMF: rectangular mesh v1.0\n# Segment count: 1\n# Begin: Segment\n# Begin: Header\n"
      "# meshtype: rectangular\n# xnodes: 4\n# ynodes: 3\n# znodes: 2\n# valueunit: A/m\n"
      "# valuemultiplier: 8e5\n# End: Header\n# Begin: Data Text\n";
  for (auto const value : spins) text += fmt::format("{}\n", value);
  folder.write(text + "# End: Data Text\n# End: Segment\n", "old.omf");
  auto const back = start(from(folder / "old.omf"));
  for (std::size_t n = 0; n < spins.size(); ++n) EXPECT_NEAR(back[n], spins[n], 2 * eps);
}

// Spins from either kind of file are normalised, so the starts are equal.
TEST(Start, OvfAndHdf5FilesGiveTheSameBits) {
  Folder const folder;
  auto values = start("{random={seed=9}}");
  for (std::size_t n = 0; n < values.size(); ++n) values[n] *= 1 + 1e-9 * static_cast<double>(n);
  OvfField field;
  field.mesh.nodes = {4, 3, 2};
  field.values = values;
  write_dataset(folder / "state.h5", "/spins", {2, 3, 4, 3}, values);
  auto const expected = start(from(folder / "state.h5"));
  for (auto const format : {OvfFormat::text, OvfFormat::binary8}) {
    write_ovf(folder / "state.omf", field, format, true);
    EXPECT_EQ(start(from(folder / "state.omf")), expected);
  }
}

TEST(Start, WrongFilesAreRefusedInOneLine) {
  Folder const folder;
  std::vector<double> const spins(72, 1);
  auto zero = spins;
  zero[15] = zero[16] = zero[17] = 0;
  auto nan = spins;
  nan[71] = std::nan("");
  folder.write("text", "text.h5");
  std::filesystem::create_directory(folder / "folder.h5");
  write_dataset(folder / "other.h5", "/state", {2, 3, 4, 3}, spins);
  write_dataset(folder / "shape.h5", "/spins", {4, 3, 2, 3}, spins);
  write_dataset(folder / "flat.h5", "/spins", {72}, spins);
  write_dataset(folder / "empty.h5", "/spins", {0, 2, 3, 4, 3}, {});
  write_dataset(folder / "integer.h5", "/spins", {2, 3, 4, 3}, spins, H5T_STD_I32LE);
  write_dataset(folder / "zero.h5", "/spins", {2, 3, 4, 3}, zero);
  write_dataset(folder / "nan.h5", "/spins", {2, 3, 4, 3}, nan);
  OvfField field;
  field.mesh.nodes = {3, 4, 2};
  field.values = spins;
  write_ovf(folder / "shape.ovf", field, OvfFormat::binary8, false);
  field.mesh.nodes = {4, 3, 2};
  field.values = zero;
  write_ovf(folder / "zero.ovf", field, OvfFormat::text, false);
  std::filesystem::copy(folder / "zero.ovf", folder / "short.ovf");
  std::filesystem::resize_file(folder / "short.ovf",
                               std::filesystem::file_size(folder / "short.ovf") - 60);
  folder.write("# OOMMF: irregular mesh v1.0\n", "irregular.ovf");
  struct Case {
    std::string file;
    std::string message;
    bool seen_unread;  ///< check_files refuses it, too
  };
  for (auto const& wrong : std::vector<Case>{
           {"none.h5", "cannot open the file: No such file or directory", true},
           {"text.h5", "it is not an HDF5 file", true},
           {"folder.h5", "it is not a regular file", true},
           {"other.h5", "cannot read dataset /spins: it is not there", true},
           {"shape.h5",
            "dataset /spins: its extents are (4, 3, 2, 3); accepted: (2, 3, 4, 3) or "
            "(frame, 2, 3, 4, 3)",
            true},
           {"flat.h5", "dataset /spins: its extents are (72)", true},
           {"empty.h5", "dataset /spins: it holds no frame", true},
           {"integer.h5",
            "dataset /spins: its type is neither float nor double; accepted: float, double", true},
           {"none.ovf", "cannot open the file: No such file or directory", true},
           {"shape.ovf", "its mesh has 3 x 4 x 2 nodes; accepted: 4 x 3 x 2, the lattice's", true},
           {"irregular.ovf", "its mesh is irregular; accepted: a rectangular mesh", true},
           {"short.ovf", "it is truncated", false},
           {"zero.ovf", "the spin of site (1, 1, 0) is (0, 0, 0)", false},
           {"zero.h5", "the spin of site (1, 1, 0) is (0, 0, 0)", false},
           {"nan.h5", "the spin of site (3, 2, 1) is (1, 1, nan)", false}}) {
    auto const initial = from(folder / wrong.file);
    auto const scene = scene_of(llg_scene, {"lattice={shape=[4,3,2]}", "initial=" + initial});
    testing::internal::CaptureStderr();
    auto const message = refusal([&] { initial_spins(scene); });
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << wrong.file;
    EXPECT_TRUE(message.starts_with("--set initial=" + initial + ": initial.file: ")) << message;
    expect_holds(message, wrong.message);
    EXPECT_EQ(refusal([&] { check_files(scene); }) != "accepted", wrong.seen_unread) << wrong.file;
  }
}

}  // namespace
}  // namespace cayspin::inline v0_2::io::test
