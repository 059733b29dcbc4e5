// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Shipped scenes, and small ones with the keys that these lack, with tokens deleted, swapped or
// replaced: each is read, or refused with one line.
// CAYSPIN_MUTATED_SCENES and CAYSPIN_SEED: number of scenes, and the seed.
#include "damaged_bytes.hpp"
#include "io/expression.hpp"
#include "io/scene.hpp"

#include <gtest/gtest.h>

#include <array>
#include <iostream>
#include <regex>
#include <vector>

namespace cayspin::inline v0_2::io {
namespace {

using cayspin::test::Chance;
using cayspin::test::number_from;

std::vector<std::string> tokens_of(std::string const& text) {
  static std::regex const token(R"([A-Za-z_]+|[0-9.eE+-]+|\s+|.)");
  std::vector<std::string> tokens;
  for (std::sregex_iterator it(text.begin(), text.end(), token), end; it != end; ++it)
    tokens.push_back(it->str());
  return tokens;
}

std::string mutated(std::vector<std::string> tokens, Chance& chance) {
  static constexpr std::array words{"0",    "-1",  "1e308", "nan",   "inf", "9223372036854775807",
                                    "\"\"", "[",   "]",     "{",     "\n",  "\"x/(x-x)\"",
                                    "true", "a.b", "=",     "1e-320"};
  for (auto left = 1 + chance.below(3); left > 0; --left) {
    auto const at = chance.below(tokens.size());
    switch (chance.below(3)) {
      case 0:
        tokens[at].clear();
        break;
      case 1:
        std::swap(tokens[at], tokens[chance.below(tokens.size())]);
        break;
      default:
        tokens[at] = words[chance.below(words.size())];
    }
  }
  std::string text;
  for (auto const& token : tokens) text += token;
  return text;
}

std::vector<std::filesystem::path> scenes_in(char const* folder) {
  std::vector<std::filesystem::path> paths;
  for (auto const& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".toml") paths.push_back(entry.path());
  std::ranges::sort(paths);
  return paths;
}

TEST(MutatedScenes, StartFromScenesThatAreAccepted) {
  auto const paths = scenes_in(CAYSPIN_SMALL_SCENES);
  EXPECT_FALSE(paths.empty());
  for (auto const& path : paths) {
    SCOPED_TRACE(path);
    auto const scene = parse_scene(cayspin::test::read_bytes(path), "scene.toml");
    check_files(scene);
    EXPECT_LE(sites(scene), 1000);
    EXPECT_EQ(std::ssize(initial_spins(scene)), 3 * sites(scene));
  }
}

TEST(MutatedScenes, AreReadOrRefusedWithOneLine) {
  std::vector<std::vector<std::string>> scenes;
  for (auto const& path : scenes_in(CAYSPIN_SMALL_SCENES))
    scenes.push_back(tokens_of(cayspin::test::read_bytes(path)));
  for (auto const& path : scenes_in(CAYSPIN_SCENES))
    for (std::string const stages :
         {"",
          "[[stage]]\nname = \"a\"\nrelax = true\nfield.applied = [1, 0, 0]\n[[stage]]\n"
          "system.damping = 0.2\n[stage.integrator]\nsteps = 3\n"})
      scenes.push_back(tokens_of(cayspin::test::read_bytes(path) + stages));
  ASSERT_FALSE(scenes.empty());
  Chance chance(static_cast<std::uint64_t>(number_from("CAYSPIN_SEED", 1)));
  int read = 0, refused = 0;
  for (long count = number_from("CAYSPIN_MUTATED_SCENES", 1500); count > 0; --count) {
    auto const text = mutated(scenes[chance.below(scenes.size())], chance);
    try {
      auto const scene = parse_scene(text, "scene.toml");
      check_files(scene);
      if (sites(scene) <= 1000) initial_spins(scene);
      ++read;
    } catch (SceneError const& error) {
      ++refused;
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << text;
      EXPECT_TRUE(std::string(error.what()).starts_with("scene.toml:")) << error.what();
    } catch (std::exception const& error) {
      ADD_FAILURE() << error.what() << " of\n" << text;
    }
  }
  std::cout << read << " read, " << refused << " refused\n";
  EXPECT_GT(read, 0);
  EXPECT_GT(refused, 0);
}

TEST(MutatedScenes, FormulaWithALineBreakIsRefusedWithOneLine) {
  try {
    Expression("1 +\n)", {"x"});
    FAIL() << "accepted";
  } catch (std::invalid_argument const& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace cayspin::inline v0_2::io
