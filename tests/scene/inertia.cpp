// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "hdf5_file.hpp"
#include "scene_file.hpp"

#include <algorithm>

namespace cayspin::inline v0_2::io::test {
namespace {

constexpr InertiaTensor tensor = {2, 0.5, 0.25, 0.5, 3, -0.125, 0.25, -0.125, 4};

// Expects the product of a tensor and its inverse, given as xx, yy, zz, xy, xz, yz, to be the
// identity.
void expect_inverse(InertiaTensor const& a, std::array<double, 6> const& b) {
  std::array<double, 9> const full = {b[0], b[3], b[4], b[3], b[1], b[5], b[4], b[5], b[2]};
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column) {
      double sum = 0;
      for (std::size_t n = 0; n < 3; ++n) sum += a[3 * row + n] * full[3 * n + column];
      EXPECT_NEAR(sum, row == column ? 1 : 0, 1e-14);
    }
  }
}

TEST(Inertia, PrincipalMomentsAreADiagonalTensor) {
  auto const scene = scene_of(body_scene, {"system.inertia=[1, 2, 4]"});
  EXPECT_EQ(inertia(scene), (std::vector<InertiaTensor>{{1, 0, 0, 0, 2, 0, 0, 0, 4}}));
  EXPECT_EQ(inverse_inertia(scene), (std::vector<std::array<double, 6>>{{1, 0.5, 0.25, 0, 0, 0}}));
}

TEST(Inertia, TensorIsInverted) {
  auto const scene =
      scene_of(body_scene, {"system.inertia=[[2,0.5,0.25],[0.5,3,-0.125],[0.25,-0.125,4]]"});
  EXPECT_EQ(inertia(scene), std::vector<InertiaTensor>{tensor});
  auto const inverses = inverse_inertia(scene);
  ASSERT_EQ(inverses.size(), 1U);
  expect_inverse(tensor, inverses[0]);
}

std::vector<double> five_tensors() {
  std::vector<double> values;
  for (int body = 0; body < 5; ++body) {
    for (auto const entry : tensor) values.push_back(entry * (body + 1));
  }
  return values;
}

TEST(Inertia, FileGivesEachBodyItsOwn) {
  Folder const folder;
  write_dataset(folder / "i.h5", "/inertia", {5, 3, 3}, five_tensors());
  auto const scene = read_text(folder, body_scene, {"system.inertia={file=\"i.h5\"}"});
  check_files(scene);
  auto const tensors = inertia(scene);
  auto const inverses = inverse_inertia(scene);
  ASSERT_EQ(tensors.size(), 5U);
  ASSERT_EQ(inverses.size(), 5U);
  for (std::size_t body = 0; body < 5; ++body) {
    EXPECT_EQ(tensors[body][4], 3.0 * static_cast<double>(body + 1));
    expect_inverse(tensors[body], inverses[body]);
  }
}

TEST(Inertia, WrongFilesAreRefusedInOneLine) {
  Folder const folder;
  auto bent = five_tensors();
  bent[9 * 3 + 1] += 0.01;
  auto negative = five_tensors();
  negative[9 * 2] = -1;
  auto infinite = five_tensors();
  infinite[9] = 1 / 0.0;
  write_dataset(folder / "shape.h5", "/inertia", {5, 9}, five_tensors());
  write_dataset(folder / "count.h5", "/inertia", {1, 3, 3}, {tensor.begin(), tensor.end()});
  write_dataset(folder / "name.h5", "/moments", {5, 3, 3}, five_tensors());
  write_dataset(folder / "bent.h5", "/inertia", {5, 3, 3}, bent);
  write_dataset(folder / "negative.h5", "/inertia", {5, 3, 3}, negative);
  write_dataset(folder / "infinite.h5", "/inertia", {5, 3, 3}, infinite);
  struct Case {
    std::string file;
    std::string message;
    bool seen_unread;  ///< check_files refuses it, too
  };
  for (auto const& wrong : std::vector<Case>{
           {"none.h5", "cannot open the file: No such file or directory", true},
           {"shape.h5", "dataset /inertia: its extents are (5, 9); accepted: (5, 3, 3)", true},
           {"count.h5", "dataset /inertia: its extents are (1, 3, 3); accepted: (5, 3, 3)", true},
           {"name.h5", "cannot read dataset /inertia: it is not there", true},
           {"bent.h5", "body 3: the tensor is not symmetric", false},
           {"negative.h5", "body 2: the tensor is not positive definite", false},
           {"infinite.h5", "body 1: the tensor is not finite", false}}) {
    auto const assignment = "system.inertia={file='" + (folder / wrong.file).string() + "'}";
    auto const scene = scene_of(body_scene, {assignment});
    auto const message = refusal([&] { inverse_inertia(scene); });
    EXPECT_TRUE(message.starts_with("--set " + assignment + ": system.inertia.file: ")) << message;
    EXPECT_TRUE(message.ends_with(wrong.message)) << message;
    EXPECT_EQ(refusal([&] { check_files(scene); }), wrong.seen_unread ? message : "accepted");
  }
}

}  // namespace
}  // namespace cayspin::inline v0_2::io::test
