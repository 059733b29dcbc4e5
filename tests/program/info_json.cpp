// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// cayspin info --json prints the values in the file.
#include "json_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace cayspin::program::test {
namespace {

TEST_F(JsonOutput, MatchesTheFileOfARun) {
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
  expect_nulls(found, {"progress", "torque", "converged", "sublattice_magnetization", "shift",
                       "stage", "last_sample", "resolved_scene"});
  EXPECT_FALSE(found.contains("time_unit"));
}

TEST_F(JsonOutput, HasTheEnergiesOfTermsAndRegions) {
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
  expect_nulls(found, {"shift"});
}

TEST_F(JsonOutput, HasTheStageOfEachFrame) {
  run(chain_scene() + "[[stage]]\nname = \"more\"\nintegrator.steps = 7\n");
  auto const found = info("out.h5");
  expect_datasets(found, "out.h5", {"stage", "step", "time"});
  EXPECT_EQ(found.at("stage").back(), 1);
}

TEST_F(JsonOutput, HasTheProgressOfARun) {
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
  expect_nulls(found, {"evaluations", "wall_seconds", "step_seconds"});

  EXPECT_EQ(end(process, SIGKILL), 128 + SIGKILL);
  found = info("run.h5");
  EXPECT_EQ(found.at("progress").at("running"), false);
  expect_nulls(found.at("progress"), {"seconds_left"});
  expect_nulls(found, {"evaluations"});
}

TEST_F(JsonOutput, SaysThatARunFailed) {
  run_into("out.h5", chain_scene(),
           set("integrator.method='classical_euler'", "integrator.dt=100.0"));
  auto const found = info("out.h5");
  EXPECT_EQ(found.at("complete"), false);
  EXPECT_EQ(found.at("progress").at("running"), false);
  EXPECT_EQ(found.at("progress").at("steps"), 25);
  expect_nulls(found.at("progress"), {"seconds", "seconds_left"});
  expect_attributes(found, "out.h5", {"evaluations", "wall_seconds"}, {});
}

TEST_F(JsonOutput, CountsThePlannedStepsFromWhereEarlierStagesEnded) {
  run_into("out.h5", macrospin_scene() + R"([[stage]]
integrator = { method = "classical_euler", dt = 100.0, steps = 1000 }
)",
           set("integrator.end=1000.0", "integrator.until_torque=1e-6", "output.every=1"));
  auto const found = info("out.h5");
  auto const stages = found.at("stage").get<std::vector<int>>();
  auto const first = std::ranges::count(stages, 0);
  ASSERT_GT(std::ranges::count(stages, 1), 0);
  auto const end = found.at("step").at(static_cast<std::size_t>(first - 1)).get<int>();
  EXPECT_LT(end, 10000);
  EXPECT_EQ(found.at("progress").at("steps"), end + 1000);
}

TEST_F(JsonOutput, MatchesTheFileOfASweep) {
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

TEST_F(JsonOutput, MatchesTheFileOfAnEnsemble) {
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
  expect_nulls(last, {"torque", "converged", "evaluations", "sublattice_magnetization"});
  expect_attributes(found, "all.h5",
                    {"replicas", "evaluations", "wall_seconds", "step_seconds", "complete"},
                    {"scene", "written_by", "space", "precision", "units"});
}

TEST_F(JsonOutput, HasTheSublatticesOfAnEnsemble) {
  write("all.toml", R"toml([system]
kind = "llg"
damping = 0.1
[lattice]
shape = [3, 2, 2]
crystal = "bcc"
[field]
couplings = { shells = [-1.0] }
[initial]
random = { seed = 3 }
[integrator]
method = "rkmk4"
dt = 0.02
steps = 5
[ensemble]
replicas = 2
)toml");
  expect_status(0, {"run", "all.toml", "--quiet", "--output", "all.h5"});
  auto const [extents, values] = read_dataset("all.h5", "/sublattice_magnetization");
  EXPECT_EQ(extents, (std::vector<std::int64_t>{2, 2, 2, 3}));
  auto const found = info("all.h5").at("last_frame").at("sublattice_magnetization");
  EXPECT_EQ(found.size(), 2U);
  EXPECT_EQ(found.at(0).size(), 2U);
  std::vector<double> means;
  append_numbers(found, means);
  EXPECT_EQ(means, std::vector(values.end() - 12, values.end()));
  // Each site of the cells has as many spins.
  auto const all = read_dataset("all.h5", "/magnetization").values;
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR((means[c] + means[3 + c]) / 2, all[6 + c], 1e-14);
  auto const text = output_of({"info", "all.h5"});
  EXPECT_TRUE(contains_all(text, {"\nreplica 1 ", "\n             site 1: magnetization ("}))
      << text;

  for (int const replica : {0, 1}) {
    expect_status(0,
                  joined({"run", "all.toml", "--quiet", "--output", "one.h5", "--overwrite"},
                         set("ensemble={}", fmt::format("initial.random.seed={}", 3 + replica))));
    auto const one = read_dataset("one.h5", "/sublattice_magnetization").values;
    EXPECT_EQ(std::vector(one.end() - 6, one.end()),
              std::vector(means.begin() + 6 * replica, means.begin() + 6 * replica + 6));
  }
}

// The name of a file may have any bytes. In JSON, bytes that are not UTF-8 are replaced.
TEST_F(JsonOutput, IsUtf8) {
  run(chain_scene());
  std::filesystem::rename(in_folder("out.h5"), in_folder("out\xff.h5"));
  EXPECT_EQ(info("out\xff.h5").at("file"), "out\xef\xbf\xbd.h5");
}

}  // namespace
}  // namespace cayspin::program::test
