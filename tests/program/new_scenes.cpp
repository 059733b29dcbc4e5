// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The first commands of a new user: a scene, its check, a run, a picture.
#include "program_test.hpp"

#include <cstdlib>
#include <fstream>
#include <sstream>

namespace cayspin::program::test {
namespace {

class NewScenes : public ProgramTest {
 protected:
  std::string text_of(std::string const& name) const {
    std::ifstream file(in_folder(name));
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
  }
};

TEST_F(NewScenes, OfEveryKindAreCommentedAndValid) {
  for (std::string const kind : {"film", "chain", "crystal", "bodies", "standard_problem"}) {
    SCOPED_TRACE(kind);
    auto const outcome = start({"new", kind});
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    EXPECT_TRUE(contains(outcome.output, "cayspin run " + kind + ".toml"));
    auto const text = text_of(kind + ".toml");
    EXPECT_TRUE(text.starts_with("# "));
    EXPECT_EQ(text.find("scenes/"), std::string::npos) << text;
    EXPECT_EQ(start({"check", kind + ".toml"}).status, 0);
  }
}

TEST_F(NewScenes, ReplaceNoFileUnasked) {
  write("film.toml", "mine");
  auto const outcome = start({"new", "film"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_TRUE(is_one_line(outcome.errors));
  EXPECT_TRUE(outcome.errors.starts_with("film.toml: "));
  EXPECT_EQ(text_of("film.toml"), "mine");
  EXPECT_EQ(start({"new", "film", "--output", "other.toml"}).status, 0);
  EXPECT_EQ(start({"new", "film", "--overwrite"}).status, 0);
  EXPECT_EQ(text_of("film.toml"), text_of("other.toml"));
}

TEST_F(NewScenes, OfAnUnknownKindAreRefused) {
  auto const outcome = start({"new", "novel"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.errors,
            "cayspin: new novel: accepted: film, chain, crystal, bodies, standard_problem\n");
  EXPECT_FALSE(std::filesystem::exists(in_folder("novel.toml")));
}

#if !defined(CAYSPIN_HOST_DEVICE)
TEST_F(NewScenes, TakeTwoCommandsToAPicture) {
  start({"new", "film"});
  EXPECT_EQ(start({"run", "film.toml", "--quiet"}).status, 0);
  auto const outcome = start({"plot", "film.h5"});
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_EQ(text_of("film_texture.png").substr(0, 8), "\x89PNG\r\n\x1a\n");
  auto const wrong = start({"plot", "film.toml"});
  EXPECT_EQ(wrong.status, 2);
  EXPECT_TRUE(is_one_line(wrong.errors));
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
