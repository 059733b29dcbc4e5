// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Words of other programs, where their users would type them.
#include "io/words_of_others.hpp"

#include "scene_file.hpp"

#include <array>
#include <string>

namespace cayspin::inline v0_2::io::test {
namespace {

TEST(WordsOfOthers, SayWhatTheyAreHere) {
  for (auto const& [word, here] : std::to_array<std::array<std::string, 2>>(
           {{"Msat", "material.Ms"},
            {"Aex", "material.A"},
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
            {"lambda", "system.damping"},
            {"alpha", "material.alpha"},
            {"rk45", "dp5"},
            {"minimize", "cayspin relax"},
            {"regrid", "initial.file"},
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

TEST(WordsOfOthers, AreInMessagesOfScenes) {
  for (auto const& [override, said] : std::to_array<std::array<std::string, 2>>(
           {{"field.B_ext=[0,0,1]", "field.B_ext: unknown key, here it is field.applied"},
            {"dt=0.5", "dt: unknown key, did you mean \"integrator.dt\"?"},
            {"system.lambda=0.1", "system.lambda: unknown key, here it is system.damping"},
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
