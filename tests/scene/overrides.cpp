// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "scene_file.hpp"

namespace cayspin::inline v0_2::io::test {
namespace {

TEST(Override, ReplacesAValue) {
  auto const scene = scene_of(
      llg_scene, {"system.damping=0.5", "system.damping = 0.25", "integrator.method=\"euler\"",
                  "lattice.shape=[8]", "lattice.spacing=2", "lattice.boundary=\"periodic\""});
  EXPECT_EQ(scene.system.damping, 0.25);
  EXPECT_EQ(scene.integrator.method, find_method("euler"));
  EXPECT_EQ(scene.lattice.shape, (std::array<std::int64_t, 3>{8, 1, 1}));
}

TEST(Override, ReplacesAnEntryOfAnArray) {
  auto const scene =
      scene_of(llg_scene, {"lattice.shape.1=7",
                           "field.anisotropy=[{constant=1,axis=[1,0,0]},{constant=2,axis=[0,1,0]}]",
                           "field.anisotropy.1.constant=5"});
  EXPECT_EQ(scene.lattice.shape[1], 7);
  EXPECT_EQ(scene.field.anisotropies.at(1).constant, 5);
}

TEST(Override, CreatesMissingTables) {
  auto const scene = scene_of(body_scene, {"output.file=\"body.h5\"", "output.every=2"});
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
  auto const text = "# a comment\n" + std::string(llg_scene);
  EXPECT_EQ(scene_of(text).text, text);
}

TEST(Override, TakesQuotedKeysWithDots) {
  for (std::string const quote : {"'", "\""}) {
    auto const key = "ensemble.vary." + quote + "field.applied.2" + quote;
    auto const scene = scene_of(llg_scene, {"ensemble.replicas=2", key + "=[0.25, 0.5]"});
    ASSERT_EQ(scene.ensemble.vary.size(), 1U);
    EXPECT_EQ(scene.ensemble.vary[0].key, "field.applied.2");
    EXPECT_EQ(scene.ensemble.vary[0].values, (std::vector<double>{0.25, 0.5}));
  }
}

TEST(Override, WordsNeedNoQuotes) {
  auto const scene = scene_of(llg_scene, {"integrator.method=heun", "lattice.boundary = periodic"});
  EXPECT_EQ(scene.integrator.method->word, "heun");
  EXPECT_EQ(scene.lattice.boundary[0], BoundaryKind::periodic);
  EXPECT_EQ(scene_of(scene.text).integrator.method->word, "heun");
  EXPECT_FALSE(scene_of(llg_scene, {"system.precession=false"}).system.precession);
}

TEST(Override, FileNamesNeedNoQuotes) {
  for (std::string const name : {"/tmp/x.h5", "../x.h5", "./a b,c.h5", "~/x.h5", "d/x.h5", "1x",
                                 "100nm.h5", ".x.h5", "/a\"\\b"})
    EXPECT_EQ(scene_of(llg_scene, {"output.file=" + name}).output.file, name) << name;
  for (auto const& [text, number] :
       {std::pair<std::string, double>{"0x1F", 31}, {"1e2", 100}, {"0.5", 0.5}, {"1_0", 10}})
    EXPECT_EQ(scene_of(llg_scene, {"system.damping=" + text}).system.damping, number) << text;
  for (std::string const value : {"1979-05-27", "07:32:00", "1.5", "inf", "true"})
    EXPECT_NE(refusal_of(llg_scene, {"output.file=" + value}).find("output.file: "),
              std::string::npos)
        << value;
  for (std::string const value : {"-x", "1.2.3", ".5", "/a\tb", "1x y"})
    EXPECT_NE(refusal_of(llg_scene, {"output.file=" + value}).find("the value is not TOML"),
              std::string::npos)
        << value;
}

TEST(Override, ThatIsWrongIsRefusedInOneLine) {
  for (std::array<std::string, 2> const& wrong :
       {std::array<std::string, 2>{"system.damping", "not an assignment; accepted: key.path=VALUE"},
        {"=3", "not an assignment"},
        {"system.damping=", "the value is not TOML"},
        {"integrator.method=a b", "the value is not TOML"},
        {"integrator.method=eulre", "integrator.method: \"eulre\" is not known, did you mean"},
        {"dt=0.5", "dt: unknown key, did you mean \"integrator.dt\"?"},
        {"system..damping=1", "an empty key in the path"},
        {"system.damping.x=1", "\"damping\" is neither a table"},
        {"lattice.shape.2=1", "\"2\" is not an entry of an array of 2"},
        {"lattice.shape.x=1", "\"x\" is not an entry of an array of 2"},
        {"lattice.shape.9.x=1", "\"9\" is not an entry"},
        {"lattice.spacng=1", "lattice.spacng: unknown key, did you mean"},
        {"latice.shape=[1]", "latice: unknown key, did you mean"},
        {"lattice.shape=[1.5]", "lattice.shape[0]: 1.5 is a number"},
        {"lattice.shape=[0, 3]", "lattice.shape[0]: 0 is too small"},
        {"integrator.end=0.025", "integrator.end: 0.025 is 2.5 steps"}}) {
    auto const message = refusal_of(llg_scene, {wrong[0]});
    EXPECT_TRUE(message.starts_with("--set " + wrong[0] + ": " + wrong[1])) << message;
  }
}

TEST(Override, WithASecondLineIsRefused) {
  EXPECT_EQ(refusal_of(llg_scene, {"system.damping=1\nkind=2"}),
            "--set system.damping=1?kind=2: more than one value; accepted: key.path=VALUE with one "
            "TOML value");
}

}  // namespace
}  // namespace cayspin::inline v0_2::io::test
