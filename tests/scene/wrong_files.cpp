// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "scene_file.hpp"

namespace cayspin::inline v0_1::io::test {
namespace {

TEST(SceneFile, ThatDoesNotExistIsNamed) {
  Folder const folder;
  auto const message = refusal(folder / "none.toml");
  ASSERT_TRUE(message);
  EXPECT_EQ(*message,
            (folder / "none.toml").string() +
                ": cannot be read: No such file or directory; accepted: a readable TOML file");
}

TEST(SceneFile, MayNotBeAFolder) {
  Folder const folder;
  auto const message = refusal(folder / "");
  ASSERT_TRUE(message);
  EXPECT_NE(message->find("is a folder"), std::string::npos) << *message;
}

TEST(SceneFile, MayNotBeEndless) {
  EXPECT_EQ(refusal("/dev/zero"),
            "/dev/zero: is larger than 16 MiB; accepted: a readable TOML file");
}

TEST(SceneFile, EmptyMissesItsFirstTable) {
  Folder const folder;
  auto const path = folder.write("");
  EXPECT_EQ(refusal(path), path.string() + ":1: system: is missing; accepted: a table [system]");
}

TEST(SceneFile, ErrorFoundLaterPointsAtItsKey) {
  Folder const folder;
  auto const scene = read_text(folder, llg_scene);
  auto const path = scene.path.string();
  EXPECT_EQ(scene_error(scene, "lattice.shape", "too large").what(),
            path + ":7: lattice.shape: too large");
  EXPECT_EQ(scene_error(scene, "lattice.shape[1]", "too large").what(),
            path + ":7: lattice.shape[1]: too large");
  EXPECT_STREQ(scene_error(scene, "output.scalars_every", "no").what(),
               (path + ":29: output.scalars_every: no").c_str());
  EXPECT_STREQ(scene_error(scene, "nowhere", "no").what(), (path + ":1: nowhere: no").c_str());
}

}  // namespace
}  // namespace cayspin::inline v0_1::io::test
