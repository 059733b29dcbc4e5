// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// [[stage]]: the resulting scenes, their starts, and refusals.
#include "io/stages.hpp"

#include "io/relax.hpp"
#include "scene_file.hpp"

#include <tuple>

namespace cayspin::inline v0_2::io::test {
namespace {

std::string with_stages(std::string_view stages, std::string_view scene = plain_scene) {
  return std::string(scene) + std::string(stages);
}

std::string said(std::string const& text, std::vector<std::string> const& overrides = {}) {
  try {
    parse_scene(text, "scene.toml", overrides);
    return "taken";
  } catch (SceneError const& error) {
    return error.what();
  }
}

TEST(Stages, EmptyArraysTakeTermsAway) {
  auto const scene = parse_scene(
      with_stages(R"toml([field]
exchange = 1.0
anisotropy = [{ constant = 1.0, axis = [0, 0, 1] }, { cubic = 1.0, axes = [[1, 0, 0], [0, 1, 0]] }]
exchange_between = [{ between = [0, 1], factor = 0.5 }]
interlayer = [{ between = [0, 1], J = 0.1 }]
sources = [{ profile = [0, 0, "i"] }]
[[stage]]
field = { anisotropy = [], exchange_between = [], interlayer = [], sources = [] }
)toml",
                  replaced(plain_scene, "shape = [4, 3, 2]", "shape = [4, 3, 2]\nregions = \"k\"")),
      "scene.toml");
  EXPECT_EQ(scene.field.anisotropies.size(), 1u);
  EXPECT_EQ(scene.field.sources.size(), 1u);
  auto const& after = scene.stages.at(0).scene.field;
  EXPECT_TRUE(after.exchange);
  EXPECT_TRUE(after.anisotropies.empty());
  EXPECT_TRUE(after.crystal_anisotropies.empty());
  EXPECT_TRUE(after.exchange_between.empty());
  EXPECT_TRUE(after.interlayers.empty());
  EXPECT_TRUE(after.sources.empty());
}

TEST(Stages, ChangeKeysOnTopOfThoseBefore) {
  auto const scene = parse_scene(with_stages(R"toml([field]
exchange = 2.0
anisotropy = { constant = 1.0, axis = [0, 0, 1] }
[[stage]]
name = "switch"
field.applied = [0.1, 0, 0]
system.damping = 0.02
[[stage]]
relax = { torque = 1e-4, evaluations = 7 }
field.anisotropy.constant = 3.0
[[stage]]
integrator = { method = "tsit5", tolerance = 1e-6, end = 4.0 }
[[stage]]
relax = true
)toml"),
                                 "scene.toml");
  ASSERT_EQ(scene.stages.size(), 4u);
  EXPECT_FALSE(scene.field.applied);
  auto const& [first, second, third, fourth] =
      std::tie(scene.stages[0], scene.stages[1], scene.stages[2], scene.stages[3]);
  EXPECT_EQ(first.name, "switch");
  EXPECT_FALSE(first.relax);
  EXPECT_EQ(first.scene.system.damping, 0.02);
  EXPECT_EQ(std::get<double>((*first.scene.field.applied)[0]), 0.1);
  EXPECT_EQ(first.scene.field.exchange->constant, 2.0);
  EXPECT_EQ(first.scene.integrator.steps, 10);
  EXPECT_EQ(second.relax->torque, 1e-4);
  EXPECT_EQ(second.relax->evaluations, 7);
  EXPECT_EQ(second.scene.field.anisotropies.at(0).constant, 3.0);
  EXPECT_EQ(second.scene.field.anisotropies.at(0).axis, (Triple{0, 0, 1}));
  EXPECT_EQ(third.scene.system.damping, 0.02);
  EXPECT_EQ(third.scene.integrator.method, find_method("tsit5"));
  EXPECT_EQ(third.scene.integrator.steps, 128);
  EXPECT_EQ(fourth.relax->torque, 1e-6);
}

TEST(Stages, BeginWhereThoseBeforeThemEnd) {
  auto const scene = parse_scene(with_stages(R"toml([[stage]]
relax = true
[[stage]]
integrator.dt = 0.5
integrator.end = 2.0
[[stage]]
integrator.steps = 3
)toml"),
                                 "scene.toml");
  auto const stages = stages_of(scene);
  ASSERT_EQ(stages.size(), 4u);
  EXPECT_EQ(stages[0].scene.begin, (StageBegin{0, 0, 0}));
  EXPECT_EQ(stages[1].scene.begin, (StageBegin{1, 10, 10 * 0.01}));
  EXPECT_EQ(stages[2].scene.begin, (StageBegin{2, 10, 10 * 0.01}));
  EXPECT_EQ(stages[3].scene.begin, (StageBegin{3, 14, 10 * 0.01 + 4 * 0.5}));
  EXPECT_EQ(end_of(stages[3]), 17);
  EXPECT_EQ(stage_text(stages[3]), "stage 3");
}

constexpr std::string_view si_scene = R"toml(units = "SI"
[system]
kind = "llg"
[material]
Ms = 8e5
A = 1.3e-11
alpha = 0.02
damping_form = "gilbert"
[lattice]
shape = [4]
spacing = 5e-9
[initial]
uniform = [0, 0, 1]
[integrator]
method = "rkmk4"
dt = 1e-13
steps = 300
)toml";

// In Gilbert's form the damping is part of the unit of time.
TEST(Stages, BeginAtTheSameSecondWithAnotherDamping) {
  auto const scene =
      parse_scene(with_stages("[[stage]]\nmaterial.alpha = 0.9\n", si_scene), "scene.toml");
  auto const stages = stages_of(scene);
  auto const& [before, after] = std::tie(stages[0].scene, stages[1].scene);
  double const end = static_cast<double>(before.integrator.steps) * before.integrator.dt;
  EXPECT_NE(before.units.time, after.units.time);
  EXPECT_NEAR(after.begin.time * after.units.time / (end * before.units.time), 1, 1e-15);
}

TEST(Stages, NeedNoIntegratorBeforeThem) {
  constexpr std::string_view start = R"toml([system]
kind = "llg"
damping = 0.1
[lattice]
shape = [4]
[initial]
uniform = [0, 0, 1]
)toml";
  auto const scene = parse_scene(with_stages(R"toml([[stage]]
relax = true
[[stage]]
integrator = { method = "rkmk4", dt = 0.1, steps = 4 }
)toml",
                                             start),
                                 "scene.toml");
  EXPECT_FALSE(has_integrator(scene));
  EXPECT_FALSE(is_to_relax(scene));
  EXPECT_EQ(end_of(stages_of(scene).back()), 4);
  EXPECT_NE(said(with_stages("[[stage]]\nname = \"a\"\n", start)).find("integrator: is missing"),
            std::string::npos);
  std::string const steps = "[[stage]]\nintegrator = { method = \"rkmk4\", dt = 0.1, steps = 4 }\n";
  for (std::string const moving :
       {"field.applied=['sin(t)',0,0]", "torque.zhang_li.velocity=[1,0,0]"})
    EXPECT_EQ(said(with_stages(steps, start), {moving}), "taken");
  auto const every = [&](std::string const& time) {
    return std::vector<std::string>{"output.every.time=" + time, "output.scalars_every.time=0.2"};
  };
  EXPECT_EQ(said(with_stages(steps, start), every("0.4")), "taken");
  EXPECT_NE(said(with_stages(steps, start), every("0.25")).find("dt"), std::string::npos);
  EXPECT_NE(said(with_stages(steps, start), every("0")).find("output.every.time: is 0"),
            std::string::npos);
}

TEST(Stages, AreInTheTextAndReachedByOverrides) {
  auto const text = with_stages("[[stage]]\nsystem.damping = 0.3\n");
  EXPECT_EQ(parse_scene(text, "scene.toml").text, text);
  auto const changed = parse_scene(text, "scene.toml",
                                   {"stage.0.integrator.dt=0.5", "stage.0.field.applied=[1,2,3]"});
  auto const again = parse_scene(changed.text, "again.toml");
  ASSERT_EQ(again.stages.size(), 1u);
  for (auto const* const scene : {&changed, &again}) {
    auto const& stage = scene->stages[0].scene;
    EXPECT_EQ(scene->integrator.dt, 0.01);
    EXPECT_EQ(stage.integrator.dt, 0.5);
    EXPECT_EQ(stage.system.damping, 0.3);
    EXPECT_EQ(std::get<double>((*stage.field.applied)[2]), 3);
  }
  // The text of a single stage contains no stages.
  auto const alone = parse_scene(changed.stages[0].scene.text, "stage.toml");
  EXPECT_TRUE(alone.stages.empty());
  EXPECT_EQ(alone.integrator.dt, 0.5);
}

TEST(Stages, ThatCannotBeAreRefusedInOneLine) {
  struct Wrong {
    std::string stage, line;
  };
  for (auto const& [stage, line] : std::vector<Wrong>{
           {"lattice.shape = [5, 3, 2]",
            "scene.toml:13: stage[0].lattice: cannot change during a "},
           {"units = \"SI\"", "scene.toml:13: stage[0].units: cannot change during a run"},
           {"initial.uniform = [1, 0, 0]", "stage[0].initial: cannot change during a run"},
           {"system.kind = \"rigid_body\"", "stage[0].system.kind: cannot change during a run"},
           {"output.file = \"b.h5\"",
            "stage[0].output.file: cannot change during a run; accepted: output.every, "
            "output.scalars_every"},
           {"label = \"a\"", "scene.toml:13: stage[0].label: unknown key; accepted: name, relax, "},
           {"field = 3", "stage[0].field: is no table"},
           {"field.Exchange = 3", "scene.toml:13: field.Exchange: unknown key, did you mean"},
           {"integrator.dt = -1", "scene.toml:13: integrator.dt: "},
           {"integrator.method = \"heun\"", "integrator.dt: is missing"},
           {"integrator = { method = \"auto\", error = 1e-3, dt = 1, steps = 1 }",
            "integrator.method: \"auto\" does not go with stages"},
           {"field.applied = [[0, 0, 1], [0, 0, 2]]", "field.applied: a list of fields is for"},
           {"relax = false", "scene.toml:13: stage[0].relax: is false; accepted: true"},
           {"relax = 1", "stage[0].relax: 1 is an integer; accepted: true, or a table"},
           {"relax = { Torque = 1 }",
            "stage[0].relax.Torque: unknown key, did you mean \"torque\"?"},
           {"relax.torque = 0", "stage[0].relax.torque"},
           {"relax = true\nintegrator.dt = 1",
            "stage[0].integrator: stands in a stage that relaxes"},
           {"relax = true\nthermal.temperature = -1", "thermal.temperature"},
       }) {
    auto const found = said(with_stages("[[stage]]\n" + stage + "\n"));
    EXPECT_NE(found.find(line), std::string::npos) << stage << ": " << found;
    EXPECT_NE(found.find("; accepted: "), std::string::npos) << found;
    EXPECT_EQ(found.find('\n'), std::string::npos) << found;
  }
  for (auto const& found : {said(with_stages("[stage]\nname = \"a\"\n")),
                            said(std::string(plain_scene), {"stage.0.integrator.dt=1"})})
    EXPECT_NE(found.find(": stage: is no list of tables; accepted: [[stage]]"), std::string::npos)
        << found;
}

TEST(Stages, AreNotForRelax) {
  Folder const folder;
  auto const path = folder.write(with_stages("[[stage]]\nrelax = true\n"));
  try {
    read_scene_to_relax(path);
    ADD_FAILURE() << "taken";
  } catch (SceneError const& error) {
    EXPECT_NE(std::string(error.what())
                  .find("stage: cayspin relax, modes or path takes no run in stages"),
              std::string::npos)
        << error.what();
  }
}

TEST(ChangedOnTheWay, FollowsTheRulesOfStages) {
  auto const scene = parse_scene(std::string(plain_scene), "scene.toml");
  auto const changed =
      changed_on_the_way(scene, {"integrator.method='tsit5'", "integrator.tolerance=1e-5",
                                 "integrator.end=2.0", "field.exchange=1.5"});
  EXPECT_EQ(changed.integrator.tolerance, 1e-5);
  EXPECT_EQ(changed.field.exchange->constant, 1.5);
  EXPECT_EQ(changed_on_the_way(scene, {"integrator.end=0.5"}).integrator.steps, 50);
  EXPECT_EQ(
      changed_on_the_way(changed, {"integrator.steps=3", "integrator.dt=0.5"}).integrator.steps, 3);
  for (std::string const wrong :
       {"lattice.shape=[1]", "initial={}", "output.file='a'", "relax=true", "name='a'"}) {
    EXPECT_THROW(changed_on_the_way(scene, {wrong}), SceneError) << wrong;
  }
}

}  // namespace
}  // namespace cayspin::inline v0_2::io::test
