// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Scenes refuse exactly the pairs of terms and methods (or keys) in one table, which this test
// prints.
#include "io/refused_pairs.hpp"

#include "io/method.hpp"
#include "scene_file.hpp"

#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

namespace cayspin::inline v0_2::io::test {
namespace {

constexpr std::string_view plain = R"(
system = { kind = "llg", damping = 0.0 }
lattice = { shape = [8, 6, 2] }
field = { exchange = 1, anisotropy = { constant = 0.3, axis = [0, 0, 1] } }
initial = { random = { seed = 3 } }
integrator = { method = "heun", dt = 0.01, steps = 10 }
)";

using Overrides = std::vector<std::string>;

std::vector<std::pair<std::string, Overrides>> terms() {
  std::string const bond = "field.couplings=[{offset=[1,0,0],J=1";
  return {{"plain", {}},
          {"applied", {"field.applied=[0,0,1]"}},
          {"interfacial DMI", {"field.dmi={interfacial=0.1,normal=[0,0,1]}"}},
          {"bulk DMI", {"field.dmi={bulk=0.1}"}},
          {"two axes", {"field.anisotropy=[{constant=1,axis=[0,0,1]},{constant=1,axis=[1,0,1]}]"}},
          {"couplings", {bond + "}]"}},
          {"biquadratic couplings", {bond + ",biquadratic=0.1}]"}},
          {"cubic axes", {"field.anisotropy={cubic=1,axes=[[1,0,0],[0,1,0]]}"}},
          {"cubic axes of sites", {"field.anisotropy={cubic='i',axes=[['1+i',0,0],[0,1,0]]}"}},
          {"hexagonal axis", {"field.anisotropy={hexagonal=1,axis=[0,0,1],in_plane=[1,0,0]}"}},
          {"DMI of D2d", {"field.dmi={d2d=0.1}"}},
          {"constants in t", {"field.in_time={exchange='1+t'}"}},
          {"constants with a factor", {"field.in_time={exchange=2,anisotropy=0.5}"}},
          {"second constant", {"field.anisotropy={constant=1,axis=[0,0,1],constant2='0.1*i'}"}},
          {"axes of sites", {"field.anisotropy={constant=1,axis=['i+1',0,0]}"}},
          {"interlayer", {"lattice.regions='i'", "field.interlayer=[{between=[0,1],J=1}]"}},
          {"biquadratic interlayer",
           {"lattice.regions='i'", "field.interlayer=[{between=[0,1],biquadratic=1}]"}},
          {"moments of sites", {"lattice.moments='1+i'"}},
          {"sources", {"field.sources=[{profile=[0,0,'i']}]"}},
          {"sources in t", {"field.sources=[{profile=[0,0,'i'],time='t'}]"}},
          {"exchange of sites", {"field.exchange='1+0.1*i'"}},
          {"DMI of sites", {"field.dmi={bulk='1+0.1*i'}"}},
          {"anisotropy of sites", {"field.anisotropy={constant='1+0.1*i',axis=[0,0,1]}"}},
          {"damping of sites", {"system.damping='0.1*i'"}},
          {"vacancies", {"lattice.occupied='i>0'"}},
          {"frozen", {"lattice.frozen='i==0'"}},
          {"moments", {"lattice.moments=2"}},
          {"moments of 1", {"lattice.moments=1"}},
          {"gyromagnetic ratio", {"lattice.gyromagnetic=2"}},
          {"current in the plane", {"torque={zhang_li={velocity=[1,0,0]}}"}},
          {"current across it", {"torque={slonczewski={field_like=1,polarization=[0,0,1]}}"}},
          {"in t", {"field.applied=[0,0,'cos(t)']"}},
          {"demag", {"field.demag={}"}},
          {"dipoles", {"field.dipoles={}"}},
          {"slab", {"field.slab_demag={normal=[0,0,1]}"}},
          {"slab on the host", {"field.slab_demag={normal=[0,0,1],where='host'}"}},
          {"two sites in a cell, with ratios of their own",
           {"lattice.crystal='bcc'", "lattice.gyromagnetic=[1,2]", "lattice.moments=[1,1]",
            "field={couplings=[{between=[0,1],J=1}]}"}}};
}

std::vector<std::pair<std::string, Overrides>> methods_and_keys() {
  std::vector<std::pair<std::string, Overrides>> all{
      {"isotropy analytic", {"integrator.method='euler'", "integrator.isotropy='analytic'"}},
      {"sigma", {"integrator.isotropy={constant=0.3}"}},
      {"tangent", {"integrator.generator='tangent'"}},
      {"orthogonal", {"integrator.generator='orthogonal'"}},
      {"energy_control", {"integrator.energy_control=true"}},
      {"compensated", {"integrator.method='rkmk4'", "integrator.compensated=true"}},
      {"until_torque", {"integrator.until_torque=1e-3"}}};
  for (auto const* const method : methods()) {
    if (method->automatic) continue;
    Overrides keys{fmt::format("integrator.method='{}'", method->word)};
    if (method->adaptive) keys.emplace_back("integrator.tolerance=1e-4");
    all.emplace_back(method->word, keys);
  }
  return all;
}

/// Returns the table's entry for a scene with the terms of `scene` and the integrator of `other`;
/// nullptr if there is none.
RefusedPair const* expected_of(Scene scene, Scene const& other) {
  scene.integrator = other.integrator;
  for (auto const& pair : refused_pairs())
    if (pair.has_terms(scene) && pair.has_other(scene)) return &pair;
  return nullptr;
}

TEST(RefusedPairs, AreThoseOfTheTable) {
  for (auto const& pair : refused_pairs())
    fmt::print("{} | {} | {}\n", pair.terms, pair.with, pair.why);
  std::vector<int> found(refused_pairs().size());
  for (auto const& [term, of_term] : terms()) {
    auto const with_terms = scene_of(plain, of_term);
    for (auto const& [word, of_method] : methods_and_keys()) {
      SCOPED_TRACE(term + " with " + word);
      auto both = of_term;
      both.insert(both.end(), of_method.begin(), of_method.end());
      auto const said = refusal_of(plain, both);
      auto const* const pair = expected_of(with_terms, scene_of(plain, of_method));
      if (pair == nullptr) {
        EXPECT_EQ(said, "accepted");
        continue;
      }
      ++found[static_cast<std::size_t>(pair - refused_pairs().data())];
      expect_holds(said, fmt::format(": {}: ", pair->key));
      auto const why = pair->why;
      expect_holds(said, why.substr(why.find("{}") == why.npos ? 0 : why.find("{}") + 2));
      expect_holds(said, pair->accepted);
    }
  }
  // Every row is found except the first, a program's own field, which no text can have.
  for (std::size_t row = 1; row < found.size(); ++row)
    EXPECT_GT(found[row], 0) << refused_pairs()[row].terms << " with " << refused_pairs()[row].with;
}

}  // namespace
}  // namespace cayspin::inline v0_2::io::test
