// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Words that are right each by itself and have no meaning together.
#include "scene_file.hpp"

#include <cmath>

namespace cayspin::inline v0_1::io::test {
namespace {

struct Combination {
  char const* name;
  std::vector<std::string> overrides;
  char const* key;       ///< what the message begins with, after the place
  char const* contains;  ///< what is wrong or accepted
};

void PrintTo(Combination const& wrong, std::ostream* stream) { *stream << wrong.name; }

void expect_refused(std::string_view scene, Combination const& wrong) {
  Folder const folder;
  auto const message = refusal(folder.write(scene), wrong.overrides);
  ASSERT_TRUE(message) << "the scene was accepted";
  EXPECT_NE(message->find(std::string(": ") + wrong.key + ": "), std::string::npos) << *message;
  EXPECT_NE(message->find(wrong.contains), std::string::npos) << *message;
  EXPECT_NE(message->find("; accepted: "), std::string::npos) << *message;
  EXPECT_EQ(message->find('\n'), std::string::npos) << *message;
}

class WrongCombination : public testing::TestWithParam<Combination> {};
TEST_P(WrongCombination, IsRefusedInOneLine) { expect_refused(llg_scene, GetParam()); }

class WrongBodyCombination : public testing::TestWithParam<Combination> {};
TEST_P(WrongBodyCombination, IsRefusedInOneLine) { expect_refused(body_scene, GetParam()); }

auto const name = [](auto const& info) { return std::string(info.param.name); };

INSTANTIATE_TEST_SUITE_P(
    Llg, WrongCombination,
    testing::Values(
        Combination{"auto_with_substeps",
                    {"integrator={method='auto',error=1e-3,end=1,substeps=2}",
                     "field.slab_demag={normal=[1,0,0],where='host',dear=true}"},
                    "integrator.substeps",
                    "\"auto\" chooses the substeps"},
        Combination{"analytic_with_rkmk4",
                    {"integrator.isotropy='analytic'"},
                    "integrator.isotropy",
                    "accepted: \"zero\", { constant = sigma }, \"energy\""},
        Combination{
            "difference_with_implicit",
            {"integrator.method='implicit_euler'", "integrator.isotropy='finite_difference'"},
            "integrator.isotropy",
            "accepted: \"zero\", { constant = sigma }, \"analytic\""},
        Combination{"constant_with_midpoint",
                    {"integrator.method='implicit_midpoint'", "integrator.isotropy={constant=1}"},
                    "integrator.isotropy",
                    "accepted: \"zero\""},
        Combination{"constant_with_series",
                    {"integrator.method='series4'", "integrator.isotropy={constant=1}"},
                    "integrator.isotropy",
                    "accepted: \"zero\""},
        Combination{"energy_with_ab2",
                    {"integrator.method='ab2'", "integrator.isotropy='energy'"},
                    "integrator.isotropy",
                    "accepted: \"zero\", { constant = sigma }"},
        Combination{"energy_with_damping",
                    {"integrator.isotropy='energy'"},
                    "integrator.isotropy",
                    "damping = 0"},
        Combination{
            "energy_overdamped",
            {"integrator.isotropy='energy'", "system.damping=0.0", "system.precession=false"},
            "integrator.isotropy",
            "conserves its energy"},
        Combination{"energy_with_time",
                    {"integrator.isotropy='energy'", "system.damping=0.0"},
                    "integrator.isotropy",
                    "without t"},
        Combination{"energy_in_exponential",
                    {"integrator.isotropy='energy'", "system.damping=0.0", "field.applied=[0,0,1]",
                     "integrator.rotation='exponential'"},
                    "integrator.rotation",
                    "belongs to Cayley coordinates"},
        Combination{"series_with_time",
                    {"integrator.method='series4'"},
                    "integrator.method",
                    "fields that depend on t"},
        Combination{"series_in_exponential",
                    {"integrator.method='series4_paper'", "field.applied=[0,0,1]",
                     "integrator.rotation='exponential'"},
                    "integrator.rotation",
                    "belongs to Cayley coordinates"},
        Combination{"midpoint_in_exponential",
                    {"integrator.method='implicit_midpoint'", "integrator.rotation='exponential'"},
                    "integrator.rotation",
                    "belongs to Cayley coordinates"},
        Combination{"tangent_with_series",
                    {"integrator.method='series4'", "integrator.generator='tangent'"},
                    "integrator.generator",
                    "accepted: \"default\", \"orthogonal\""},
        Combination{"tangent_with_sigma",
                    {"integrator.generator='tangent'", "integrator.isotropy={constant=1}"},
                    "integrator.isotropy",
                    "accepted: \"zero\""},
        Combination{"tangent_in_exponential",
                    {"integrator.generator='tangent'", "integrator.rotation='exponential'"},
                    "integrator.rotation",
                    "accepted: \"cayley\""},
        Combination{"commutator_free_in_cayley",
                    {"integrator.method='cf4'", "integrator.rotation='cayley'"},
                    "integrator.rotation",
                    "accepted: \"exponential\""},
        Combination{"commutator_free_on_the_chart",
                    {"integrator={method='cf4',generator='tangent',dt=0.1,end=1.0}"},
                    "integrator.generator",
                    "accepted: \"default\", \"orthogonal\""},
        Combination{"extrapolation_with_sigma",
                    {"integrator.method='fx4'", "integrator.isotropy={constant=1}"},
                    "integrator.isotropy",
                    "accepted: \"zero\""},
        Combination{"red_black_over_an_odd_period",
                    {"integrator.method='red_black2'", "lattice={shape=[7],boundary='periodic'}"},
                    "lattice.shape",
                    "does not close on itself over the 7 sites of the periodic x"},
        Combination{"red_black_with_layers",
                    {"integrator.method='red_black4'", "lattice.boundary='open'",
                     "field.slab_demag={normal=[1,0,0],average='layer'}"},
                    "field.slab_demag",
                    "a field of the neighbours alone"},
        Combination{"red_black_with_orthogonal",
                    {"integrator.method='red_black2'", "integrator.generator='orthogonal'"},
                    "integrator.generator",
                    "accepted: \"default\""},
        Combination{"tolerance_with_steps_of_dt",
                    {"integrator.tolerance=1e-6"},
                    "integrator.tolerance",
                    "takes steps of dt"},
        Combination{"tolerance_beyond_one",
                    {"integrator.method='tsit5'", "integrator.tolerance=2.0"},
                    "integrator.tolerance",
                    "a number > 0, at most 1"},
        Combination{"no_tolerance",
                    {"integrator={method='projected_dp5',end=1.0}"},
                    "integrator.tolerance",
                    "is missing"},
        Combination{"steps_that_cross",
                    {"integrator.method='bs3'", "integrator.tolerance=1e-3",
                     "integrator.min_dt=0.2", "integrator.max_dt=0.1"},
                    "integrator.max_dt",
                    "a number >= min_dt"},
        Combination{"control_with_damping",
                    {"integrator.energy_control=true"},
                    "integrator.energy_control",
                    "needs a system that conserves its energy"},
        Combination{"control_of_adaptive_steps",
                    {"system.damping=0.0", "field.applied=[0,0,1]",
                     "integrator={method='tsit5',tolerance=1e-3,end=1.0,energy_control=true}"},
                    "integrator.energy_control",
                    "does not step from the spins that it changes"},
        Combination{"compensated_euler",
                    {"integrator.method='euler'", "integrator.compensated=true"},
                    "integrator.compensated",
                    "accepted: \"rkmk4\", \"rkmk5\", \"projected_rk4\", \"projected_rk5\""},
        Combination{"compensated_exponential",
                    {"integrator.method='rkmk4'", "integrator.rotation='exponential'",
                     "integrator.compensated=true"},
                    "integrator.rotation",
                    "accepted: \"cayley\""},
        Combination{"compensated_by_energy",
                    {"system.damping=0.0", "field.applied=[0,0,1]", "integrator.method='rkmk4'",
                     "integrator.isotropy='energy'", "integrator.compensated=true"},
                    "integrator.isotropy",
                    "does not go with compensated"},
        Combination{"cap_without_difference",
                    {"integrator.isotropy_cap=2.0"},
                    "integrator.isotropy_cap",
                    "belongs to isotropy"},
        Combination{"cap_negative",
                    {"integrator.method='euler'", "integrator.isotropy='finite_difference'",
                     "integrator.isotropy_cap=-1.0"},
                    "integrator.isotropy_cap",
                    "a number > 0"}),
    name);

INSTANTIATE_TEST_SUITE_P(RigidBody, WrongBodyCombination,
                         testing::Values(Combination{"energy_with_euler",
                                                     {"integrator.method='euler'",
                                                      "integrator.isotropy='energy'"},
                                                     "integrator.isotropy",
                                                     "kind = \"rigid_body\""},
                                         Combination{"red_black_bodies",
                                                     {"integrator.method='red_black2'"},
                                                     "integrator.method",
                                                     "moves spins of a lattice"},
                                         Combination{"energy_in_exponential",
                                                     {"integrator.isotropy='energy'",
                                                      "integrator.rotation='exponential'"},
                                                     "integrator.rotation",
                                                     "belongs to Cayley coordinates"}),
                         name);

TEST(Combinations, OfRigidBodiesWithEnergyAreAccepted) {
  Folder const folder;
  for (std::string const method : {"heun", "rkmk4", "series4", "series4_paper"})
    EXPECT_FALSE(refusal(folder.write(body_scene),
                         {"integrator.method='" + method + "'", "integrator.isotropy='energy'"}));
}

std::string refusal_of(Scene const& scene) {
  try {
    check_combination(scene);
    return "the scene was accepted";
  } catch (SceneError const& error) {
    return error.what();
  }
}

// Fields that a program sets in a scene that was read: they replace keys, they do not add to them.
TEST(Combinations, OfAProgramsOwnFieldWithThoseOfTheScene) {
  Folder const folder;
  OwnField uniform, nonlocal;
  uniform.uniform = [](double) { return Triple{0, 0, 1}; };
  nonlocal.nonlocal = [](HostVectors const&, HostVectors const&, double) {};
  auto const with = [&](OwnField const& own, std::vector<std::string> const& overrides) {
    auto scene = read_text(folder, llg_scene, overrides);
    scene.field.own = own;
    return refusal_of(scene);
  };
  auto const accepted = "the scene was accepted";
  EXPECT_TRUE(with(uniform, {})
                  .ends_with(":14: field.applied: the program has a uniform field of "
                             "its own; accepted: no such key"))
      << with(uniform, {});
  EXPECT_EQ(with(uniform, {"field={exchange=1}"}), accepted);
  std::string const on_host = "field.slab_demag={normal=[1,0,0],average='layer',where='host'}";
  auto const message = with(nonlocal, {on_host});
  EXPECT_TRUE(
      message.ends_with("field.slab_demag: where = \"host\" does not go with a program's "
                        "own field; accepted: no such key"))
      << message;
  EXPECT_EQ(with(nonlocal, {}), accepted);
  auto const coloured =
      with(nonlocal, {"integrator.method='red_black2'", "lattice.boundary='open'"});
  EXPECT_TRUE(
      coloured.ends_with(": field: method \"red_black2\" needs a field of the neighbours "
                         "alone; accepted: no nonlocal field, or another method"))
      << coloured;
}

TEST(Combinations, CapIsRead) {
  Folder const folder;
  std::vector<std::string> const difference{"integrator.method='euler'",
                                            "integrator.isotropy='finite_difference_backward'"};
  EXPECT_TRUE(std::isinf(read_text(folder, llg_scene, difference).integrator.isotropy_cap));
  auto with_cap = difference;
  with_cap.emplace_back("integrator.isotropy_cap=1.5");
  EXPECT_EQ(read_text(folder, llg_scene, with_cap).integrator.isotropy_cap, 1.5);
}

}  // namespace
}  // namespace cayspin::inline v0_1::io::test
