// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// cayspin check and cayspin methods.
#include "io/method.hpp"
#include "program_test.hpp"

#include <nlohmann/json.hpp>

#include <set>
#include <sstream>

namespace cayspin::program::test {
namespace {

class Checking : public ProgramTest {
 protected:
  nlohmann::json check(std::string const& scene, Arguments const& more = {}) const {
    write("scene.toml", scene);
    return nlohmann::json::parse(output_of(joined({"check", "scene.toml", "--json"}, more)));
  }
};

// For one spin in a field of 1, the stable dt is the limit of the method's stability polynomial,
// which depends on the damping. The table has rounded values of this limit.
TEST_F(Checking, StableDtIsThatOfTheStabilityPolynomial) {
  struct Row {
    char const* damping;
    double euler, heun, rk4;
  };
  for (auto const& row : std::vector<Row>{{"0.001", .00200, .2013, 2.8305},
                                          {"0.05", .0998, .7986, 2.9061},
                                          {"0.5", .8000, 1.7207, 2.3730},
                                          {"2.0", .8000, .9611, 1.2751},
                                          {"10.0", .1980, .2000, .2780}}) {
    auto const stable_dt = [&](std::string const& method) {
      return check(macrospin_scene(), set("integrator.method='" + method + "'",
                                          std::string("system.damping=") + row.damping))
          .at("stable_dt")
          .get<double>();
    };
    for (char const* method : {"euler", "classical_euler", "projected_euler"})
      EXPECT_NEAR(stable_dt(method), row.euler, 6e-5) << method << " " << row.damping;
    for (char const* method : {"classical_heun", "projected_heun"})
      EXPECT_NEAR(stable_dt(method), row.heun, 6e-5) << method << " " << row.damping;
    for (char const* method : {"rkmk4", "classical_rk4", "projected_rk4"})
      EXPECT_NEAR(stable_dt(method), row.rk4, 6e-5) << method << " " << row.damping;
  }
}

// The stiff chain, and lattices in 2D and 3D, with an applied field of 5 and other terms of 1.
TEST_F(Checking, StableDtOfLattices) {
  Arguments const stiff =
      set("system.damping=0.05", "initial.random.seed=1",
          "integrator={method='rkmk4',dt=1e-5,steps=10}",
          "field={exchange=1,anisotropy={constant=1,axis=[0,0,1]},applied=[5,0,0],"
          "slab_demag={normal=[1,0,0]}}");
  auto const stable_dt = [&](std::string const& shape, std::string const& spacing) {
    return check(chain_scene(),
                 joined(stiff, set("lattice={shape=" + shape + ",spacing=" + spacing + "}")))
        .at("stable_dt")
        .get<double>();
  };
  // `check` never prints a stable dt above the measured one. On the fine chain the two are equal.
  // On the coarse chain, the bound on the field is not sharp, so the printed dt may be as much as
  // 35 % below the measured one, and on the other lattices 3 %.
  EXPECT_NEAR(stable_dt("[100]", "0.01"), 7.26586e-5, 4e-8);
  EXPECT_LT(stable_dt("[100]", "1.0"), 3.88384e-1);
  EXPECT_GT(stable_dt("[100]", "1.0"), 3.88384e-1 * 0.65);
  EXPECT_LT(stable_dt("[16,12]", "[0.2,0.3]"), 1.98726e-2);
  EXPECT_GT(stable_dt("[16,12]", "[0.2,0.3]"), 1.98726e-2 * 0.97);
  EXPECT_LT(stable_dt("[8,7,6]", "[0.2,0.25,0.3]"), 1.43862e-2);
  EXPECT_GT(stable_dt("[8,7,6]", "[0.2,0.25,0.3]"), 1.43862e-2 * 0.97);
}

TEST_F(Checking, StableDtIsZeroWhereEveryDtAmplifiesAndNullWhereThereIsNone) {
  auto const undamped =
      check(macrospin_scene(), set("system.damping=0", "integrator.method='euler'"));
  EXPECT_EQ(undamped.at("stable_dt").get<double>(), 0);
  EXPECT_TRUE(check(macrospin_scene(), set("field.applied=[0,0,0]")).at("stable_dt").is_null());
  EXPECT_TRUE(check(bodies_scene()).at("stable_dt").is_null());
}

TEST_F(Checking, StableDtOfAFieldInTimeIsThatOfItsLargest) {
  auto const growing = check(macrospin_scene(),
                             set("field.applied=['0','0','t*(10-t)/6.25']", "integrator.end=10.0"));
  auto const four = check(macrospin_scene(), set("field.applied=[0,0,4]"));
  EXPECT_NEAR(growing.at("stable_dt").get<double>(), four.at("stable_dt").get<double>(), 1e-9);
}

TEST_F(Checking, IterationsHaveNoCountBeforehand) {
  for (std::string const method : {"implicit_euler", "implicit_midpoint", "stiff2", "stiff4"}) {
    auto const numbers = check(chain_scene(), set("integrator.method='" + method + "'"));
    EXPECT_TRUE(numbers.at("evaluations_per_step").is_null());
    EXPECT_TRUE(numbers.at("stable_dt").is_null());
  }
}

// `check` names the fault for which `run` would refuse the output file, but succeeds.
TEST_F(Checking, SaysWhatIsWrongWithTheOutputFile) {
  auto const last_line = [&](std::string const& file) {
    auto const output = output_of({"check", "chain.toml", "--set", "output.file='" + file + "'"});
    return output.substr(output.rfind('\n', output.size() - 2) + 1);
  };
  EXPECT_TRUE(last_line("free.h5").starts_with("output "));
  for (std::string const extension : {"there.h5", "left.checkpoint.h5"}) write(extension, "kept");
  std::string const begin = "            as it stands: ";
  EXPECT_EQ(last_line("there.h5"),
            begin +
                "there.h5: cannot write the file: it exists (choose another name, or overwrite "
                "with --overwrite)\n");
  EXPECT_TRUE(last_line("left.h5").starts_with(begin + "left.checkpoint.h5: cannot write"));
  EXPECT_EQ(last_line("no/folder.h5"),
            begin + "no/folder.h5: cannot create the file: No such file or directory\n");
  EXPECT_EQ(last_line("/dev/full"),
            begin + "/dev/full: cannot write the file: it exists and is not a regular file\n");
}

TEST_F(Checking, CountsCostAndFrames) {
  auto const numbers = check(chain_scene());
  EXPECT_EQ(numbers.at("evaluations_per_step"), 4);
  EXPECT_EQ(numbers.at("steps"), 25);
  EXPECT_EQ(numbers.at("frames"), 4);
  EXPECT_EQ(numbers.at("sites"), 60);
  run(chain_scene());
  auto const size = static_cast<double>(std::filesystem::file_size(in_folder("out.h5")));
  EXPECT_LT(numbers.at("file_bytes").get<double>(), size);
}

TEST_F(Checking, CountsTheFramesOfTheLongestPeriod) {
  auto const numbers = check(chain_scene(), set("output.every=9223372036854775807"));
  EXPECT_EQ(numbers.at("frames"), 2);
}

TEST_F(Checking, CountsBytesOfFilesThatNoDiskHolds) {
  auto const changes = set("integrator={method='euler',dt=0.01,steps=1000000000000}",
                           "output.every=1", "lattice.shape=[1000,1000]");
  EXPECT_NEAR(check(chain_scene(), changes).at("file_bytes").get<double>(), 2.4e19, 1e16);
  auto const text = output_of(joined({"check", "scene.toml"}, changes));
  EXPECT_TRUE(contains(text, "1000000000001 frames, 24 EB, to"));
}

// Vector fields in memory. For rkmk4: the state, two intermediate states, an increment and the sum
// of the increments. For euler: the state and the next state.
TEST_F(Checking, CountsMemory) {
  auto const bytes = [&](std::string const& method, std::string const& precision) {
    return check(chain_scene(), {"--set", "lattice.shape=[64,64,64]", "--set",
                                 "integrator.method='" + method + "'", "--precision", precision})
        .at("bytes_per_site")
        .get<double>();
  };
  EXPECT_NEAR(bytes("euler", "double") / (2 * 24), 1, 0.15);
  EXPECT_NEAR(bytes("euler", "single") / (2 * 12), 1, 0.3);
  EXPECT_NEAR(bytes("euler", "double") / bytes("series4", "double"), 2. / 8, 1e-12);
  // rkmk4 needs the buffers of a sweep or, if the cores' caches are large, the five fields of
  // passes.
  EXPECT_GT(bytes("rkmk4", "double"), bytes("euler", "double"));
  EXPECT_LE(bytes("rkmk4", "double"), 5. / 2 * bytes("euler", "double") * (1 + 1e-12));
}

// Compares the predicted memory with the peak that the system measures in runs of one step. The
// margin is for buffers on the host: the C library may keep freed buffers, and the writing thread
// allocates its buffers in pieces.
TEST_F(Checking, MemoryIsWhatARunTakes) {
  if (address_sanitizer) GTEST_SKIP() << "the sanitizer's own memory is counted, too";
  struct Bytes {
    double predicted, measured;
  };
  auto const take = [&](std::string const& method, std::string const& shape) {
    Arguments const changes =
        set("integrator={method='" + method + "',dt=0.01,steps=1}", "lattice.shape=" + shape);
    double const predicted = check(chain_scene(), changes).at("memory_bytes").get<double>();
    auto const outcome = start(joined({"run", "scene.toml", "--quiet", "--overwrite"}, changes));
    EXPECT_EQ(outcome.status, 0);
    return Bytes{predicted, outcome.peak_bytes};
  };
  auto const small = take("euler", "[16,16,16]"), euler = take("euler", "[96,96,96]"),
             rkmk4 = take("rkmk4", "[96,96,96]"), series4 = take("series4", "[96,96,96]");
  double const frame = 96 * 96 * 96 * 24;
  EXPECT_NEAR(series4.measured - euler.measured, series4.predicted - euler.predicted, 1.4 * frame);
  EXPECT_NEAR(rkmk4.measured - euler.measured, rkmk4.predicted - euler.predicted, 1.4 * frame);
  double const measured = euler.measured - small.measured;
  EXPECT_NEAR(measured, euler.predicted - small.predicted, 1.4 * frame);
}

TEST_F(Checking, HugeLatticesAreCheckedWithoutAllocating) {
  auto const numbers = check(chain_scene(), set("lattice.shape=[100000,100000,1000]"));
  EXPECT_GT(numbers.at("memory_bytes").get<double>(), 9e14);
}

TEST_F(Checking, TextNamesWhatIsModelled) {
  EXPECT_TRUE(
      contains_all(output_of({"check", "chain.toml"}),
                   {"damping 0.1", "20 x 3 x 1 = 60 sites", "H = 1 Lap(m)", "H = 0.5 (m.e) e",
                    "H = -0.2 (m.e) e", "(0.3, -0.2, 0.1)", "n = (1, 0, 0)", "seed 3", "order 4",
                    "25 steps of 0.02", "stable dt", "bytes per site", "4 frames"}));
  EXPECT_FALSE(exists("chain.h5"));
  auto const spin = output_of({"check", "spin.toml"});
  EXPECT_TRUE(contains(spin, "1 x 1 x 1 = 1 site"));
  EXPECT_FALSE(contains(spin, "1 sites"));
}

TEST_F(Checking, TextNamesValuesOfRegions) {
  write("regions.toml", R"toml([system]
kind = "llg"
damping = { regions = [0.1, 0.2] }
[lattice]
shape = [4, 4]
regions = "i > 1"
[field]
dmi = { interfacial = 0.2, normal = { regions = [[0, 0, 1], [0, 0, -1]] } }
[[field.anisotropy]]
constant = 0.5
axis = { regions = [[0, 0, 1], [1, 0, 0]] }
[[field.anisotropy]]
cubic = 0.1
axes = [{ regions = [[0, 0, 1], [1, 0, 0]] }, [0, 1, 0]]
[[field.sources]]
profile = { regions = [[0, 1, 0], [0, 2, 0]] }
[torque]
slonczewski = { damping_like = 0.01, polarization = { regions = [[0, 1, 0], [0, 0, 1]] } }
[initial]
uniform = [0, 0, 1]
[integrator]
method = "rkmk4"
dt = 0.01
steps = 2
)toml");
  auto const text = output_of({"check", "regions.toml"});
  EXPECT_TRUE(contains_all(
      text,
      {"damping [0.1, 0.2] of regions\n", " n = [(0, 0, 1), (0, 0, -1)] of regions, times 0.2\n",
       "H = 0.5 (m.e) e, e = [(0, 0, 1), (1, 0, 0)] of regions\n",
       "axes [(0, 0, 1), (1, 0, 0)] of regions and (0, 1, 0)\n",
       "H = [(0, 1, 0), (0, 2, 0)] of regions\n", "p = [(0, 1, 0), (0, 0, 1)] of regions\n"}))
      << text;
  EXPECT_FALSE(contains(text, "(0, 0, 0)")) << text;
}

TEST_F(Checking, MethodsListsEveryMethodAndNoRowTwice) {
  auto const text = output_of({"methods"});
  std::set<std::string> expected, found;
  for (auto const* const method : io::methods()) {
    if (method->automatic) continue;
    std::string const word(method->word);
    expected.insert(word);
    EXPECT_TRUE(contains(text, "\n" + word + " "));
    auto settings = set("integrator.method='" + word + "'");
    if (method->adaptive) settings = joined(settings, set("integrator.tolerance=1e-6"));
    output_of(joined({"check", "chain.toml"}, settings));
  }
  std::set<std::string> rows, lines;
  auto const table = nlohmann::json::parse(output_of({"methods", "--json"}));
  for (auto const& row : table.at("methods")) {
    found.insert(row.at("method").get<std::string>());
    EXPECT_TRUE(rows.insert(row.dump()).second) << row;
  }
  EXPECT_EQ(found, expected);
  std::istringstream stream(text.substr(text.find('\n') + 1));
  for (std::string line; std::getline(stream, line) && !line.empty();)
    EXPECT_TRUE(lines.insert(line).second) << line;
  EXPECT_EQ(lines.size(), rows.size());
}

TEST_F(Checking, HelpAndVersion) {
  for (Arguments const& arguments :
       {Arguments{"--help"}, Arguments{"run", "--help"}, Arguments{"--version"}})
    EXPECT_NE(output_of(arguments), "");
  EXPECT_EQ(output_of({"help"}), output_of({"--help"}));
  EXPECT_EQ(output_of({"help", "run"}), output_of({"run", "--help"}));
  EXPECT_EQ(output_of({"help", "help"}), output_of({"--help"}));
  expect_refused({"help", "simulate"}, "unknown command simulate");
}

// On 4 x 4 ranks a part has 8 rows and 16 planes. The first three stages of RKMK4 also compute
// ghosts, on 14 x 22, 12 x 20 and 10 x 18 rows; the last computes 8 x 16.
TEST_F(Checking, SaysWhatRanksRepeat) {
  Arguments const periodic =
      set("lattice={shape=[5,32,64],boundary='periodic'}", "field={exchange=1.0}",
          "initial={uniform=[1,0,0]}", "integrator={method='rkmk4',dt=0.01,steps=1}");
  auto const repeated = [&](std::string const& parts, std::string const& more) {
    return check(chain_scene(), joined(joined({"--ranks", parts}, periodic), set(more)))
        .at("repeated")
        .get<double>();
  };
  std::string const same = "integrator.steps=1";
  EXPECT_DOUBLE_EQ(repeated("4,4", same),
                   (10. * 18 + 12 * 20 + 14 * 22 + 8 * 16) / (4 * 8 * 16) - 1);
  EXPECT_DOUBLE_EQ(repeated("1,2", same), (34. + 36 + 38 + 32) / (4 * 32) - 1);
  EXPECT_DOUBLE_EQ(repeated("1,2", "lattice.boundary='open'"), (33. + 34 + 35 + 32) / (4 * 32) - 1);
  EXPECT_EQ(repeated("1,1", same), 0);
  EXPECT_EQ(repeated("2,2", "integrator.method='euler'"), 0);
  EXPECT_FALSE(check(chain_scene(), periodic).contains("repeated"));
  for (std::string const parts : {"4", "0,4", "4,4,4", "9,1", "1,17"})
    expect_refused(joined({"check", "chain.toml", "--ranks", parts}, periodic),
                   "--ranks " + parts + ": accepted:");
  EXPECT_TRUE(contains(output_of(joined({"check", "chain.toml", "--ranks", "1,2"}, periodic)),
                       "ranks       each does 9.38 % more work than on its own sites, and holds "));
}

// A uniform film that is periodic in its plane has the demagnetizing factor N = 1 along its normal.
TEST_F(Checking, PeriodicFilmsGoOnForEver) {
  std::string const film =
      "[system]\nkind='llg'\ndamping=0.1\n[lattice]\nshape=[20,20,1]\nboundary='periodic'\n"
      "[field]\ndemag=true\n[initial]\nuniform=[0,0,1]\n[integrator]\nmethod='heun'\n"
      "dt=0.01\nsteps=1\n";
  auto const energy = [&](Arguments const& more) {
    EXPECT_EQ(run_into("out.h5", film, joined({"--overwrite"}, more)).status, 0);
    return read_dataset("out.h5", "/energy").values.front() / 400;
  };
  EXPECT_NEAR(energy({}), 0.5, 1e-10);
  EXPECT_NEAR(energy(set("field.demag={periodic_images=[1,1,0]}")), 0.4923, 1e-3);
  EXPECT_TRUE(contains(output_of({"check", write("film.toml", film)}),
                       "by FFTs, infinitely many images along x and y"));
  auto const outcome = run_into(
      "out.h5", film, joined({"--overwrite"}, set("field.demag={periodic_images=[0,1,0]}")));
  EXPECT_EQ(outcome.status, 0);
  EXPECT_TRUE(contains(outcome.errors,
                       "warning: --set field.demag={periodic_images=[0,1,0]}: "
                       "field.demag.periodic_images: no images along x"))
      << outcome.errors;
  EXPECT_TRUE(contains(
      output_of(joined({"check", "film.toml"}, set("field.demag={periodic_images=[0,1,0]}"))),
      "note        "));
  expect_refused({"check", "film.toml", "--set", "lattice.shape=[4,4,4]"}, "periodic_images");
}

TEST_F(Checking, RefusesInterlayersThatARunCannotEvaluate) {
  auto const layers = write("layers.toml",
                            "system = { kind = 'llg', damping = 0.1 }\n"
                            "lattice = { shape = [2], regions = 'i' }\n"
                            "field = { exchange = 1, interlayer = [{ between = [0, 1], J = 2 }] }\n"
                            "initial = { uniform = [0, 0, 1] }\n"
                            "integrator = { method = 'heun', dt = 0.01, steps = 1 }\n");
  expect_refused({"check", layers}, "field.interlayer: is 1 times the exchange of half a cell");
}

// A run uses the directions of a later stage only when that stage begins.
TEST_F(Checking, RefusesSitesWithoutADirection) {
  auto const stages = write("stages.toml", chain_scene() +
                                               "[[stage]]\n"
                                               "field.anisotropy = { constant = 1, axis = [0, 0, "
                                               "'i'] }\n"
                                               "integrator.steps = 1\n");
  std::string const nowhere = "has no direction at site (0, 0, 0)";
  expect_refused({"check", stages}, nowhere);
  expect_refused({"run", stages, "--quiet", "--output", "out.h5"}, nowhere);
  EXPECT_FALSE(exists("out.h5"));
  for (std::string const key : {"field.anisotropy={constant=1,axis=[0,0,'i']}",
                                "field.anisotropy={cubic=1,axes=[[0,0,'i'],[1,0,0]]}",
                                "field.dmi={interfacial=0.1,normal=['i',0,0]}",
                                "torque={slonczewski={damping_like=1,polarization=['i',0,0]}}"})
    expect_refused(joined({"check", "chain.toml"}, set(key)), nowhere);
  expect_refused(
      joined({"check", "chain.toml"}, set("field.anisotropy={cubic=1,axes=[[0,0,1],[0,1,'i']]}")),
      "the axes are not at right angles, by 0.707, at site (1, 0, 0)");
}

}  // namespace
}  // namespace cayspin::program::test
