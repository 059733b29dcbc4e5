// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// A run whose keys are changed continues from its state like a restarted run of the changed scene.
#include "scenes_of_text.hpp"
#include "simulation/failure.hpp"

#include <array>
#include <filesystem>

namespace cayspin::simulation::test {
namespace {

namespace fs = std::filesystem;

std::string const film = R"([lattice]
shape = [9, 4]
[field]
exchange = 1.0
applied = [0.3, "0.1*t", 0]
[initial]
random = { seed = 7 }
)";

TEST(Changing, GoesOnAsAnotherSceneFromThatState) {
  auto const file = fs::path(testing::TempDir()) / fmt::format("changing_{}.h5", ::getpid());
  std::vector<std::string> const changes{"system.damping=0.7", "field.exchange=2.5",
                                         "field.applied=[0,0.2,0.1]"};
  for (auto const precision : precisions)
    for (auto const* const method : {"rkmk4", "heun"}) {
      auto const scene = llg_scene("0.1", method, 40, film);
      auto const run = SceneRun::open(scene, {.precision = precision});
      run->advance(7);
      run->save(file);
      run->change(changes);
      EXPECT_EQ(run->steps(), 7);
      EXPECT_EQ(run->time(), 7 * 0.02);
      EXPECT_EQ(run->last_step(), 47);
      auto const other =
          SceneRun::open(scene_of(scene.text, changes), {.precision = precision, .restart = file});
      EXPECT_EQ(spins_of(*run), spins_of(*other));
      EXPECT_EQ(run->sample().energy.value, other->sample().energy.value);
      run->advance(5);
      other->advance(5);
      EXPECT_EQ(spins_of(*run), spins_of(*other));
      fs::remove(file);
    }
}

// A time-dependent field sees the time since the start of the run, also after a change.
TEST(Changing, KeepsTheTime) {
  auto const run = SceneRun::open(llg_scene("0.1", "rkmk4", 40, film), {});
  run->advance(10);
  run->change({"integrator={method='tsit5',tolerance=1e-6,dt=0.05,steps=8}"});
  run->advance(8);
  EXPECT_DOUBLE_EQ(run->time(), 10 * 0.02 + 8 * 0.05);
  EXPECT_THROW(run->advance(1), UsageError);
  auto const field = packed<double>(run->field().vectors);
  auto const whole = llg_scene("0.1", "rkmk4", 60, film);
  auto const beside = SceneRun::open(whole, {});
  beside->advance(30);
  EXPECT_LT(largest_distance(spins_of(*run), spins_of(*beside)), 1e-5);
  EXPECT_LT(largest_distance(field, packed<double>(beside->field().vectors)), 1e-4);
}

// A run that is stored and continued after a change gives bitwise the same results as one that is
// not interrupted.
TEST(Changing, IsStored) {
  auto const file = fs::path(testing::TempDir()) / fmt::format("changed_{}.h5", ::getpid());
  for (auto const* const integrator :
       {"{method='heun',dt=0.03,steps=30}", "{method='tsit5',tolerance=1e-6,dt=0.03,steps=30}"}) {
    auto const run = SceneRun::open(llg_scene("0.1", "rkmk4", 40, film), {});
    run->advance(7);
    run->change({std::string("integrator=") + integrator});
    run->advance(5);
    run->save(file);
    auto const again = SceneRun::open(run->typed_scene(), {.restart = file});
    EXPECT_EQ(again->restart_warning(), std::nullopt);
    EXPECT_EQ(again->steps(), 12);
    EXPECT_EQ(again->time(), run->time());
    EXPECT_EQ(again->last_step(), 37);
    run->advance(25);
    again->advance(25);
    EXPECT_EQ(spins_of(*again), spins_of(*run));
    EXPECT_EQ(again->time(), run->time());
    fs::remove(file);
  }
}

TEST(Changing, IsRefusedWhereSamplesHaveTheEnergiesOfOtherTerms) {
  auto const scene = llg_scene("0.1", "rkmk4", 40, film);
  std::vector<std::string> const change{"field.slab_demag={normal=[0,0,1]}"};
  EXPECT_NO_THROW(SceneRun::open(scene, {})->change(change));
  auto const run = SceneRun::open(scene_of(scene.text, {"output.terms=true"}), {});
  EXPECT_THROW(run->change(change), io::SceneError);
  run->change({"field.exchange=2"});
  EXPECT_EQ(run->more_of_sample().size(), 2u);
}

TEST(Changing, KeepsTheNotesAboutFunctionsOfTheProgram) {
  std::string const applied = "# field.applied: a function of the program\n",
                    nonlocal = "# field.nonlocal: a function of the program\n";
  auto scene = llg_scene("0.1", "rkmk4", 40,
                         "lattice = { shape = [9] }\ninitial = { uniform = [0, 0, 1] }\n");
  scene.text += applied + nonlocal;
  auto const run = SceneRun::open(scene, {});
  auto const has = [&](std::string const& note) {
    return run->typed_scene().text.find(note) != std::string::npos;
  };
  for (std::string const damping : {"0.2", "0.3"}) {
    run->change({"system.damping=" + damping});
    EXPECT_TRUE(has(applied) && has(nonlocal)) << run->typed_scene().text;
  }
  run->change({"field.applied=[0,0,1]"});
  EXPECT_TRUE(!has(applied) && has(nonlocal)) << run->typed_scene().text;
}

TEST(Changing, LeavesARunAsItWasWhereItIsRefused) {
  auto const scene = llg_scene("0.1", "rkmk4", 40, film);
  auto const run = SceneRun::open(scene, {});
  auto const same = SceneRun::open(scene, {});
  run->advance(3);
  for (std::string const wrong :
       {"lattice.shape=[3]", "system.kind='rigid_body'", "field.exchange='x+'", "integrator.dt=-1",
        "integrator={method='tsit5',tolerance=1e-20,dt=0.1,steps=4}"})
    EXPECT_THROW(run->change({wrong}), io::SceneError) << wrong;
  run->advance(4);
  same->advance(7);
  EXPECT_EQ(spins_of(*run), spins_of(*same));
  EXPECT_EQ(run->scene().text, scene.text);
}

}  // namespace
}  // namespace cayspin::simulation::test
