// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Words that are valid separately but have no meaning together.
#include "../support/method_choice.hpp"
#include "wrong_scenes.hpp"

#include <cmath>

namespace cayspin::inline v0_2::io::test {
namespace {

TEST(WrongCombination, OfSpins) {
  expect_refused(llg_scene, R"(
field.slab_demag = {normal=[1,0,0],where='host',multirate=true};
 integrator = {method='auto',error=1e-3,end=1,substeps=2} | .substeps: | "auto" chooses the substeps
integrator.isotropy = 'analytic' | : | accepted: "zero", { constant = sigma }
integrator.method = 'implicit_euler'; integrator.isotropy = 'finite_difference' | :
  | accepted: "zero", { constant = sigma }, "analytic"
integrator.method = 'implicit_midpoint'; integrator.isotropy = {constant=1} | : | accepted: "zero"
integrator.method = 'series4'; integrator.isotropy = {constant=1} | : | accepted: "zero"
integrator.isotropy = 'energy' | : "energy" corrects only steps of kind = "rigid_body"
  | accepted: "zero", { constant = sigma }
integrator.method = 'series4'; integrator.isotropy = 'energy' | :
 "energy" corrects only steps of kind = "rigid_body" | accepted: "zero"
integrator.method = 'series4_paper'; field.applied = [0,0,1]; integrator.rotation = 'exponential'
  | : | belongs to Cayley coordinates
integrator.method = 'implicit_midpoint'; integrator.rotation = 'exponential' | :
  | belongs to Cayley coordinates
integrator.method = 'series4'; integrator.generator = 'tangent' | :
  | accepted: "default", "orthogonal"
integrator.generator = 'tangent'; integrator.isotropy = {constant=1} | : | accepted: "zero"
integrator.generator = 'tangent'; integrator.rotation = 'exponential' | : | accepted: "cayley"
integrator.method = 'cf4'; integrator.rotation = 'cayley' | : | accepted: "exponential"
integrator = {method='cf4',generator='tangent',dt=0.1,end=1.0} | .generator:
  | accepted: "default", "orthogonal"
integrator.method = 'red_black2'; lattice = {shape=[7],boundary='periodic'} | .shape:
  | does not close on itself over the 7 sites along the periodic axis x
integrator.method = 'red_black4'; lattice.boundary = 'open';
 field.slab_demag = {normal=[1,0,0],where='host'} | : | a field of the neighbours only
integrator.method = 'red_black2'; integrator.generator = 'orthogonal' | : | accepted: "default"
integrator.tolerance = 1e-6 | : | takes steps of dt
integrator = {method='auto',error=1e-3,end=1.0,min_dt=0.1} | .min_dt: | "auto" chooses it
integrator.method = 'tsit5'; integrator.tolerance = 2.0 | : | a number > 0, at most 1
integrator = {method='projected_dp5',end=1.0} | .tolerance: | is missing
integrator.method = 'bs3'; integrator.tolerance = 1e-3; integrator.min_dt = -0.1
  | : -0.1 is negative | a number >= 0
integrator.method = 'bs3'; integrator.tolerance = 1e-3; integrator.max_dt = 0 | : 0 is not positive
  | a number > 0
integrator.method = 'bs3'; integrator.tolerance = 1e-3; integrator.min_dt = 0.2;
 integrator.max_dt = 0.1 | : | a number >= min_dt
integrator.energy_control = true | : | needs a system that conserves its energy
system.damping = 0.0; field.applied = [0,0,1];
 integrator = {method='tsit5',tolerance=1e-3,end=1.0,energy_control=true}
  | .energy_control: | continues from its own copy of the spins
integrator.method = 'euler'; integrator.compensated = true | :
  | accepted: "rkmk4", "rkmk5", "projected_rk4", "projected_rk5"
integrator.method = 'rkmk4'; integrator.compensated = true; integrator.rotation = 'exponential' | :
  | accepted: "cayley"
integrator.isotropy_cap = 2.0 | : | belongs to isotropy
integrator.method = 'euler'; integrator.isotropy = 'finite_difference';
 integrator.isotropy_cap = -1.0 | : | a number > 0
)");
}

TEST(WrongCombination, OfRigidBodies) {
  expect_refused(body_scene, R"(
integrator.method = 'euler'; integrator.isotropy = 'energy' | : | kind = "rigid_body"
integrator.method = 'ab2'; integrator.isotropy = 'energy' | :
  | accepted: "zero", { constant = sigma }
integrator.method = 'rkmk4'; integrator.compensated = true; integrator.isotropy = 'energy' | :
  | does not go with compensated
integrator.method = 'red_black2' | : | moves spins of a lattice
integrator.isotropy = 'energy'; integrator.rotation = 'exponential' | :
  | belongs to Cayley coordinates
)");
}

TEST(WrongCombination, OfWordsOfEveryMethod) {
  int refused = 0;
  cayspin::test::for_each_method_choice([&](cayspin::test::MethodChoice const& choice) {
    auto const overrides = choice.overrides();
    SCOPED_TRACE(testing::PrintToString(overrides));
    for (auto const kind : {SystemKind::llg, SystemKind::rigid_body}) {
      auto const said = refusal_of(kind == SystemKind::llg ? plain_scene : body_scene, overrides);
      EXPECT_EQ(said == "accepted", choice.has_meaning(kind)) << said;
      if (said == "accepted") continue;
      expect_holds(said, "; accepted: ");
      ++refused;
    }
  });
  EXPECT_GT(refused, 1000);
}

TEST(Combinations, OfRigidBodiesWithEnergyAreAccepted) {
  for (std::string const method : {"heun", "rkmk4", "series4", "series4_paper"})
    EXPECT_EQ(refusal_of(body_scene,
                         {"integrator.method='" + method + "'", "integrator.isotropy='energy'"}),
              "accepted");
}

// A uniform field of the program excludes field.applied; any other field adds to those of the
// scene.
TEST(Combinations, OfAProgramsOwnFieldWithThoseOfTheScene) {
  OwnField uniform, nonlocal;
  uniform.uniform = [](double) { return Triple{0, 0, 1}; };
  nonlocal.nonlocal = [](HostVectors const&, HostVectors const&, double) {};
  auto const with = [](OwnField const& own, std::vector<std::string> const& overrides) {
    auto scene = scene_of(llg_scene, overrides);
    scene.field.own = own;
    return refusal([&] { check_combination(scene); });
  };
  EXPECT_EQ(with(uniform, {}),
            "scene.toml:14: field.applied: the program has a uniform field of its own; accepted: "
            "no such key");
  EXPECT_EQ(with(uniform, {"field={exchange=1}"}), "accepted");
  for (char const* const beside : {"field.slab_demag={normal=[1,0,0],where='host'}",
                                   "field={demag=true}", "field={dipoles=true}"})
    EXPECT_EQ(with(nonlocal, {beside}), "accepted");
  expect_holds(with(nonlocal, {"integrator.method='red_black2'", "lattice.boundary='open'"}),
               ": field: method \"red_black2\" needs a field of the neighbours only; accepted: no "
               "nonlocal field, or another method");
}

TEST(Combinations, CapIsRead) {
  std::vector<std::string> const difference{"integrator.method='euler'",
                                            "integrator.isotropy='finite_difference_backward'"};
  EXPECT_TRUE(std::isinf(scene_of(llg_scene, difference).integrator.isotropy_cap));
  auto with_cap = difference;
  with_cap.emplace_back("integrator.isotropy_cap=1.5");
  EXPECT_EQ(scene_of(llg_scene, with_cap).integrator.isotropy_cap, 1.5);
}

}  // namespace
}  // namespace cayspin::inline v0_2::io::test
