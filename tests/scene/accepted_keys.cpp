// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// docs/reference/scene.md describes every key that a message lists as accepted.
#include "scene_file.hpp"
#include "wrong_scenes.hpp"

#include <fstream>
#include <sstream>

namespace cayspin::inline v0_2::io::test {
namespace {

std::string page() {
  std::ostringstream text;
  text << std::ifstream(CAYSPIN_SCENE_PAGE).rdbuf();
  return text.str();
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
  auto const described = page();
  int lists = 0;
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
                                       "field.dmi=[{nokey=1}]",
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
    auto const message = said_of(llg_scene, assignment);
    EXPECT_FALSE(message.empty()) << assignment;
    if (message.find("unknown key") == message.npos) continue;
    auto const at = message.find("; accepted: ");
    ASSERT_NE(at, message.npos) << message;
    ++lists;
    for (auto const& key : split(message.substr(at + 12), ", ")) {
      EXPECT_NE(key, "given") << message;
      EXPECT_NE(described.find(key), described.npos) << key << ": " << message;
    }
  }
  EXPECT_GE(lists, 15);
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
