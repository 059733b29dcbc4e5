// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Tests that replicas with different fields, dampings and anisotropies are stepped as columns of a
// few lattices, with the bits of separate runs.
#include "ensemble_of_chains.hpp"
#include "simulation/failure.hpp"

#include <Kokkos_Core.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <random>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace cayspin::simulation::test {
namespace {

template <class Real>
std::vector<double> spins_of_replica(std::vector<std::byte> const& all, std::int64_t replica,
                                     std::int64_t sites) {
  std::vector<Real> spins(static_cast<std::size_t>(3 * sites));
  std::memcpy(spins.data(),
              all.data() + static_cast<std::size_t>(replica) * spins.size() * sizeof(Real),
              spins.size() * sizeof(Real));
  return {spins.begin(), spins.end()};
}

/// Expects the replicas to have the spins and the energies of separate runs, in both precisions.
void expect_bits_of_own_runs(io::Scene const& scene, std::vector<std::int64_t> const& replicas) {
  for (auto const precision : precisions) {
    EnsembleRun run(scene, {.precision = precision}, false);
    run.advance(7, run.looks(false, {}));
    run.advance(2, run.looks(false, {}));
    auto const all = run.spins();
    auto const scalars = run.scalars();
    for (auto const replica : replicas) {
      auto const own = SceneRun::open(io::replica_of(scene, replica), {.precision = precision});
      own->advance(9);
      auto const sites = io::sites(own->scene());
      EXPECT_EQ(precision == Precision::double_precision
                    ? spins_of_replica<double>(all, replica, sites)
                    : spins_of_replica<float>(all, replica, sites),
                spins_of(*own))
          << "replica " << replica << " in " << to_string(precision) << " precision";
      auto const& sampled = scalars[static_cast<std::size_t>(replica)];
      EXPECT_EQ(sampled.energy, own->sample().energy.value) << "replica " << replica;
      EXPECT_EQ(sampled.magnetization[2], own->sample().magnetization.z) << "replica " << replica;
    }
  }
}

/// Expects the values of replicas to be bitwise those of their scenes.
void expect_values_of_replicas(io::Scene const& scene) {
  constexpr std::int64_t first = 5, count = 11;
  auto const values = io::values_of_replicas(scene, io::replica_of(scene, 0), first, count);
  ASSERT_TRUE(values.has_value());
  for (std::int64_t column = 0; column < count; ++column) {
    auto const of_one = static_cast<std::size_t>(column);
    auto const replica = io::replica_of(scene, first + column);
    if (!values->temperatures.empty()) {
      EXPECT_EQ(values->temperatures[of_one], replica.thermal->temperature);
    }
    if (!values->dampings.empty()) {
      EXPECT_EQ(values->dampings[of_one], replica.system.damping);
    }
    for (std::size_t term = 0; !values->constants.empty() && term < 2; ++term) {
      auto const& terms = replica.field.anisotropies;
      if (term < terms.size()) {
        EXPECT_EQ(values->constants[of_one].at(term), terms[term].constant);
      }
    }
    for (std::size_t c = 0; c < 3 && !values->applied.empty(); ++c)
      EXPECT_EQ(values->applied[of_one][c], std::get<double>((*replica.field.applied)[c]));
  }
}

// In Gilbert's form, the unit of time depends on the damping, and so does dt in this unit.
TEST(ValuesOfColumns, HaveOneUnitOfTime) {
  auto const atoms = [](std::string const& form, std::string const& key, double unit = 1) {
    return scene_of(R"(units = "SI"
[material]
mu_s = 2.8e-23
J = 1e-21
K = 2e-22
axis = [0, 3, 4]
alpha = 0.1
damping_form = ")" + form +
                    R"("
[system]
kind = "llg"
[lattice]
shape = [3]
spacing = 3e-10
[field]
applied = [0.0, 0.0, 1.0]
[initial]
random = { seed = 7 }
[integrator]
method = "heun"
dt = 1e-15
steps = 9
[thermal]
temperature = 5.0
[ensemble]
replicas = 40
[ensemble.vary]
")" + key + fmt::format("\" = {{ from = {}, to = {} }}\n", 0.07 * unit, 0.9 * unit));
  };
  EXPECT_FALSE(are_columns(atoms("gilbert", "material.alpha")));
  for (std::string const key : {"material.alpha", "field.applied.1", "thermal.temperature"}) {
    auto const scene = atoms("landau_lifshitz", key);
    EXPECT_TRUE(are_columns(scene)) << key;
    expect_values_of_replicas(scene);
    expect_bits_of_own_runs(scene, {0, 23, 39});
  }
  expect_bits_of_own_runs(atoms("gilbert", "material.alpha"), {0, 23});
  auto const of_anisotropies = atoms("gilbert", "material.K", 1e-21);
  EXPECT_TRUE(are_columns(of_anisotropies));
  expect_values_of_replicas(of_anisotropies);
  expect_bits_of_own_runs(of_anisotropies, {0, 23});
  // Without J, K is the unit of energy.
  EXPECT_FALSE(are_columns(scene_of(of_anisotropies.text, {"material.J=0.0"})));
}

TEST(ValuesOfColumns, AreThoseOfAMaterial) {
  auto const scene = scene_of(R"(units = "SI"
[material]
Ms = 8e5
A = 1.3e-11
Ku = 5e4
axis = [0, 0, 1]
alpha = 0.3
damping_form = "gilbert"
[system]
kind = "llg"
[lattice]
shape = [5]
spacing = [4e-9, 5e-9, 3e-9]
[field]
applied = [0.0, 0.02, 0.0]
[initial]
random = { seed = 7 }
[integrator]
method = "rkmk4"
dt = 1e-14
steps = 9
[ensemble]
replicas = 40
vary."material.Ku" = { from = 1e4, to = 9e4 }
vary."field.applied.2" = { from = -0.1, to = 0.1 }
)");
  EXPECT_TRUE(are_columns(scene));
  expect_values_of_replicas(scene);
  expect_bits_of_own_runs(scene, {0, 23, 39});
}

TEST(ValuesOfColumns, WithDifferentFieldsAndDampingsAreRunsOfTheirOwn) {
  std::string const field = "'field.applied.2'={from=-0.5,to=0.7}",
                    vector = "'field.applied.0'={from=1,to=-1},'field.applied.1'={from=0,to=0.3}," +
                             field,
                    damping = "'system.damping'={from=0,to=1.5}",
                    damped = "'system.damping'={from=0.01,to=1.5}",
                    heat = "'thermal.temperature'={from=0,to=0.3}",
                    constant = "'field.anisotropy.constant'={from=-0.4,to=0.7}",
                    constants =
                        "'field.anisotropy.0.constant'={from=0,to=0.7},"
                        "'field.anisotropy.1.constant'={from=0.5,to=-0.7}";
  std::string const axis = "field.anisotropy={constant=0.4,axis=[0,0,1]}",
                    axes =
                        "field.anisotropy=[{constant=0.4,axis=[0,0,1]},"
                        "{constant=-0.2,axis=[0,3,4]}]";
  struct Case {
    std::vector<std::string> varied, changes;
  };
  std::vector<Case> const cases{
      {{field}, {"lattice.shape=[1]"}},
      {{field}, {"integrator.method='ab2'"}},
      {{vector}, {"lattice.shape=[1]", "thermal={temperature=0.1,seed=3}"}},
      {{vector}, {"lattice.boundary='periodic'", "thermal={temperature=0.1,seed=3}"}},
      {{vector}, {axes}},
      {{vector}, {"field.slab_demag={normal=[0,0,1]}", "integrator.method='projected_rk4'"}},
      {{vector}, {"lattice.shape=[40]", "integrator.compensated=true"}},
      {{vector}, {"field.mu0=1.3", "integrator.generator='tangent'"}},
      {{damping}, {"lattice.shape=[1]"}},
      {{damping}, {"system.precession=false", "integrator.method='heun'"}},
      {{damping}, {"field.applied=[0.3,'sin(9*t)',0]", "integrator.generator='orthogonal'"}},
      {{damping}, {"field.anisotropy={cubic=0.4,axes=[[1,0,0],[0,1,0]]}"}},
      {{damping}, {"lattice.shape=[4,5]", "integrator.method='rkmk5'"}},
      {{damped}, {"lattice.shape=[1]", "thermal={temperature=0.1,seed=3}"}},
      {{damped, heat}, {"thermal={temperature=0.1,seed=3}", "integrator.method='heun'"}},
      {{damped, heat, vector}, {"thermal={temperature=0.1,seed=3}"}},
      {{damping, vector}, {"integrator.method='cf4'"}},
      {{constant}, {axis, "lattice.shape=[1]", "integrator.method='ab2'"}},
      {{constant}, {axis, "field.applied=[0.3,'sin(9*t)',0]"}},
      {{constants}, {axes, "field.slab_demag={normal=[0,0,1]}", "lattice.shape=[4,5]"}},
      {{constants, damped, heat, vector}, {axes, "thermal={temperature=0.1,seed=3}"}},
      {{damping, vector}, {"integrator.method='classical_heun'", "lattice.shape=[8]"}}};
  // A lattice has at most 256 columns of 8 sites, and 48 of 40.
  auto const base = scene_of(llg_scene("0.1", "rkmk4", 40, chains).text,
                             {"lattice.shape=[8]", "field.applied=[0.3,-0.2,0]"});
  for (auto const& [varied, changes] : cases) {
    auto all = changes;
    all.push_back(fmt::format("ensemble={{replicas=300,vary={{{}}}}}", fmt::join(varied, ",")));
    SCOPED_TRACE(fmt::format("{}", fmt::join(all, " ")));
    auto const scene = scene_of(base.text, all);
    EXPECT_TRUE(are_columns(scene));
    expect_values_of_replicas(scene);
    expect_bits_of_own_runs(scene, {0, 1, 47, 48, 255, 256, 299});
  }
}

// A lattice of columns with more than 64 sites each is shared by all threads.
TEST(ValuesOfColumns, OfLatticesThatThreadsShareAreRunsOfTheirOwn) {
  std::mt19937 random(20);
  auto const one_of = [&](std::vector<std::string> const& choices) {
    return choices[random() % choices.size()];
  };
  int columns = 0;
  for (int composition = 0; composition < 30; ++composition) {
    std::vector<std::string> const changes{
        "lattice=" + one_of({"{shape=[65]}", "{shape=[100],spacing=2}", "{shape=[1,90]}",
                             "{shape=[13,11],spacing=[1,2]}", "{shape=[16,16]}",
                             "{shape=[17,1,19],spacing=[1,2,3]}"}),
        "lattice.boundary=" + one_of({"'open'", "'periodic'"}),
        "field.exchange=" + one_of({"0.0", "1.0", "-0.7"}),
        "field.applied=" + one_of({"[0.3,-0.2,0]", "[0.3,'sin(9*t)',0]"}),
        "field.anisotropy=" + one_of({"{constant=0.4,axis=[0,3,4]}", "{constant=-1,axis=[0,0,1]}"}),
        "integrator.method=" +
            one_of({"'rkmk4'", "'heun'", "'euler'", "'cf4'", "'rkmk8'", "'projected_rk4'"}),
        "thermal={seed=3,temperature=" + one_of({"0}", "0.1}", "'0.1*t'}"}),
        "ensemble.replicas=" + one_of({"64", "150", "237"}),
        one_of({"ensemble.vary={'system.damping'={from=0.01,to=1}}",
                "ensemble.vary={'field.anisotropy.constant'={from=-0.4,to=0.7}}", "field.mu0=1"})};
    SCOPED_TRACE(fmt::format("{}", fmt::join(changes, " ")));
    auto const scene = scene_of(llg_scene("0.1", "rkmk4", 40, chains).text, changes);
    columns += are_columns(scene) ? 1 : 0;
    expect_bits_of_own_runs(scene, {0, 1, 31, 32, 63});
  }
  if (Kokkos::DefaultHostExecutionSpace().concurrency() <= 2) {  // on more, there are other runs
    EXPECT_GT(columns, 20);
  }
}

// A replica without damping need not lose energy, and Euler's method adds some at each step.
TEST(ValuesOfColumns, LoseEnergyOnlyIfTheyAreDamped) {
  auto const scene =
      scene_of(llg_scene("0.1", "euler", 200, chains).text,
               {"field.applied=[1,0.1,0]", "ensemble.vary={'system.damping'={from=0,to=1e-6}}",
                "initial={expression=['1','0.3*sin(3*i)','0.2*cos(5*i)']}"});
  EXPECT_TRUE(are_columns(scene));
  EnsembleRun run(scene, {}, false);
  try {
    run.advance(100, run.looks(false, {}));
    ADD_FAILURE() << "an energy that rises under damping";
  } catch (NumbersFailed const& failure) {
    EXPECT_TRUE(std::string_view(failure.what()).starts_with("replica 1: ")) << failure.what();
  }
  auto const undamped = scene_of(scene.text, {"ensemble.vary={'system.damping'={from=0,to=0}}"});
  EnsembleRun other(undamped, {}, false);
  other.advance(100, other.looks(false, {}));
  EXPECT_EQ(other.advance(100, other.looks(false, {})), Advanced::whole);
}

}  // namespace
}  // namespace cayspin::simulation::test
