// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The first commands of a new user: writing a scene, checking it, running it, and drawing a
// picture.
#include "io/scene.hpp"
#include "program_test.hpp"

#include <cstdlib>

namespace cayspin::program::test {
namespace {

using NewScenes = ProgramTest;

TEST_F(NewScenes, OfEveryKindAreCommentedAndValid) {
  for (std::string const kind : {"film", "chain", "crystal", "bodies", "standard_problem"}) {
    SCOPED_TRACE(kind);
    std::filesystem::remove(in_folder(kind + ".toml"));
    EXPECT_TRUE(contains(output_of({"new", kind}), "cayspin run " + kind + ".toml"));
    auto const text = text_of(kind + ".toml");
    EXPECT_TRUE(text.starts_with("# "));
    EXPECT_EQ(text.find("scenes/"), std::string::npos) << text;
    EXPECT_TRUE(contains(text, "file = \"" + kind + ".h5\"")) << text;
    output_of({"check", kind + ".toml"});
  }
}

TEST_F(NewScenes, ReplaceNoFileUnasked) {
  write("film.toml", "mine");
  auto const outcome = expect_status(2, {"new", "film"});
  EXPECT_TRUE(outcome.errors.starts_with("film.toml: "));
  EXPECT_EQ(text_of("film.toml"), "mine");
  output_of({"new", "film", "--output", "other.toml"});
  output_of({"new", "film", "--overwrite"});
  EXPECT_TRUE(contains(text_of("other.toml"), "file = \"other.h5\""));
  EXPECT_TRUE(contains(text_of("film.toml"), "file = \"film.h5\""));
}

TEST_F(NewScenes, CanHaveAnyName) {
  for (std::string const name : {"my \"best\" film", "two\\new", "a 'b' \"c\""}) {
    SCOPED_TRACE(name);
    output_of({"new", "film", "--output", name + ".toml"});
    EXPECT_EQ(io::read_scene(in_folder(name + ".toml")).output.file, name + ".h5");
    output_of({"check", name + ".toml"});
  }
}

TEST_F(NewScenes, OfAnUnknownKindAreRefused) {
  auto const outcome = start({"new", "novel"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.errors,
            "cayspin: new novel: accepted: film, chain, crystal, bodies, standard_problem\n");
  EXPECT_FALSE(exists("novel.toml"));
}

#if !defined(CAYSPIN_HOST_DEVICE)
TEST_F(NewScenes, TakeTwoCommandsToAPicture) {
  output_of({"new", "film"});
  output_of({"run", "film.toml", "--quiet"});
  EXPECT_EQ(start({"plot", "film.h5"}).status, 0);
  EXPECT_EQ(text_of("film_texture.png").substr(0, 8), "\x89PNG\r\n\x1a\n");
  expect_status(2, {"plot", "film.toml"});
}
#endif

TEST_F(NewScenes, SayWhichPythonPicturesNeed) {
  ASSERT_EQ(::setenv("CAYSPIN_PYTHON", "/nowhere/python3", 1), 0);
  auto const outcome = start({"plot", "film.h5"});
  ASSERT_EQ(::unsetenv("CAYSPIN_PYTHON"), 0);
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.errors,
            "cayspin: /nowhere/python3: cannot be started: No such file or directory; accepted: a "
            "Python with h5py and matplotlib in CAYSPIN_PYTHON\n");
}

}  // namespace
}  // namespace cayspin::program::test
