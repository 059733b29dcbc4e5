// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "scene_file.hpp"

#include <cayspin/demagnetization/images.hpp>

#include <cmath>

namespace cayspin::inline v0_2::io::test {
namespace {

TEST(Scene, EveryKeyArrives) {
  Folder const folder;
  auto const scene = read_text(folder, llg_scene);
  EXPECT_EQ(scene.system.kind, SystemKind::llg);
  EXPECT_EQ(scene.system.damping, 0.05);
  EXPECT_TRUE(scene.system.precession);
  EXPECT_EQ(scene.lattice.shape, (std::array<std::int64_t, 3>{4, 3, 1}));
  EXPECT_EQ(scene.lattice.spacing, (Triple{1, 0.5, 1}));
  EXPECT_EQ(scene.lattice.boundary[0], BoundaryKind::open);
  EXPECT_EQ(scene.lattice.boundary[1], BoundaryKind::periodic);
  EXPECT_EQ(sites(scene), 12);
  EXPECT_EQ(scene.field.exchange.value().constant, 1.0);
  ASSERT_EQ(scene.field.anisotropies.size(), 1U);
  EXPECT_EQ(scene.field.anisotropies[0].constant, 1);
  EXPECT_EQ(scene.field.anisotropies[0].axis, (Triple{0, 0, 1}));
  ASSERT_TRUE(scene.field.applied);
  EXPECT_EQ(std::get<double>((*scene.field.applied)[0]), 0.05);
  EXPECT_EQ(std::get<std::string>((*scene.field.applied)[1]), "0.1*cos(t)");
  EXPECT_EQ(std::get<double>((*scene.field.applied)[2]), 0);
  EXPECT_TRUE(depends_on_time(scene.field));
  ASSERT_TRUE(scene.field.slab_demag);
  EXPECT_EQ(scene.field.slab_demag->normal, (Triple{1, 0, 0}));
  EXPECT_EQ(scene.field.slab_demag->strength, 2);
  EXPECT_FALSE(scene.field.slab_demag->on_host);
  EXPECT_EQ(scene.field.mu0, 1.5);
  EXPECT_EQ(scene.integrator.method, find_method("rkmk4"));
  EXPECT_EQ(scene.integrator.steps, 6000);
  EXPECT_EQ(scene.output.file, "slab.h5");
  EXPECT_EQ(scene.output.every, 100);
  EXPECT_EQ(scene.output.scalars_every, 100);
  EXPECT_EQ(scene.path, folder / "scene.toml");
}

TEST(Scene, PeriodsOfOutputMayBeTimes) {
  Folder const folder;
  auto const scene = [&](std::string const& every) {
    return read_text(folder, replaced(llg_scene, "every = 100", every)).output;
  };
  auto const both = scene("every = { time = 0.5 }\nscalars_every = { time = 0.02 }");
  EXPECT_EQ(both.every, 50);
  EXPECT_EQ(both.scalars_every, 2);
  EXPECT_EQ(scene("every = { time = 0.07 }").scalars_every, 7);
}

TEST(Scene, TextIsAFile) {
  Folder const folder;
  auto const typed = parse_scene(std::string(llg_scene), folder / "scene.toml");
  auto const read = read_text(folder, llg_scene);
  EXPECT_EQ(typed.text, read.text);
  EXPECT_EQ(typed.places, read.places);
  EXPECT_EQ(initial_spins(typed), initial_spins(read));
}

TEST(Scene, GivenStartIsNormalised) {
  auto const text = replaced(replaced(llg_scene, "uniform = [0.3, 0.5, 0.8]", "given = true"),
                             "[4, 3]", "[1, 2]");
  Given given;
  given.spins = std::make_shared<std::vector<double> const>(std::vector<double>{0, 3, 4, -2, 0, 0});
  auto const scene = parse_scene(text, "given", {}, given);
  EXPECT_EQ(initial_spins(scene), (std::vector<double>{0, 0.6, 0.8, -1, 0, 0}));
  EXPECT_EQ(initial_spins(with_overrides(scene, {"integrator.dt=0.02"})), initial_spins(scene));
  EXPECT_THROW(parse_scene(text, "given"), SceneError);
  EXPECT_THROW(initial_spins(parse_scene(text, "given", {"lattice.shape=[3]"}, given)), SceneError);
}

TEST(Scene, DefaultsAreTheDocumentedOnes) {
  auto const scene = scene_of(plain_scene);
  EXPECT_TRUE(scene.system.precession);
  EXPECT_EQ(scene.lattice.shape, (std::array<std::int64_t, 3>{4, 3, 2}));
  EXPECT_EQ(scene.lattice.spacing, (Triple{1, 1, 1}));
  for (auto const boundary : scene.lattice.boundary) EXPECT_EQ(boundary, BoundaryKind::open);
  EXPECT_FALSE(scene.field.exchange);
  EXPECT_TRUE(scene.field.anisotropies.empty());
  EXPECT_FALSE(scene.field.applied);
  EXPECT_FALSE(scene.field.slab_demag);
  EXPECT_EQ(scene.field.mu0, 1);
  EXPECT_FALSE(depends_on_time(scene.field));
  EXPECT_EQ(scene.integrator.generator, Generator::standard);
  EXPECT_EQ(scene.integrator.isotropy, Isotropy::zero);
  EXPECT_EQ(scene.integrator.rotation, Rotation::cayley);
  EXPECT_TRUE(scene.integrator.energy_guard);
  EXPECT_FALSE(scene.integrator.until_torque);
  EXPECT_FALSE(scene.output.file);
  EXPECT_EQ(scene.output.every, 10);
  EXPECT_EQ(scene.output.scalars_every, 10);
  EXPECT_EQ(scene.output.compression, 0);
  EXPECT_EQ(scene.output.chunk, 0);
  EXPECT_FALSE(scene.output.xdmf);
  EXPECT_FALSE(scene.output.table);
  EXPECT_FALSE(scene.output.sync);
}

TEST(Scene, DemagnetizationStrengthDefaultsToOne) {
  auto const text = replaced(llg_scene, "strength = 2", "where = \"host\"");
  auto const slab = scene_of(text).field.slab_demag;
  EXPECT_EQ(slab->strength, 1);
  EXPECT_TRUE(slab->on_host);
  EXPECT_FALSE(slab->multirate);
}

TEST(Scene, MultirateFieldsAndSubsteps) {
  auto const text = replaced(llg_scene, "strength = 2", "where = \"host\", multirate = true");
  auto const scene = scene_of(text, {"integrator.substeps=4"});
  EXPECT_TRUE(scene.field.slab_demag->multirate);
  EXPECT_EQ(scene.integrator.substeps, 4);
  EXPECT_EQ(scene_of(text).integrator.substeps, 1);
}

TEST(Scene, TheWholeDemagnetizingField) {
  auto const with = [&](std::string const& typed) {
    auto const text =
        replaced(llg_scene, "slab_demag = { normal = [1, 0, 0], strength = 2 }", typed);
    return scene_of(text).field.demag;
  };
  auto const demag = with("demag = true").value();
  EXPECT_EQ(demag.strength, 1);
  EXPECT_EQ(demag.periodic_images, (std::array{0, infinitely_many_images, 0}));
  EXPECT_FALSE(demag.multirate.has_value());
  EXPECT_FALSE(with("demag = false"));
  auto const typed =
      with("demag = { strength = 0.5, periodic_images = [3, 0, 1], multirate = false }").value();
  EXPECT_EQ(typed.strength, 0.5);
  EXPECT_EQ(typed.periodic_images, (std::array{3, 0, 1}));
  EXPECT_EQ(typed.multirate, false);
}

TEST(Scene, WholeNumbersServeAsNumbers) {
  auto const scene =
      scene_of(llg_scene, {"system.damping=1", "field.exchange=2", "field.mu0=3",
                           "lattice.spacing=2", "integrator.dt=1", "integrator.end=60"});
  EXPECT_EQ(scene.system.damping, 1);
  EXPECT_EQ(scene.field.exchange.value().constant, 2.0);
  EXPECT_EQ(scene.lattice.spacing, (Triple{2, 2, 2}));
  EXPECT_EQ(scene.integrator.steps, 60);
}

TEST(Scene, SeveralAnisotropiesAndOneBoundaryForAllAxes) {
  auto const scene = scene_of(
      llg_scene, {"lattice.boundary=\"periodic\"",
                  "field.anisotropy=[{constant=1,axis=[1,1,0]},{constant=-2,axis=[0,-3,0]}]"});
  for (auto const boundary : scene.lattice.boundary) EXPECT_EQ(boundary, BoundaryKind::periodic);
  ASSERT_EQ(scene.field.anisotropies.size(), 2U);
  EXPECT_DOUBLE_EQ(scene.field.anisotropies[0].axis[1], std::sqrt(0.5));
  EXPECT_EQ(scene.field.anisotropies[1].constant, -2);
  EXPECT_EQ(scene.field.anisotropies[1].axis, (Triple{0, -1, 0}));
}

TEST(Scene, AFormulaWithoutTDoesNotDependOnTime) {
  EXPECT_FALSE(depends_on_time(scene_of(llg_scene, {"field.applied=[\"2*pi\",0,1]"}).field));
}

TEST(Scene, IsotropyConstantCarriesSigma) {
  auto const integrator = scene_of(llg_scene, {"integrator.isotropy={constant=0.7}"}).integrator;
  EXPECT_EQ(integrator.isotropy, Isotropy::constant);
  EXPECT_EQ(integrator.sigma, 0.7);
}

TEST(Scene, EveryMethodIsAccepted) {
  Folder const folder;
  for (auto const* const method : methods()) {
    auto const path = folder.write(replaced(plain_scene, "rkmk4", method->word));
    std::vector<std::string> more;
    if (method->adaptive) more = {"integrator.tolerance=1e-3"};
    if (method->automatic) more = {"integrator.error=1e-3"};
    EXPECT_EQ(read_scene(path, more).integrator.method, method);
  }
}

TEST(Scene, EndIsAWholeNumberOfSteps) {
  auto const steps = [&](std::string const& dt, std::string const& end) {
    return scene_of(llg_scene, {"integrator.dt=" + dt, "integrator.end=" + end}).integrator.steps;
  };
  EXPECT_EQ(steps("0.01", "60.0"), 6000);
  EXPECT_EQ(steps("0.1", "0.3"), 3);
  EXPECT_EQ(steps("0.1", "0"), 0);
  EXPECT_EQ(steps("0.3", "0.9000000001"), 3);
  EXPECT_EQ(steps("0.007", "7e6"), 1000000000);
  EXPECT_EQ(steps("0.003333333333333333", "0.01"), 3);
  EXPECT_THROW(steps("0.3", "0.900000001"), SceneError);
  EXPECT_THROW(steps("0.3", "0.899999999"), SceneError);
}

// The default of 128 samples keeps all bits of the end. With 100 it would not: in doubles, 100
// times 0.07 is not 7.
TEST(Scene, AMethodThatChoosesItsStepsLooksAt128EqualTimes) {
  for (std::string const method : {"method='tsit5',tolerance=1e-5", "method='auto',error=1e-3"})
    for (std::string const typed : {"7.0", "60.0", "0.3", "1e-9", "1e300"}) {
      double const end = std::stod(typed);
      auto const scene = scene_of(replaced(llg_scene, "every = 100", ""),
                                  {"integrator={" + method + ",end=" + typed + "}"});
      EXPECT_EQ(scene.integrator.steps, 128);
      EXPECT_EQ(128 * scene.integrator.dt, end);
      EXPECT_EQ(scene.output.every, 128) << "first and last frame alone";
      EXPECT_EQ(scene.output.scalars_every, 128);
    }
}

TEST(Scene, ProposedStepsAreAccepted) {
  auto const with = [](std::string const& dt) {
    return refusal_of(llg_scene, {"integrator.dt=" + dt, "integrator.end=7.1"});
  };
  auto const message = with("0.013");
  auto const at = message.find("accepted: dt = ") + 15;
  auto const between = message.find(" or ", at);
  EXPECT_EQ(with(message.substr(at, between - at)), "accepted");
  EXPECT_EQ(with(message.substr(between + 4)), "accepted");
}

TEST(Scene, NoStepsStillHaveAPeriod) {
  auto const scene = scene_of(body_scene, {"integrator.steps=0"});
  EXPECT_EQ(scene.integrator.steps, 0);
  EXPECT_EQ(scene.output.every, 1);
  EXPECT_EQ(scene.output.scalars_every, 1);
}

TEST(Scene, FilesLieBesideTheScene) {
  Folder const folder;
  auto const start = read_text(folder, llg_scene, {"initial={file=\"in/state.h5\"}"}).initial;
  EXPECT_EQ(std::get<FileStart>(start).path, folder / "in/state.h5");
  auto const absolute = read_text(folder, llg_scene, {"initial={file=\"/data/state.h5\"}"}).initial;
  EXPECT_EQ(std::get<FileStart>(absolute).path, "/data/state.h5");
}

}  // namespace
}  // namespace cayspin::inline v0_2::io::test
