// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Warnings of ensembles name a replica for which the steps are too long.
#include "program_test.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <string>

namespace cayspin::program::test {
namespace {

class EnsembleWarnings : public ProgramTest {
 protected:
  static std::string vary(std::string const& keys, std::int64_t replicas = 3) {
    return fmt::format("[ensemble]\nreplicas = {}\n[ensemble.vary]\n{}", replicas, keys);
  }
};

TEST_F(EnsembleWarnings, WarnOfAStepThatIsTooLongForOneReplica) {
  write("all.toml", chain_scene() + vary("\"field.exchange\" = [1, 1, 1e4]\n"));
  auto const outcome = start({"run", "all.toml", "--quiet", "--output", "all.h5"});
  EXPECT_TRUE(contains(outcome.errors, "warning: replica 2: ")) << outcome.errors;
  expect_refused({"run", "all.toml", "--quiet", "--output", "b.h5", "--set",
                  "integrator.refuse_unstable=true"},
                 "replica 2: all.toml:");
  EXPECT_FALSE(exists("b.h5"));
}

// Small replicas that differ in the applied field or the damping are stepped as the columns of one
// lattice, and so are those that differ in the temperature.
TEST_F(EnsembleWarnings, WarnOfTheReplicaWithTheLargestFieldOrDamping) {
  for (std::string const key : {"field.applied.0", "system.damping"}) {
    write("all.toml",
          chain_scene() + vary(fmt::format("\"{}\" = {{ from = 0.1, to = 1e4 }}\n", key), 32));
    auto const outcome = start({"run", "all.toml", "--quiet", "--overwrite", "--output", "all.h5"});
    EXPECT_TRUE(contains(outcome.errors, "warning: replica 31: ")) << key << outcome.errors;
    expect_refused({"run", "all.toml", "--quiet", "--output", "b.h5", "--set",
                    "integrator.refuse_unstable=true"},
                   "replica 31: all.toml:");
    EXPECT_FALSE(exists("b.h5"));
  }
}

TEST_F(EnsembleWarnings, WarnOfTheHottestReplica) {
  write("all.toml", chain_scene() + "[thermal]\ntemperature = 0.1\nseed = 3\n" +
                        vary("\"thermal.temperature\" = { from = 0.1, to = 15 }\n", 32));
  auto const options = set("integrator.dt=0.1", "system.damping=0.5");
  auto const outcome = start(joined({"run", "all.toml", "--quiet", "--output", "all.h5"}, options));
  EXPECT_TRUE(contains(outcome.errors, "warning: replica 31: ")) << outcome.errors;
  expect_refused(joined({"run", "all.toml", "--quiet", "--output", "b.h5", "--set",
                         "integrator.refuse_unstable=true"},
                        options),
                 "replica 31: ");
  EXPECT_FALSE(exists("b.h5"));
}

// No single replica has too much noise for this dt.
TEST_F(EnsembleWarnings, TakeAStepThatIsLongForATemperatureOfOne) {
  write("all.toml", chain_scene() + "[thermal]\ntemperature = 0.001\n" +
                        vary("\"thermal.temperature\" = { from = 0.001, to = 0.01 }\n", 32));
  expect_status(0, joined({"run", "all.toml", "--quiet", "--output", "all.h5"},
                          set("integrator.dt=0.55", "system.damping=2", "field.exchange=0.01")));
}

}  // namespace
}  // namespace cayspin::program::test
