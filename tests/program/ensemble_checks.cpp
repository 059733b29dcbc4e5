// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// cayspin check of a scene with [ensemble]: the needs of one replica and of all.
#include "json_output.hpp"

#include <cstdint>
#include <iterator>
#include <string>
#include <vector>

namespace cayspin::program::test {
namespace {

class EnsembleChecks : public JsonOutput {
 protected:
  static std::string ensemble(std::string const& vary) {
    return "[ensemble]\nreplicas = 3\n" + vary;
  }
  /// Returns the bytes of the numbers in these datasets of all.h5.
  std::int64_t bytes_of(std::vector<std::string> const& names) const {
    std::int64_t bytes = 0;
    for (auto const& name : names) bytes += 8 * std::ssize(read_dataset("all.h5", name).values);
    return bytes;
  }
  static std::vector<std::string> series() {
    std::vector<std::string> names{"/spins"};
    for (std::string const group : {"/", "/scalars/"})
      for (std::string const name : {"time", "step", "energy", "norm_defect", "magnetization"})
        names.push_back(group + name);
    return names;
  }
};

TEST_F(EnsembleChecks, TotalsOfARunAreThoseOfItsFile) {
  auto const scene =
      film + "[integrator]\nmethod = 'rkmk4'\ndt = 1e-3\nsteps = 10\n[output]\nevery = 4\n" +
      "scalars_every = 2\n";
  write("one.toml", scene);
  write("all.toml", scene + ensemble("vary = { \"field.exchange\" = [10, 20, 30] }\n"));
  auto const one = json_of({"check", "one.toml"}), all = json_of({"check", "all.toml"});
  EXPECT_FALSE(one.contains("replicas"));
  for (char const* const key : {"memory_bytes", "file_bytes", "steps", "sites", "frames"})
    EXPECT_EQ(all.at(key), one.at(key)) << key;

  expect_status(0, {"run", "all.toml", "--quiet", "--output", "all.h5"});
  auto names = series();
  names.push_back("/vary/field.exchange");
  auto const& totals = all.at("all_replicas");
  EXPECT_EQ(all.at("replicas"), 3);
  EXPECT_EQ(totals.at("file_bytes"), bytes_of(names));
  EXPECT_EQ(totals.at("evaluations"), info("all.h5").at("evaluations"));
  auto const needed = totals.at("memory_bytes").get<double>();
  EXPECT_GT(needed,
            3 * (one.at("memory_bytes").get<double>() - one.at("host_buffer_bytes").get<double>()));

  auto const text = output_of({"check", "all.toml"});
  EXPECT_TRUE(contains_all(text, {"\nreplicas    3 in all: ",
                                  " of memory as separate runs, 120 "
                                  "evaluations of the field\n"}))
      << text;
}

TEST_F(EnsembleChecks, TotalsOfASearchAreThoseOfItsFile) {
  write("all.toml", film + ensemble("vary = { \"field.exchange\" = [10, 20, 30] }\n"));
  auto const found = json_of({"check", "all.toml"});
  expect_status(0, {"relax", "all.toml", "--quiet", "--output", "all.h5"});
  auto names = series();
  names.insert(names.end(), {"/vary/field.exchange", "/torque", "/converged", "/evaluations"});
  EXPECT_EQ(found.at("replicas"), 3);
  EXPECT_EQ(found.at("all_replicas").at("file_bytes"), bytes_of(names));
  EXPECT_TRUE(found.at("all_replicas").at("evaluations").is_null());
}

TEST_F(EnsembleChecks, CountWhatEachSeparateRunTakes) {
  write("all.toml",
        macrospin_scene() + ensemble("vary = { \"system.damping\" = { from = 0.1, to = 1 } }\n"));
  auto const memory = [&](std::string const& replicas) {
    return json_of(joined({"check", "all.toml"}, set("ensemble.replicas=" + replicas)))
        .at("all_replicas")
        .at("memory_bytes")
        .get<double>();
  };
  // A single spin has 24 bytes; the objects of its run have about 50 kB.
  double const of_one = (memory("1001") - memory("1")) / 1000;
  EXPECT_GT(of_one, 40e3);
  EXPECT_LT(of_one, 80e3);
}

}  // namespace
}  // namespace cayspin::program::test
