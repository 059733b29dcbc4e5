// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// A constant acts the same whether it is a number or an expression, in everything that is computed
// from a scene. The other tests here check results that depend on several terms.
#include "../support/larger.hpp"
#include "scenes_of_text.hpp"

#include <random>

namespace cayspin::simulation::test {
namespace {

struct NumbersOrExpressions : testing::Test {
  std::mt19937 random{11};
  template <class Choice>
  Choice one_of(std::vector<Choice> const& choices) {
    return choices[random() % choices.size()];
  }
};

// Returns the tables with each of these constants as a number or as an expression.
std::string tables_of(std::vector<std::pair<std::string, double>> const& constants,
                      std::vector<bool> const& as_expression, std::string tables) {
  for (std::size_t i = 0; i < constants.size(); ++i) {
    auto const& [name, value] = constants[i];
    auto const text =
        as_expression[i] ? fmt::format("'{} + 0*x'", value) : fmt::format("{:#}", value);
    for (auto at = tables.find(name); at != tables.npos; at = tables.find(name))
      tables.replace(at, name.size(), text);
  }
  return tables;
}

double sum_of(std::vector<std::pair<std::string, double>> const& energies) {
  double sum = 0;
  for (auto const& term : energies) sum += term.second;
  return sum;
}

TEST_F(NumbersOrExpressions, GiveTheSameMotionEnergyAndModes) {
  int with_modes = 0;
  for (int composition = 0; composition < 40; ++composition) {
    std::vector<std::pair<std::string, double>> const constants{
        {"@gamma", one_of<double>({0.4, 1, 2.5})}, {"@moment", one_of<double>({0.5, 1, 3})},
        {"@exchange", one_of<double>({0.5, 1.5})}, {"@easy", one_of<double>({0.3, 0.8})},
        {"@dmi", one_of<double>({0.2, 0.4})},      {"@damping", one_of<double>({0.05, 0.3})}};
    auto const tables = fmt::format(
        "[system]\nkind = 'llg'\ndamping = @damping\n[lattice]\nshape = {}\n"
        "boundary = {}\nmoments = @moment\ngyromagnetic = @gamma\n[field]\n"
        "exchange = @exchange\nanisotropy = {{ constant = @easy, axis = [0, 0.2, 1] }}\n"
        "{}\napplied = [0.1, 0, 0.7]\n[initial]\nexpression = ['0.3*cos(i)', "
        "'0.2*sin(j + k)', '1']\n[integrator]\nmethod = '{}'\ndt = 0.02\nsteps = 25\n",
        one_of<std::string>({"[3]", "[4, 3]", "[2, 2, 2]"}),
        one_of<std::string>({"'open'", "'periodic'"}),
        one_of<std::string>({"", "dmi = { bulk = @dmi }",
                             "dmi = { interfacial = @dmi, normal = [0, 0, 1] }", "dipoles = true"}),
        one_of<std::string>({"rkmk4", "heun"}));
    std::vector<bool> mixed;
    for (std::size_t i = 0; i < constants.size(); ++i) mixed.push_back(random() % 2 == 0);
    auto const open = [&](std::vector<bool> const& which) {
      return SceneRun::open(scene_of(tables_of(constants, which, tables)), {});
    };
    SCOPED_TRACE(tables_of(constants, mixed, tables));
    auto const numbers = open(std::vector<bool>(constants.size(), false)),
               expressions = open(mixed);
    auto const before = numbers->energies(), same = expressions->energies();
    ASSERT_EQ(before.size(), same.size());
    for (std::size_t i = 0; i < before.size(); ++i)
      EXPECT_NEAR(before[i].second, same[i].second, 1e-12) << before[i].first;
    numbers->advance(25);
    expressions->advance(25);
    EXPECT_LT(largest_distance(spins_of(*numbers), spins_of(*expressions)), 1e-12);
    EXPECT_NEAR(sum_of(numbers->energies()), numbers->sample().energy.value, 1e-11);
    auto const at = numbers->relax({.torque = 1e-9}),
               of_other = expressions->relax({.torque = 1e-9});
    ASSERT_EQ(at.end, MinimizeEnd::converged);
    ASSERT_EQ(of_other.end, MinimizeEnd::converged);
    if (largest_distance(spins_of(*numbers), spins_of(*expressions)) > 1e-6) continue;
    auto const modes = numbers->modes({.count = 3}), others = expressions->modes({.count = 3});
    if (modes.end != ModesEnd::converged || others.end != ModesEnd::converged) continue;
    ++with_modes;
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(modes.frequencies[i], others.frequencies[i], 1e-6);
      EXPECT_NEAR(modes.decays[i], others.decays[i], 1e-6);
    }
  }
  EXPECT_GT(with_modes, 15);
}

// The total energy, which the field's own kernel sums, is the sum of the terms' energies.
TEST_F(NumbersOrExpressions, TermsAddUpWithFreeBoundaries) {
  for (std::string const dmi : {"bulk = 0.5", "interfacial = 0.4, normal = [0, 0, 1]", "d2d = 0.3"})
    for (std::string const shape : {"[4]", "[5, 3]", "[3, 2, 4]"})
      for (std::string const occupied : {"", "occupied = 'i + j != 2'\n"}) {
        auto const text = fmt::format(
            "[lattice]\nshape = {}\n{}[field]\nexchange = '1 + 0.1*i'\n"
            "anisotropy = {{ constant = 0.2, axis = [1, 0, 1] }}\n"
            "dmi = {{ {}, free_boundary = true }}\n[initial]\nexpression = ['cos(i)', 'sin(i + j)', "
            "'0.3 + 0.1*k']\n",
            shape, occupied, dmi);
        auto const run = SceneRun::open(llg_scene("0.1", "rkmk4", 1, text), {});
        auto const energies = run->energies();
        EXPECT_NEAR(sum_of(energies), run->sample().energy.value, 1e-12) << text;
        auto const without =
            std::ranges::find(energies, "anisotropy", [](auto const& term) { return term.first; });
        ASSERT_NE(without, energies.end());
      }
}

// With free boundaries, each end of a chain along x has x as a hard axis, with the energy
// D^2 / (2 * A) * m_x^2.
TEST_F(NumbersOrExpressions, TheEndsOfAChainWithBulkDmiHaveAnAnisotropy) {
  double exact = 0;
  auto const energy_of_dmi = [&](bool free) {
    auto const run = SceneRun::open(
        llg_scene("0.1", "rkmk4", 1,
                  fmt::format("[lattice]\nshape = [4]\n[field]\nexchange = 1.0\n"
                              "dmi = {{ bulk = 0.5, free_boundary = {} }}\n[initial]\n"
                              "expression = ['cos(i)', 'sin(i)', '0.3']\n",
                              free)),
        {});
    auto const m = spins_of(*run);
    exact = 0.5 * 0.25 * (m[0] * m[0] + m[9] * m[9]);
    auto const energies = run->energies();
    EXPECT_EQ(energies.size(), 2U);
    EXPECT_EQ(energies.at(1).first, "dmi");
    return energies.at(1).second;
  };
  double const of_ends = energy_of_dmi(true) - energy_of_dmi(false);
  EXPECT_NEAR(of_ends, exact, 1e-15);
}

// m_z = tanh(gamma * damping_like * t) for a spin that starts perpendicular to the polarization.
TEST_F(NumbersOrExpressions, ATorqueInTeslaTurnsSpinsByTheirOwnGamma) {
  for (std::string const gamma : {"2.5e11", "'2.5e11 + 0*x'"}) {
    auto const run =
        SceneRun::open(scene_of(fmt::format(
                           "units = 'SI'\nsystem.kind = 'llg'\n"
                           "material = {{ Ms = 8e5, alpha = 0, gamma = {} }}\n"
                           "lattice = {{ shape = [1], spacing = 5e-9 }}\n"
                           "torque.slonczewski = {{ damping_like = 0.01, polarization = [0, 0, 1] "
                           "}}\ninitial = {{ uniform = [1, 0, 0] }}\n"
                           "integrator = {{ method = 'rkmk4', dt = 1e-13, end = 1e-10 }}\n",
                           gamma)),
                       {});
    run->advance(1000);
    EXPECT_NEAR(spins_of(*run)[2], std::tanh(0.25), 1e-9) << gamma;
  }
}

TEST_F(NumbersOrExpressions, RelaxedSpinsHaveTheTorqueThatWasAskedFor) {
  for (std::string const moments :
       {"0.001", "'0.001 + 0*x'", "'i == 3 ? 0.001 : 1'", "1000.0", "'1 + 100*i'"}) {
    auto const run = SceneRun::open(
        llg_scene("0.1", "rkmk4", 1,
                  fmt::format("[lattice]\nshape = [6]\nmoments = {}\n[field]\nexchange = 1.0\n"
                              "applied = [0.3, 0, 1]\n[initial]\n"
                              "expression = ['cos(i)', 'sin(i)', '0.3']\n",
                              moments)),
        {});
    auto const found = run->relax({.torque = 1e-3});
    ASSERT_EQ(found.end, MinimizeEnd::converged) << moments;
    auto const m = spins_of(*run), H = packed<double>(run->field().vectors);
    double largest = 0;
    for (std::size_t i = 0; i < m.size(); i += 3)
      largest = cayspin::test::larger(largest, std::hypot(m[i + 1] * H[i + 2] - m[i + 2] * H[i + 1],
                                                          m[i + 2] * H[i] - m[i] * H[i + 2],
                                                          m[i] * H[i + 1] - m[i + 1] * H[i]));
    EXPECT_LE(largest, 1e-3) << moments;
    EXPECT_NEAR(found.torque, largest, 1e-12 + 1e-9 * largest) << moments;
  }
}

TEST_F(NumbersOrExpressions, ExchangeOfBothSignsIsRefused) {
  expect_refused(
      [] {
        return scene_of(
            "system = { kind = 'llg', damping = 0.5 }\nlattice = { shape = [4] }\n"
            "field = { exchange = 'i-1' }\ninitial = { uniform = [0, 0, 1] }\n"
            "integrator = { method = 'rkmk4', dt = 0.02, steps = 10 }\n");
      },
      "field.exchange: the constants must all have the same sign");
}

// Only spins move along the axis of `follow`. Values that differ along this axis would not move
// with the spins.
TEST_F(NumbersOrExpressions, NoneMayDifferAlongAnAxisThatFollows) {
  for (std::string const table :
       {"lattice.gyromagnetic='1+x'", "lattice.moments='1+x'", "system.damping='0.1+x'",
        "field.exchange='1+x'", "field.anisotropy={constant='1+x',axis=[0,0,1]}",
        "field.anisotropy={constant=1,constant2='x',axis=[0,0,1]}",
        "field.anisotropy={cubic='0.1*x',axes=[[1,0,0],[0,1,0]]}",
        "field.anisotropy={cubic=0.1,constant2='x',axes=[[1,0,0],[0,1,0]]}",
        "field.anisotropy={hexagonal='x',axis=[0,0,1],in_plane=[1,0,0]}",
        "field.dmi={interfacial=0.1,normal=['x','0',1]}",
        "torque.slonczewski={damping_like='x*0.1',polarization=[0,0,1]}",
        "torque.slonczewski={damping_like=0.1,polarization=['x','0',1]}"})
    expect_refused(
        [&] {
          return scene_of(
              "system = { kind = 'llg', damping = 0.5 }\n"
              "lattice = { shape = [20], follow = { axis = 'x', quantity = 'mz' } }\n"
              "field = { exchange = 1.0, anisotropy = { constant = 1.0, axis = [0, 0, "
              "1] } }\ninitial = { uniform = [0, 0, 1] }\n"
              "integrator = { method = 'rkmk4', dt = 0.02, steps = 10 }\n",
              {table});
        },
        "differs along x");
}

}  // namespace
}  // namespace cayspin::simulation::test
