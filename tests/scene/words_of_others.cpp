// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Keys and words of other programs, typed where their users would type them.
#include "io/words_of_others.hpp"

#include "scene_file.hpp"

#include <array>
#include <string>

namespace cayspin::inline v0_2::io::test {
namespace {

TEST(WordsOfOthers, SayWhatTheyAreHere) {
  for (auto const& [word, here] : std::to_array<std::array<std::string, 2>>(
           {{"Msat", "material.Ms"},
            {"Aex", "material.A, in reduced units field.exchange"},
            {"Dind", "material.D"},
            {"Dbulk", "material.D_bulk"},
            {"Kc1", "field.anisotropy = { cubic"},
            {"Ku1", "material.Ku"},
            {"anisU", "material.axis"},
            {"B_ext", "field.applied"},
            {"pbc", "lattice.boundary"},
            {"cellsize", "lattice.spacing"},
            {"gridsize", "lattice.shape"},
            {"maxerr", "integrator.tolerance"},
            {"xi", "torque.zhang_li.nonadiabaticity"},
            {"lambda", "system.damping, in SI material.alpha"},
            {"alpha", "material.alpha"},
            {"rk45", "integrator.method = \"dp5\""},
            {"rk4", "integrator.method = \"rkmk4\" or \"projected_rk4\""},
            {"RKKY",
             "field.interlayer = [{ between = [a, b], J = 2 sigma, biquadratic = 2 sigma2 }]"},
            {"ext_InterExchange", "field.exchange_between"},
            {"EpsilonPrime", "torque.slonczewski.epsilon_prime"},
            {"geom", "lattice.occupied"},
            {"edgesmooth", "lattice.occupied"},
            {"BmagnoiseScale", "thermal.temperature"},
            {"SetGridSize", "lattice.shape"},
            {"SetCellSize", "lattice.spacing"},
            {"H_ext", "field.applied, in SI mu0 H in T"},
            {"Happ", "field.applied"},
            {"Hext", "field.applied"},
            {"BC", "lattice.boundary"},
            {"pbc_x", "lattice.boundary"},
            {"dx", "lattice.spacing"},
            {"Nx", "lattice.shape"},
            {"tmax", "integrator.end"},
            {"t_end", "integrator.end"},
            {"tstep", "integrator.dt"},
            {"mxstep", "integrator.steps"},
            {"random_seed", "thermal.seed"},
            {"iseed", "thermal.seed"},
            {"dimensions:unit-cell-size", "lattice.spacing"},
            {"sim:total-time-steps", "integrator.steps"},
            {"alat", "lattice.spacing"},
            {"Mode", "cayspin run"},
            {"relax", "cayspin relax, or relax = true in a [[stage]]"},
            {"bravais_vectors", "lattice.cell"},
            {"anisotropy_magnitude", "material.K"},
            {"interaction_pairs", "field.couplings"},
            {"dij", "field.couplings, each bond with its D"},
            {"gneb", "cayspin path"},
            {"neb", "cayspin path"},
            {"mep", "cayspin path"},
            {"eigenmodes", "cayspin modes"},
            {"spectrum", "cayspin modes"},
            {"version", "cayspin --version"},
            {"minimize", "cayspin relax"},
            {"regrid", "initial.file"},
            {"AnisC2", "field.anisotropy = { cubic"},
            {"OpenBC", "field.dmi.free_boundary, in SI material.free_boundary"},
            {"AddFieldTerm", "field.sources"},
            {"ext_centerWall", "lattice.follow"},
            {"ext_centerBubble", "lattice.follow"},
            {"Run", "cayspin run, to integrator.end"},
            {"SaveAs", "cayspin export"},
            {"n_shells_dmi", "field.couplings, each bond with its D"},
            {"dm_chirality", "field.couplings, each bond with its D"},
            {"anisotropy_normal", "material.axis"},
            {"external_field_normal", "field.applied"},
            {"create:crystal-structure", "lattice.crystal"},
            {"material[1]:uniaxial-anisotropy-constant", "material.K"},
            {"material[1]:damping-constant", "material.alpha"},
            {"sim:applied-field-strength", "field.applied"},
            {"sim:applied-field-unit-vector", "field.applied"},
            {"hfield", "field.applied"},
            {"SDEalgh", "integrator.method"},
            {"rk56", "integrator.method = \"tsit5\""},
            {"temp", "thermal.temperature"},
            {"material[1]:atomic-spin-moment", "material.mu_s"},
            {"exchange-matrix", "field.couplings"},
            {"jfile", "field.couplings"},
            {"dmfile", "field.couplings"},
            {"posfile", "lattice.basis"},
            {"momfile", "lattice.moments"},
            {"n_interaction_pairs", "field.couplings"}})) {
    auto const hint = hint_for_word_of_others(word);
    EXPECT_NE(hint.find(here), std::string::npos) << word << hint;
  }
  EXPECT_EQ(hint_for_word_of_others("wibble"), "");
  EXPECT_EQ(hint_for_word_of_others(""), "");
}

TEST(WordsOfOthers, AreNoKeysOfScenes) {
  for (auto const* const key : {"dt", "damping", "exchange", "shape", "axis", "Ms", "file"})
    EXPECT_EQ(hint_for_word_of_others(key), "") << key;
}

TEST(WordsOfOthers, AsValuesAreMethodsOrTheSimpleCubicLattice) {
  EXPECT_EQ(hint_for_value_of_others("RK45"), ", here it is dp5");
  EXPECT_EQ(hint_for_value_of_others("sc"),
            ", leave the key out: a simple cubic lattice is the default");
  EXPECT_EQ(hint_for_value_of_others("minimize"), ", here it is cayspin relax");
  EXPECT_EQ(hint_for_value_of_others("Msat"), "");
}

TEST(OwnWords, AreFoundInTheirTable) {
  for (auto const& [override, meant] : std::to_array<std::array<std::string, 2>>(
           {{"shape=[3]", "lattice.shape"},
            {"field.dt=0.1", "integrator.dt"},
            {"mu0=1.0", "field.mu0"},
            {"gamma=1.0", "material.gamma\" of units = \"SI"},
            {"lattice.Ms=8e5", "material.Ms\" of units = \"SI"},
            {"A=1e-11", "material.A\" of units = \"SI"},
            {"field.Ku=1e4", "material.Ku\" of units = \"SI"},
            {"D=1e-3", "material.D\" of units = \"SI"},
            {"J=1e-21", "material.J\" of units = \"SI"},
            {"K=1e-23", "material.K\" of units = \"SI"},
            {"lattice.mu_s=1e-23", "material.mu_s\" of units = \"SI"},
            {"cell=[1]", "lattice.cell"},
            {"regions='i'", "lattice.regions"},
            {"MinDt=1e-3", "integrator.min_dt"},
            {"thermal.MaxDt=1e-3", "integrator.max_dt"},
            {"Seed=1", "thermal.seed"},
            {"Dmi=1.0", "field.dmi"},
            {"integrator.MinDt=1e-3", "min_dt"},
            {"integrator.maxDT=1e-3", "max_dt"},
            {"field.Dmi=1.0", "dmi"},
            {"lattice.occupid='i'", "occupied"}})) {
    auto const key = override.substr(0, override.find('='));
    auto const message = refusal_of(llg_scene, {override});
    auto const expected = key + ": unknown key, did you mean \"" + meant + "\"?";
    EXPECT_NE(message.find(expected), std::string::npos) << message;
  }
  EXPECT_EQ(hint_for_other_table("wibble"), "");
  EXPECT_EQ(hint_for_other_case("wibble"), "");
  EXPECT_EQ(hint_for_other_case("a"), "");
}

TEST(WordsOfOthers, AreInMessagesOfScenes) {
  for (auto const& [override, said] : std::to_array<std::array<std::string, 2>>(
           {{"field.B_ext=[0,0,1]", "field.B_ext: unknown key, here it is field.applied"},
            {"dt=0.5", "dt: unknown key, did you mean \"integrator.dt\"?"},
            {"system.lambda=0.1", "system.lambda: unknown key, here it is system.damping"},
            {"rk45=true", "rk45: unknown key, here it is integrator.method = \"dp5\""},
            {"relax=true", "relax: unknown key, here it is cayspin relax, or relax = true in"},
            {"lattice.crystal=sc",
             "lattice.crystal: \"sc\" is not known, leave the key out: a simple cubic lattice"},
            {"integrator.method='rk45'", "\"rk45\" is not known, here it is dp5"}})) {
    try {
      scene_of(llg_scene, {override});
      ADD_FAILURE() << override;
    } catch (SceneError const& error) {
      EXPECT_NE(std::string(error.what()).find(said), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace cayspin::inline v0_2::io::test
