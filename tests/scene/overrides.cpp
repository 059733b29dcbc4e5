// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "scene_file.hpp"

namespace cayspin::inline v0_1::io::test {
namespace {

TEST(Override, ReplacesAValue) {
  Folder const folder;
  auto const scene =
      read_text(folder, llg_scene,
                {"system.damping=0.5", "system.damping = 0.25", "integrator.method=\"euler\"",
                 "lattice.shape=[8]", "lattice.spacing=2", "lattice.boundary=\"periodic\""});
  EXPECT_EQ(scene.system.damping, 0.25);
  EXPECT_EQ(scene.integrator.method, find_method("euler"));
  EXPECT_EQ(scene.lattice.shape, (std::array<std::int64_t, 3>{8, 1, 1}));
}

TEST(Override, ReplacesAnEntryOfAnArray) {
  Folder const folder;
  auto const scene =
      read_text(folder, llg_scene,
                {"lattice.shape.1=7",
                 "field.anisotropy=[{constant=1,axis=[1,0,0]},{constant=2,axis=[0,1,0]}]",
                 "field.anisotropy.1.constant=5"});
  EXPECT_EQ(scene.lattice.shape[1], 7);
  EXPECT_EQ(scene.field.anisotropies.at(1).constant, 5);
}

TEST(Override, CreatesMissingTables) {
  Folder const folder;
  auto const scene = read_text(folder, body_scene, {"output.file=\"body.h5\"", "output.every=2"});
  EXPECT_EQ(scene.output.file, "body.h5");
  EXPECT_EQ(scene.output.every, 2);
}

TEST(Override, AppliedTextReadsBackTheSame) {
  Folder const folder;
  auto const scene = read_text(folder, llg_scene,
                               {"system.damping=0.1", "field.mu0=1.2566370614359173e-6",
                                "initial={expression=[\"x\",\"1e-300\",\"z\"]}"});
  auto const again = read_scene(folder.write(scene.text, "again.toml"));
  EXPECT_EQ(again.system.damping, 0.1);
  EXPECT_EQ(again.field.mu0, 1.2566370614359173e-6);
  EXPECT_EQ(std::get<ExpressionStart>(again.initial).components[1], "1e-300");
  EXPECT_EQ(std::get<std::string>((*again.field.applied)[1]), "0.1*cos(t)");
  EXPECT_EQ(again.integrator.dt, scene.integrator.dt);
  EXPECT_EQ(again.integrator.steps, scene.integrator.steps);
  EXPECT_EQ(again.lattice.spacing, scene.lattice.spacing);
}

TEST(Override, NoneKeepsTheTextAsTyped) {
  Folder const folder;
  auto const text = "# a comment\n" + std::string(llg_scene);
  EXPECT_EQ(read_text(folder, text).text, text);
}

struct WrongOverride {
  char const* name;
  char const* assignment;
  char const* message;  ///< after "--set assignment: "
};

void PrintTo(WrongOverride const& wrong, std::ostream* stream) { *stream << wrong.assignment; }

class WrongOverrides : public testing::TestWithParam<WrongOverride> {};

TEST_P(WrongOverrides, AreRefusedInOneLine) {
  Folder const folder;
  auto const message = refusal(folder.write(llg_scene), {GetParam().assignment});
  ASSERT_TRUE(message) << "the override was accepted";
  auto const expected = std::string("--set ") + GetParam().assignment + ": " + GetParam().message;
  EXPECT_TRUE(message->starts_with(expected)) << *message;
  EXPECT_EQ(message->find('\n'), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(
    All, WrongOverrides,
    testing::Values(
        WrongOverride{"no_value", "system.damping", "not an assignment; accepted: key.path=VALUE"},
        WrongOverride{"no_key", "=3", "not an assignment"},
        WrongOverride{"empty_value", "system.damping=", "the value is not TOML"},
        WrongOverride{"bare_word", "integrator.method=euler", "the value is not TOML"},
        WrongOverride{"empty_key", "system..damping=1", "an empty key in the path"},
        WrongOverride{"below_a_value", "system.damping.x=1", "\"damping\" is neither a table"},
        WrongOverride{"outside_an_array", "lattice.shape.2=1",
                      "\"2\" is not an entry of an array of 2"},
        WrongOverride{"not_an_index", "lattice.shape.x=1",
                      "\"x\" is not an entry of an array of 2"},
        WrongOverride{"through_an_array", "lattice.shape.9.x=1", "\"9\" is not an entry"},
        WrongOverride{"unknown_key", "lattice.spacng=1",
                      "lattice.spacng: unknown key, did you mean"},
        WrongOverride{"unknown_table", "latice.shape=[1]", "latice: unknown key, did you mean"},
        WrongOverride{"wrong_type", "lattice.shape=[1.5]", "lattice.shape[0]: 1.5 is a number"},
        WrongOverride{"wrong_value", "lattice.shape=[0, 3]", "lattice.shape[0]: 0 is too small"},
        WrongOverride{"not_whole", "integrator.end=0.025", "integrator.end: 0.025 is 2.5 steps"}),
    [](auto const& each) { return std::string(each.param.name); });

TEST(Override, WithASecondLineIsRefused) {
  Folder const folder;
  auto const message = refusal(folder.write(llg_scene), {"system.damping=1\nkind=2"});
  ASSERT_TRUE(message);
  EXPECT_EQ(*message,
            "--set system.damping=1?kind=2: more than one value; accepted: key.path=VALUE with one "
            "TOML value");
}

}  // namespace
}  // namespace cayspin::inline v0_1::io::test
