// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// docs/reference/scene.md describes every key that a message lists as accepted.
#include "scene_file.hpp"
#include "wrong_scenes.hpp"

#include <cctype>
#include <fstream>
#include <set>
#include <sstream>
#include <utility>

namespace cayspin::inline v0_2::io::test {
namespace {

/// Returns the words of the page's code, which is between backticks.
std::set<std::string> words_of_code() {
  std::ostringstream page;
  page << std::ifstream(CAYSPIN_SCENE_PAGE).rdbuf();
  auto const pieces = split(page.str(), "`");
  std::set<std::string> words;
  for (std::size_t code = 1; code < pieces.size(); code += 2) {
    std::string word;
    for (char const c : pieces[code] + ' ')
      if (c == '_' || std::isalnum(static_cast<unsigned char>(c)) != 0)
        word += c;
      else if (!word.empty())
        words.insert(std::exchange(word, {}));
  }
  return words;
}

/// Returns the message that refuses a scene with this assignment; empty if there is none.
std::string said_of(std::string_view scene, std::string const& assignment) {
  try {
    parse_scene(std::string(scene), "scene.toml", {assignment});
  } catch (SceneError const& error) {
    return error.what();
  }
  return {};
}

TEST(AcceptedKeys, AreTheOnesOfThePage) {
  auto const described = words_of_code();
  for (std::string const assignment : {"nokey=1",
                                       "system.nokey=1",
                                       "system.damping={nokey=1}",
                                       "system.inertia={nokey=1}",
                                       "lattice.nokey=1",
                                       "lattice.occupied={nokey=1}",
                                       "lattice.frozen={nokey=1}",
                                       "field.nokey=1",
                                       "field.exchange={nokey=1}",
                                       "field.dmi={nokey=1}",
                                       "field.anisotropy={nokey=1}",
                                       "field.anisotropy={constant={nokey=1}}",
                                       "field.anisotropy=[{nokey=1}]",
                                       "field.slab_demag={nokey=1}",
                                       "field.demag={nokey=1}",
                                       "field.dipoles={nokey=1}",
                                       "field.couplings={nokey=1}",
                                       "field.couplings=[{nokey=1}]",
                                       "torque={nokey=1}",
                                       "torque={zhang_li={nokey=1}}",
                                       "torque={slonczewski={nokey=1}}",
                                       "initial={nokey=1}",
                                       "initial={nokey=1,uniform=[0,0,1]}",
                                       "initial={random={nokey=1}}",
                                       "initial={state='vortex',nokey=1}",
                                       "initial={state='bloch_skyrmion',nokey=1}",
                                       "initial={state='two_domains',nokey=1}",
                                       "initial={state='helix',nokey=1}",
                                       "integrator.nokey=1",
                                       "integrator.isotropy={nokey=1}",
                                       "thermal={nokey=1}",
                                       "output.nokey=1"}) {
    bool const is_of_bodies = assignment.starts_with("system.inertia");
    auto const message = said_of(is_of_bodies ? body_scene : llg_scene, assignment);
    EXPECT_NE(message.find("nokey: unknown key"), message.npos) << assignment << ": " << message;
    auto const at = message.find("; accepted: ");
    ASSERT_NE(at, message.npos) << message;
    for (auto const& key : split(message.substr(at + 12), ", ")) {
      EXPECT_NE(key, "given") << message;
      EXPECT_TRUE(described.contains(key)) << key << ": " << message;
    }
  }
}

// A message describes values that a program passes, because these have no key or file to name.
TEST(AcceptedKeys, ArraysWhereNoneIsTakenAreNamed) {
  Given given;
  given.numbers["output"] = std::make_shared<std::vector<double> const>(3, 1.0);
  try {
    parse_scene(std::string(llg_scene), "scene.toml", {"output.given=true"}, given);
    ADD_FAILURE();
  } catch (SceneError const& error) {
    std::string const message = error.what();
    EXPECT_NE(message.find("output: is an array of values per site; accepted: "), message.npos)
        << message;
  }
}

}  // namespace
}  // namespace cayspin::inline v0_2::io::test
