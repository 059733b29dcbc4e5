// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// --json of info, relax, modes, path and methods has the numbers of the files.
#include "hdf5/attribute.hpp"
#include "hdf5/handle.hpp"
#include "program_test.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <sstream>

namespace cayspin::program::test {
namespace {

using nlohmann::json;

struct JsonOutput : ProgramTest {
  std::string const film = R"toml([system]
kind = "llg"
damping = 0.1
[lattice]
shape = [8, 6]
[field]
exchange = 10.0
anisotropy = { constant = 0.1, axis = [1, 0, 0] }
slab_demag = { normal = [0, 0, 1] }
[initial]
uniform = [1, 0.1, 0.1]
)toml";

  std::string const si_film = R"toml(units = "SI"
[material]
Ms = 8e5
A = 1.3e-11
alpha = 0.02
damping_form = "gilbert"
[system]
kind = "llg"
[lattice]
shape = [4, 3]
spacing = 5e-9
[field]
slab_demag = { normal = [0, 0, 1] }
applied = [0.05, 0, 0]
[initial]
uniform = [1, 0.1, 0.2]
)toml";

  static json parsed(std::string const& output) {
    EXPECT_TRUE(is_one_line(output));
    return json::parse(output, nullptr, false);
  }
  json json_of(Arguments const& arguments) const {
    return parsed(output_of(joined(arguments, {"--json"})));
  }
  json info(std::string const& file) const { return json_of({"info", file}); }

  static void append_numbers(json const& value, std::vector<double>& numbers) {
    if (value.is_array())
      for (auto const& one : value) append_numbers(one, numbers);
    else
      numbers.push_back(value.get<double>());
  }

  /// Expects the extents and the numbers of each dataset under its name.
  void expect_datasets(json const& object, std::string const& file,
                       std::vector<std::string> const& names,
                       std::string const& group = "/") const {
    for (auto const& name : names) {
      auto const [extents, values] = read_dataset(file, group + name);
      EXPECT_FALSE(values.empty()) << name;
      std::vector<double> found;
      auto const* rows = &object.at(name);
      append_numbers(*rows, found);
      EXPECT_EQ(found, values) << name;
      for (auto const extent : extents) {
        ASSERT_TRUE(rows->is_array()) << name;
        ASSERT_EQ(rows->size(), static_cast<std::size_t>(extent)) << name;
        rows = &rows->front();
      }
    }
  }

  void expect_attributes(json const& object, std::string const& file,
                         std::vector<std::string> const& numbers,
                         std::vector<std::string> const& texts) const {
    auto const path = in_folder(file);
    auto const opened = io::open_file(path);
    io::RootAttributes const attributes(opened.get(), path);
    for (auto const& name : numbers) {
      auto const& value = object.at(name);
      double const number = value.is_boolean() ? value.get<bool>() : value.get<double>();
      EXPECT_EQ(number, attributes.read_real(name.c_str())) << name;
    }
    for (auto const& name : texts)
      EXPECT_EQ(object.at(name), attributes.read_text(name.c_str())) << name;
  }

  static void expect_null(json const& object, std::vector<std::string> const& names) {
    for (auto const& name : names) EXPECT_TRUE(object.at(name).is_null()) << name;
  }
};

TEST_F(JsonOutput, OfARun) {
  run(chain_scene(), set("output.scalars_every=2"));
  auto const found = info("out.h5");
  EXPECT_EQ(found.at("kind"), "trajectory");
  EXPECT_EQ(found.at("shape"), (std::vector{20, 3, 1}));
  EXPECT_EQ(found.at("frames"), 4);
  EXPECT_EQ(found.at("samples"), 14);
  EXPECT_EQ(found.at("complete"), true);
  expect_datasets(found, "out.h5", {"step", "time", "energy", "norm_defect", "magnetization"});
  expect_attributes(
      found, "out.h5",
      {"format", "complete", "threads", "evaluations", "wall_seconds", "step_seconds"},
      {"scene", "cayspin_version", "git_commit", "kokkos_version", "space", "precision", "units"});
  expect_null(found, {"progress", "torque", "converged", "sublattice_magnetization", "shift",
                      "stage", "last_sample", "resolved_scene"});
  EXPECT_FALSE(found.contains("time_unit"));
}

TEST_F(JsonOutput, OfSamplesWithMore) {
  run(chain_scene(),
      set("output.terms=true", "output.regions=true", "lattice.regions='i < 12 ? 0 : 1'"));
  auto const found = info("out.h5").at("last_sample");
  EXPECT_EQ(found.at("step"), 25);
  EXPECT_EQ(found.at("time"), 0.5);
  auto const last = [&](std::string const& name) {
    auto const [extents, values] = read_dataset("out.h5", "/scalars/" + name);
    auto const row = static_cast<std::ptrdiff_t>(values.size()) / extents[0];
    return std::vector<double>(values.end() - row, values.end());
  };
  for (char const* name : {"energy", "magnetization", "region_magnetization", "region_energy"}) {
    std::vector<double> numbers;
    append_numbers(found.at(name), numbers);
    EXPECT_EQ(numbers, last(name)) << name;
  }
  EXPECT_EQ(found.at("region_magnetization").size(), 2U);
  std::vector<double> terms;
  for (auto const& term : found.at("term_energy")) terms.push_back(term.get<double>());
  auto stored = last("term_energy");
  EXPECT_EQ(terms.size(), stored.size());
  std::ranges::sort(terms);
  std::ranges::sort(stored);
  EXPECT_EQ(terms, stored);
  EXPECT_NE(found.at("term_energy").at("exchange"), 0);
  expect_null(found, {"shift"});
}

TEST_F(JsonOutput, OfARunInStages) {
  run(chain_scene() + "[[stage]]\nname = \"more\"\nintegrator.steps = 7\n");
  auto const found = info("out.h5");
  expect_datasets(found, "out.h5", {"stage", "step", "time"});
  EXPECT_EQ(found.at("stage").back(), 1);
}

TEST_F(JsonOutput, OfACrystal) {
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

TEST_F(JsonOutput, SaysHowFarARunIs) {
  auto const process = begin(joined(
      {"run", "chain.toml", "--quiet", "--threads", "1", "--output", "run.h5"},
      set("integrator.steps=1000000000", "output.every=1000000000", "output.scalars_every=1000")));
  json found;
  EXPECT_TRUE(eventually([&] {
    if (!exists("run.h5")) return false;
    found = info("run.h5");
    return !found.at("last_sample").is_null() && found.at("last_sample").at("step") > 0;
  }));
  EXPECT_EQ(found.at("complete"), false);
  auto const& progress = found.at("progress");
  EXPECT_EQ(progress.at("running"), true);
  EXPECT_EQ(progress.at("steps"), 1000000000);
  EXPECT_EQ(progress.at("step"), found.at("last_sample").at("step"));
  EXPECT_EQ(progress.at("time"), found.at("last_sample").at("time"));
  EXPECT_GT(progress.at("updates_per_second"), 1000);
  EXPECT_GT(progress.at("seconds_left"), 0);
  expect_null(found, {"evaluations", "wall_seconds", "step_seconds"});

  EXPECT_EQ(end(process, SIGKILL), 128 + SIGKILL);
  found = info("run.h5");
  EXPECT_EQ(found.at("progress").at("running"), false);
  expect_null(found.at("progress"), {"seconds_left"});
  expect_null(found, {"evaluations"});
}

TEST_F(JsonOutput, SaysThatARunFailed) {
  run_into("out.h5", chain_scene(),
           set("integrator.method='classical_euler'", "integrator.dt=100.0"));
  auto const found = info("out.h5");
  EXPECT_EQ(found.at("complete"), false);
  EXPECT_EQ(found.at("progress").at("running"), false);
  EXPECT_EQ(found.at("progress").at("steps"), 25);
  expect_null(found.at("progress"), {"seconds", "seconds_left"});
  expect_attributes(found, "out.h5", {"evaluations", "wall_seconds"}, {});
}

TEST_F(JsonOutput, OfASweep) {
  auto const outcome =
      start({"sweep", "chain.toml", "--quiet", "--output", "all.h5", "--set",
             "integrator.method='classical_euler'", "--over", "integrator.dt=0.002,100.0", "--over",
             "field.applied=[0.3,-0.2,0.1],[0,0,0.5]"});
  EXPECT_EQ(outcome.status, 3);
  auto const found = info("all.h5");
  EXPECT_EQ(found.at("kind"), "sweep");
  EXPECT_EQ(found.at("units"), "reduced");
  EXPECT_EQ(found.at("keys"), (json{"integrator.dt", "field.applied"}));
  EXPECT_EQ(found.at("values").at(1), (json{"0.002", "[0,0,0.5]"}));
  EXPECT_EQ(found.at("status"), (json{0, 0, 3, 3}));
  EXPECT_EQ(found.at("parameters").at("integrator.dt"), (json{0.002, 0.002, 100, 100}));
  EXPECT_FALSE(found.at("parameters").contains("field.applied"));
  EXPECT_TRUE(found.at("message").at(0).is_null());
  EXPECT_TRUE(contains(found.at("message").at(2).get<std::string>(), "step"));
  expect_datasets(found, "all.h5",
                  {"status", "step", "time", "energy", "norm_defect", "magnetization",
                   "evaluations", "wall_seconds", "step_seconds"});
  expect_attributes(found, "all.h5", {"complete"},
                    {"scene", "cayspin_version", "git_commit", "precision", "space"});
}

TEST_F(JsonOutput, OfAnEnsemble) {
  write("all.toml",
        chain_scene() +
            "[ensemble]\nreplicas = 3\nvary = { \"system.damping\" = [0.1, 0.2, 0.4] }\n");
  expect_status(0, {"run", "all.toml", "--quiet", "--output", "all.h5"});
  auto const found = info("all.h5");
  EXPECT_EQ(found.at("kind"), "ensemble");
  EXPECT_EQ(found.at("frames"), 4);
  EXPECT_EQ(found.at("vary").at("system.damping"), (json{0.1, 0.2, 0.4}));
  auto const& last = found.at("last_frame");
  EXPECT_EQ(last.at("step"), 25);
  auto const energies = read_dataset("all.h5", "/energy").values;
  EXPECT_EQ(last.at("energy"), std::vector(energies.end() - 3, energies.end()));
  auto const means = read_dataset("all.h5", "/magnetization").values;
  std::vector<double> mean;
  append_numbers(last.at("magnetization"), mean);
  EXPECT_EQ(mean, std::vector(means.end() - 9, means.end()));
  expect_null(last, {"torque", "converged", "evaluations"});
  expect_attributes(found, "all.h5",
                    {"replicas", "evaluations", "wall_seconds", "step_seconds", "complete"},
                    {"scene", "written_by", "space", "precision", "units"});
}

TEST_F(JsonOutput, OfARelaxedEnsemble) {
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

TEST_F(JsonOutput, OfRelax) {
  write("film.toml", film);
  auto found = json_of(joined({"relax", "film.toml", "--output", "out.h5"},
                              set("field.applied=[[0.3, 0, 0.001], [-0.3, 0, 0.001]]")));
  auto const searches = found.at("searches");
  ASSERT_EQ(searches.size(), 2U);
  double torque = 0, evaluations = 0;
  for (auto const& search : searches) {
    EXPECT_EQ(search.at("converged"), true);
    EXPECT_EQ(search.at("end"), "converged");
    torque = std::max(torque, search.at("torque").get<double>());
    evaluations += search.at("evaluations").get<double>();
  }
  EXPECT_EQ(found.at("torque"), torque);
  EXPECT_EQ(found.at("evaluations"), evaluations);
  expect_attributes(found, "out.h5", {"torque", "converged", "evaluations", "wall_seconds"}, {});
  expect_datasets(found, "out.h5", {"step", "energy", "magnetization"});
  found.erase("searches");
  EXPECT_EQ(found, info("out.h5"));
}

TEST_F(JsonOutput, OfRelaxThatDoesNotConverge) {
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

TEST_F(JsonOutput, OfSi) {
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

TEST_F(JsonOutput, OfModes) {
  write("film.toml", film);
  auto const found = json_of({"modes", "film.toml", "--count", "3", "--hessian"});
  EXPECT_EQ(found, info("modes.h5"));
  EXPECT_EQ(found.at("kind"), "modes");
  expect_datasets(found, "modes.h5", {"frequency", "decay", "residual", "curvature"});
  EXPECT_EQ(found.at("frequency").size(), 3U);
  expect_attributes(found, "modes.h5", {"torque", "evaluations", "converged"},
                    {"scene", "space", "units"});
  expect_null(found, {"wave_vector"});
  EXPECT_TRUE(json_of({"modes", "film.toml", "--overwrite", "--quiet"}).at("curvature").is_null());
}

TEST_F(JsonOutput, OfWaves) {
  write("film.toml", film);
  auto const found =
      json_of({"modes", "film.toml", "--set", "lattice.boundary=\"periodic\"", "--wave-vector",
               "0,0,0", "--wave-vector", "0.5,0,0", "--points", "4"});
  EXPECT_EQ(found, info("modes.h5"));
  expect_datasets(found, "modes.h5", {"wave_vector", "frequency", "decay"});
  EXPECT_EQ(found.at("frequency").size(), 5U);
  expect_null(found, {"residual", "curvature"});
}

TEST_F(JsonOutput, OfAPath) {
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
  expect_null(found, {"prefactor_forward", "langer_backward", "zero_modes", "zero_mode_volumes"});
  auto const few = start(joined(path, {"--json", "--evaluations", "40"}));
  EXPECT_EQ(few.status, 3);
  EXPECT_TRUE(is_one_line(few.errors));
  found = parsed(few.output);
  EXPECT_EQ(found.at("converged"), false);
  EXPECT_EQ(found.at("end"), "evaluation limit");
}

TEST_F(JsonOutput, OfMethodsHasTheRowsOfTheTable) {
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

// Names of files may be any bytes.
TEST_F(JsonOutput, IsUtf8) {
  run(chain_scene());
  std::filesystem::rename(in_folder("out.h5"), in_folder("out\xff.h5"));
  EXPECT_EQ(info("out\xff.h5").at("file"), "out\xef\xbf\xbd.h5");
}

TEST_F(JsonOutput, IsAnOptionOfAllCommandsThatPrintNumbers) {
  for (char const* command :
       {"check", "trade", "advise", "methods", "info", "relax", "modes", "path"})
    EXPECT_TRUE(contains(output_of({command, "--help"}), "--json ")) << command;
}

}  // namespace
}  // namespace cayspin::program::test
