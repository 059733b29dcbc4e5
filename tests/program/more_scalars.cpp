// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// output.regions, output.terms and lattice.follow in the files of runs.
#include "program_test.hpp"

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace cayspin::program::test {
namespace {

class MoreInFiles : public ProgramTest {
 protected:
  std::vector<double> of(std::string const& file, std::string const& dataset) const {
    return read_dataset(file, "scalars/" + dataset).values;
  }
};

Arguments const regions_and_terms = set("lattice.regions='i < 8 ? 0 : 1'",
                                        "output={every=10,scalars_every=5,regions=true,"
                                        "terms=true,table=true}");

std::string const wall = R"toml(
[system]
kind = "llg"
damping = 0.1
[lattice]
shape = [60, 2, 2]
spacing = [0.25, 1, 1]
follow = { axis = "x", quantity = "mz" }
[field]
exchange = 1.0
anisotropy = [ { constant = 1.0, axis = [0, 0, 1] }, { constant = -0.4, axis = [0, 1, 0] } ]
applied = [0, 0, 0.01]
[initial]
expression = ["1/cosh(0.25*(i - 29.5))", "0.2/cosh(0.25*(i - 29.5))", "-tanh(0.25*(i - 29.5))"]
[integrator]
method = "rkmk4"
dt = 0.02
steps = 1000
[output]
every = 100
scalars_every = 10
)toml";

TEST_F(MoreInFiles, RegionsAndTermsAreInAllThatSaysNumbers) {
  auto const info = run(chain_scene(), regions_and_terms);
  EXPECT_EQ(info.header.more.regions, 2);
  auto const& terms = info.header.more.terms;
  EXPECT_GE(terms.size(), 3u);
  auto const means = read_dataset("out.h5", "scalars/region_magnetization");
  auto const samples = static_cast<std::int64_t>(info.samples);
  EXPECT_EQ(means.extents, (std::vector<std::int64_t>{samples, 2, 3}));
  auto const energy = of("out.h5", "energy"), of_regions = of("out.h5", "region_energy"),
             of_terms = of("out.h5", "term_energy"), mean = of("out.h5", "magnetization");
  for (std::size_t sample = 0; sample < energy.size(); ++sample) {
    double sum = 0;
    for (std::size_t term = 0; term < terms.size(); ++term)
      sum += of_terms[terms.size() * sample + term];
    EXPECT_NEAR(sum, energy[sample], 1e-12 * std::abs(energy[sample]));
    EXPECT_NEAR(of_regions[2 * sample] + of_regions[2 * sample + 1], energy[sample],
                1e-12 * std::abs(energy[sample]));
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(0.4 * means.values[6 * sample + c] + 0.6 * means.values[6 * sample + 3 + c],
                  mean[3 * sample + c], 1e-14);
  }
  auto const said = output_of({"info", "out.h5"});
  EXPECT_TRUE(contains_all(
      said, {"\nregion 0     energy ", "\nregion 1     energy ", "\nexchange     energy "}));
  EXPECT_FALSE(contains(said, "\nshift"));
  auto const text = text_of("out.txt");
  EXPECT_TRUE(contains(text.substr(0, text.find('\n')), "\tmz_region1 ()\tE_region0 ()"));
}

TEST_F(MoreInFiles, AreNamedByCheck) {
  EXPECT_TRUE(contains(output_of(joined({"check", "chain.toml"}, regions_and_terms)),
                       ", samples of each region, energies of each term"));
  write("wall.toml", wall);
  EXPECT_TRUE(contains(output_of({"check", "wall.toml"}), "; follows mz along x"));
}

TEST_F(MoreInFiles, TheyChangeNoBit) {
  run(chain_scene());
  auto const plain = last_spins("out.h5");
  run(chain_scene(), regions_and_terms);
  EXPECT_EQ(last_spins("out.h5"), plain);
}

TEST_F(MoreInFiles, HaveTheSameBitsForAnyNumberOfThreads) {
  auto const bits = [&](char const* threads) {
    run(chain_scene(),
        joined(regions_and_terms, joined(set("lattice.shape=[50,31,7]"), {"--threads", threads})));
    auto all = of("out.h5", "region_magnetization");
    for (char const* name : {"region_energy", "term_energy"})
      for (double const number : of("out.h5", name)) all.push_back(number);
    return all;
  };
  EXPECT_EQ(bits("1"), bits("2"));
}

TEST_F(MoreInFiles, AreOfEachStateOfACommandThatRelaxes) {
  write("relaxed.toml", R"toml(
system = { kind = "llg", damping = 0.1 }
lattice = { shape = [4, 2], regions = "i % 2" }
initial = { uniform = [0.6, 0, 0.8] }
output = { regions = true, terms = true }
[field]
exchange = 1.0
anisotropy = { constant = 1.0, axis = [0, 0, 1] }
applied = [[0.5, 0, 0], [0, 0, 1.0]]
)toml");
  output_of({"relax", "relaxed.toml", "--quiet", "--torque", "1e-10", "--output", "relaxed.h5"});
  auto const info = info_of("relaxed.h5");
  EXPECT_EQ(info.header.more.terms,
            (std::vector<std::string>{"exchange", "anisotropy", "applied"}));
  auto const terms = of("relaxed.h5", "term_energy"), regions = of("relaxed.h5", "region_energy"),
             means = of("relaxed.h5", "region_magnetization");
  // Each of the eight spins has E = -m_z^2/2 - m.H; in the first field m_x = H_x.
  EXPECT_NEAR(terms[1], -8 * 0.5 * 0.75, 1e-9);
  EXPECT_NEAR(terms[2], -8 * 0.25, 1e-9);
  EXPECT_NEAR(regions[0], 4 * (-0.375 - 0.25), 1e-9);
  EXPECT_NEAR(means[3], 0.5, 1e-9);
  EXPECT_NEAR(terms[4], -4, 1e-9);
  EXPECT_NEAR(terms[5], -8, 1e-9);
}

// The shift continues from stage to stage, also after a restart. Relaxing does not change the
// shift.
TEST_F(MoreInFiles, GoOnFromStageToStage) {
  auto const scene = wall + R"([[stage]]
relax.torque = 1e-2
field.applied = [0, 0, 0]
[[stage]]
field.applied = [0, 0, 0.015]
integrator = { method = "rkmk4", dt = 0.02, steps = 1200 }
)";
  auto const more = set("lattice.regions='j'", "output.regions=true", "output.terms=true");
  auto const whole = run(scene, more);
  EXPECT_TRUE(whole.complete);
  auto const& shifts = whole.frame_shifts;
  ASSERT_EQ(shifts.size(), 24u);
  EXPECT_EQ(whole.frame_stages[10], 0);
  EXPECT_EQ(whole.frame_stages[11], 1);
  EXPECT_GT(shifts[10], 3);
  EXPECT_EQ(shifts[11], shifts[10]);
  EXPECT_GT(shifts.back(), shifts[11] + 1);
  EXPECT_EQ(of("out.h5", "shift").back(), static_cast<double>(shifts.back()));
  auto const energy = of("out.h5", "energy"), regions = of("out.h5", "region_energy"),
             terms = of("out.h5", "term_energy");
  ASSERT_EQ(terms.size(), 3 * energy.size());
  for (std::size_t sample = 0; sample < energy.size(); ++sample) {
    auto const* const of_terms = &terms[3 * sample];
    auto const bound = 1e-11 * std::abs(of_terms[0]);
    EXPECT_NEAR(of_terms[0] + of_terms[1] + of_terms[2], energy[sample], bound);
    EXPECT_NEAR(regions[2 * sample] + regions[2 * sample + 1], energy[sample], bound);
  }

  auto const first = scene.find("[[stage]]"), second = scene.find("[[stage]]", first + 1);
  for (auto const end : {first, second}) {
    EXPECT_EQ(run_into("first.h5", scene.substr(0, end), more).status, 0);
    EXPECT_EQ(run_into("second.h5", scene, joined({"--restart", "first.h5"}, more)).status, 0);
    EXPECT_EQ(info_of("second.h5").frame_shifts.back(), shifts.back());
    EXPECT_EQ(last_spins("second.h5"), last_spins("out.h5"));
  }
}

TEST_F(MoreInFiles, OfOtherTermsAreRefusedInStages) {
  write("scene.toml", chain_scene() + "[[stage]]\nfield.dmi = { bulk = 0.1 }\n");
  auto const terms = set("output.terms=true");
  for (Arguments const& command :
       {Arguments{"run", "scene.toml", "--output", "a.h5"}, Arguments{"check", "scene.toml"}})
    expect_refused(joined(command, terms),
                   "field: has different terms from those at the start, and output.terms stores "
                   "the energy of each; accepted: the terms exchange, ");
  output_of({"check", "scene.toml"});
}

TEST_F(MoreInFiles, TheShiftIsInTheFileAndGoesOnAfterARestart) {
  auto const whole = run(wall);
  EXPECT_TRUE(whole.header.more.shift);
  auto const shift = of("out.h5", "shift");
  EXPECT_EQ(shift.front(), 0);
  EXPECT_GT(shift.back(), 3);
  auto const of_frames = read_dataset("out.h5", "shift").values;
  ASSERT_EQ(of_frames.size(), 11u);
  for (std::size_t frame = 0; frame < 11; ++frame) EXPECT_EQ(of_frames[frame], shift[10 * frame]);
  EXPECT_TRUE(contains(output_of({"info", "out.h5"}), "\nshift        "));

  EXPECT_EQ(run_into("first.h5", wall, set("integrator.steps=700")).status, 0);
  EXPECT_EQ(run_into("second.h5", wall, {"--restart", "first.h5"}).status, 0);
  EXPECT_EQ(last_spins("second.h5"), last_spins("out.h5"));
  for (char const* name : {"shift", "energy", "magnetization"}) {
    auto const all = of("out.h5", name), rest = of("second.h5", name);
    ASSERT_LT(rest.size(), all.size());
    EXPECT_EQ(std::vector(all.end() - static_cast<std::ptrdiff_t>(rest.size()), all.end()), rest)
        << name;
  }
  // The shift also continues if the method starts afresh.
  auto const in_other_field = joined({"--restart", "first.h5"}, set("field.applied=[0,0,0.015]"));
  EXPECT_EQ(run_into("second.h5", wall, in_other_field).status, 0);
  EXPECT_EQ(of("second.h5", "shift").front(), of("first.h5", "shift").back());
  // A shift along another axis starts at 0.
  auto const along_y =
      joined(joined({"--restart", "first.h5"}, set("lattice.follow={axis='y',quantity='mz'}")),
             set("integrator.steps=1001"));
  EXPECT_EQ(run_into("along_y.h5", wall, along_y).status, 0);
  EXPECT_EQ(of("along_y.h5", "shift").front(), 0);
  // A run without `follow` has no shift, so a run that continues it starts with the shift 0.
  write("wall.toml", wall.substr(0, wall.find("follow")) + wall.substr(wall.find("[field]")));
  output_of(
      {"run", "wall.toml", "--quiet", "--output", "third.h5", "--set", "integrator.steps=100"});
  EXPECT_EQ(run_into("second.h5", wall, {"--restart", "third.h5"}).status, 0);
  EXPECT_EQ(of("second.h5", "shift").front(), 0);
  EXPECT_GT(of("second.h5", "shift").back(), 3);
}

}  // namespace
}  // namespace cayspin::program::test
