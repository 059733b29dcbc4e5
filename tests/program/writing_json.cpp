// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// --json of relax, modes and path prints the values in their files; methods --json prints its
// table.
#include "../support/larger.hpp"
#include "json_output.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <sstream>
#include <string>
#include <vector>

namespace cayspin::program::test {
namespace {

TEST_F(JsonOutput, HasTheMagnetizationOfSublattices) {
  write("scene.toml", R"toml([system]
kind = "llg"
damping = 0.2
[lattice]
shape = [3, 2, 4]
crystal = "bcc"
[field]
couplings = { shells = [1.0] }
applied = [0, 0, 1]
[initial]
random = { seed = 5 }
)toml");
  auto const found = json_of({"relax", "scene.toml", "--output", "out.h5"});
  EXPECT_EQ(found.at("shape"), (std::vector{3, 2, 4}));
  EXPECT_EQ(found.at("cell_sites"), 2);
  expect_datasets(found, "out.h5", {"sublattice_magnetization"});
}

TEST_F(JsonOutput, MatchesTheFileOfARelaxedEnsemble) {
  write("film.toml", film + "[ensemble]\nreplicas = 2\nvary = { \"field.exchange\" = [1, 2] }\n");
  Arguments const relax{"relax", "film.toml", "--output", "all.h5", "--overwrite"};
  auto const found = json_of(relax);
  EXPECT_EQ(found, info("all.h5"));
  EXPECT_EQ(found.at("last_frame").at("converged"), (json{true, true}));
  expect_datasets(found.at("last_frame"), "all.h5", {"torque", "evaluations"});

  auto const few = start(joined(relax, {"--json", "--evaluations", "3"}));
  EXPECT_EQ(few.status, 3);
  EXPECT_TRUE(is_one_line(few.errors));
  EXPECT_EQ(parsed(few.output).at("last_frame").at("converged"), (json{false, false}));
}

TEST_F(JsonOutput, MatchesTheFileOfRelax) {
  write("film.toml", film);
  auto found = json_of(joined({"relax", "film.toml", "--output", "out.h5"},
                              set("field.applied=[[0.3, 0, 0.001], [-0.3, 0, 0.001]]")));
  auto const searches = found.at("searches");
  ASSERT_EQ(searches.size(), 2U);
  double torque = 0, evaluations = 0;
  for (auto const& search : searches) {
    EXPECT_EQ(search.at("converged"), true);
    EXPECT_EQ(search.at("end"), "converged");
    torque = cayspin::test::larger(torque, search.at("torque").get<double>());
    evaluations += search.at("evaluations").get<double>();
  }
  EXPECT_EQ(found.at("torque"), torque);
  EXPECT_EQ(found.at("evaluations"), evaluations);
  expect_attributes(found, "out.h5", {"torque", "converged", "evaluations", "wall_seconds"}, {});
  expect_datasets(found, "out.h5", {"step", "energy", "magnetization"});
  found.erase("searches");
  EXPECT_EQ(found, info("out.h5"));
}

TEST_F(JsonOutput, SaysThatRelaxDidNotConverge) {
  write("film.toml", film);
  auto const outcome = start({"relax", "film.toml", "--output", "out.h5", "--json", "--evaluations",
                              "3", "--set", "initial={ random = { seed = 3 } }"});
  EXPECT_EQ(outcome.status, 3);
  EXPECT_TRUE(is_one_line(outcome.errors));
  auto const found = parsed(outcome.output);
  EXPECT_EQ(found.at("converged"), false);
  EXPECT_EQ(found.at("complete"), true);
  EXPECT_GT(found.at("torque"), 1e-6);
  EXPECT_EQ(found.at("searches").at(0).at("converged"), false);
  EXPECT_EQ(found.at("searches").at(0).at("end"), "evaluation limit");
  expect_datasets(found, "out.h5", {"energy"});
}

TEST_F(JsonOutput, NamesTheUnitsOfSi) {
  write("film.toml", si_film);
  auto const found = json_of({"relax", "film.toml", "--output", "out.h5", "--torque", "1e-9"});
  EXPECT_EQ(found.at("units"), "SI");
  expect_attributes(found, "out.h5",
                    {"time_unit", "length_unit", "field_unit", "energy_unit", "torque"}, {"units"});
  EXPECT_EQ(found.at("searches").at(0).at("torque"), found.at("torque"));
  EXPECT_LT(found.at("torque"), 1e-9);
  expect_datasets(found, "out.h5", {"energy"});
  EXPECT_LT(std::abs(found.at("energy").at(0).get<double>()), 1e-15);  // J
}

TEST_F(JsonOutput, MatchesTheFileOfModes) {
  write("film.toml", film);
  auto const found = json_of({"modes", "film.toml", "--count", "3", "--hessian"});
  EXPECT_EQ(found, info("modes.h5"));
  EXPECT_EQ(found.at("kind"), "modes");
  expect_datasets(
      found, "modes.h5",
      {"frequency", "decay", "residual", "curvature", "curvature_error", "curvature_residual"});
  EXPECT_EQ(found.at("frequency").size(), 3U);
  expect_attributes(found, "modes.h5", {"torque", "evaluations", "converged"},
                    {"scene", "space", "units"});
  expect_nulls(found, {"wave_vector"});
  expect_nulls(json_of({"modes", "film.toml", "--overwrite", "--quiet"}),
               {"curvature", "curvature_error", "curvature_residual"});
}

TEST_F(JsonOutput, MatchesTheFileOfWaves) {
  write("film.toml", film);
  auto const found =
      json_of({"modes", "film.toml", "--set", "lattice.boundary=\"periodic\"", "--wave-vector",
               "0,0,0", "--wave-vector", "0.5,0,0", "--points", "4"});
  EXPECT_EQ(found, info("modes.h5"));
  expect_datasets(found, "modes.h5", {"wave_vector", "frequency", "decay"});
  EXPECT_EQ(found.at("frequency").size(), 5U);
  expect_nulls(found, {"residual", "curvature", "curvature_error", "curvature_residual"});
}

TEST_F(JsonOutput, MatchesTheFileOfAPath) {
  write("scene.toml", R"toml([system]
kind = "llg"
damping = 0.1
[lattice]
shape = [3]
[field]
exchange = 20.0
anisotropy = [{ constant = 1.3, axis = [0, 0, 1] }, { constant = -0.7, axis = [0, 1, 0] }]
applied = [0.4, 0, 0]
[initial]
uniform = [0, 0, 1]
)toml");
  expect_status(0, {"relax", "scene.toml", "--output", "a.h5", "--quiet"});
  expect_status(0, {"relax", "scene.toml", "--output", "b.h5", "--quiet", "--set",
                    "initial={ uniform = [0, 0, -1] }"});
  Arguments const path{"path", "scene.toml", "--from",   "a.h5", "--to",       "b.h5",
                       "-o",   "path.h5",    "--images", "16",   "--overwrite"};
  auto found = json_of(joined(path, {"--rates"}));
  EXPECT_EQ(found, info("path.h5"));
  EXPECT_EQ(found.at("kind"), "path");
  EXPECT_EQ(found.at("end"), "converged");
  expect_datasets(found, "path.h5", {"energy", "distance", "zero_modes", "zero_mode_volumes"});
  expect_datasets(found.at("saddles"), "path.h5",
                  {"energy", "curvature", "next_curvature", "image"}, "/saddles/");
  expect_attributes(
      found, "path.h5",
      {"converged", "evaluations", "wall_seconds", "across", "torque", "saddle_energy",
       "barrier_forward", "barrier_backward", "saddle_curvature", "prefactor_forward",
       "prefactor_backward", "langer_forward", "langer_backward", "threads"},
      {"scene", "from", "to", "written_by", "git_commit", "precision", "space", "units", "end"});

  found = json_of(path);
  expect_nulls(found, {"prefactor_forward", "langer_backward", "zero_modes", "zero_mode_volumes"});
  auto const few = start(joined(path, {"--json", "--evaluations", "40"}));
  EXPECT_EQ(few.status, 3);
  EXPECT_TRUE(is_one_line(few.errors));
  found = parsed(few.output);
  EXPECT_EQ(found.at("converged"), false);
  EXPECT_EQ(found.at("end"), "evaluation limit");
}

TEST_F(JsonOutput, HasTheRowsOfTheTableOfMethods) {
  auto const rows = json_of({"methods"}).at("methods");
  std::istringstream table(output_of({"methods"}));
  std::string line;
  std::getline(table, line);
  std::size_t count = 0;
  for (; std::getline(table, line) && !line.empty(); ++count) {
    ASSERT_LT(count, rows.size());
    auto const& row = rows.at(count);
    std::istringstream words(line);
    std::string word;
    words >> word;
    EXPECT_EQ(word, row.at("method"));
    EXPECT_EQ(contains(line, " compensated "), row.at("compensated").get<bool>()) << line;
    std::vector<std::string> all;
    while (words >> word) all.push_back(word);
    EXPECT_EQ(all.at(all.size() - 1), std::to_string(row.at("work_fields").get<int>())) << line;
    EXPECT_EQ(all.at(all.size() - 3), std::to_string(row.at("order").get<int>())) << line;
    auto const& evaluations = row.at("evaluations");
    EXPECT_EQ(all.at(all.size() - 2), !evaluations.is_null()
                                          ? std::to_string(evaluations.get<int>())
                                      : row.at("adaptive") ? "adaptive"
                                                           : "iterates")
        << line;
    for (char const* key : {"isotropy", "generator", "rotation"})
      for (auto const& name : row.at(key))
        EXPECT_TRUE(contains(line, name.get<std::string>())) << line;
  }
  EXPECT_EQ(count, rows.size());
  EXPECT_GT(count, 40U);
}

TEST_F(JsonOutput, IsAnOptionOfAllCommandsThatPrintNumbers) {
  for (char const* command :
       {"check", "trade", "advise", "methods", "info", "relax", "modes", "path"})
    EXPECT_TRUE(contains(output_of({command, "--help"}), "--json ")) << command;
}

}  // namespace
}  // namespace cayspin::program::test
