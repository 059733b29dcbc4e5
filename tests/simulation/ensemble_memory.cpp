// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Memory of ensembles of small replicas: the estimate is not below what separate runs take, and an
// ensemble that does not fit is refused.
#include "scenes_of_text.hpp"
#include "simulation/ensemble_plan.hpp"
#include "simulation/ensemble_run.hpp"
#include "simulation/kokkos_settings.hpp"
#include "simulation/text.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace cayspin::simulation::test {
namespace {

// Replicas that differ in exchange are not columns of a lattice.
io::Scene single_spins(int replicas) {
  return llg_scene("0.1", "rkmk4", 4,
                   fmt::format(R"([lattice]
shape = [1]
[field]
exchange = 1.0
applied = [0.3, 0, 0.1]
[initial]
random = {{ seed = 7 }}
[ensemble]
replicas = {}
vary."field.exchange" = {{ from = 0.1, to = 1 }}
)",
                               replicas));
}

// The estimate is that of the second replica, which is opened if the replicas are not columns. The
// texts of replicas differ in length.
double estimate_of(io::Scene const& scene) {
  auto const replica = io::replica_of(scene, 1);
  auto const precision = Precision::double_precision;
  return memory_of_replicas(replica, make_plan(replica, precision), precision,
                            scene.ensemble.replicas);
}

TEST(EnsembleMemory, OfSingleSpinsThatDoNotFitIsRefused) {
  auto const scene = single_spins(500);
  auto const needed = static_cast<std::int64_t>(estimate_of(scene));
  auto share = all_replicas(scene);
  share.available = needed + 1;
  EXPECT_NO_THROW(EnsembleRun(scene, {}, false, share));
  share.available = needed - 1;
  try {
    EnsembleRun const run(scene, {}, false, share);
    ADD_FAILURE() << "an ensemble that does not fit";
  } catch (io::SceneError const& error) {
    std::string const text = error.what();
    for (char const* const part : {"ensemble.replicas: the run needs ", " of memory, and ",
                                   " is available; accepted: fewer replicas"})
      EXPECT_NE(text.find(part), std::string::npos) << text;
  }
}

// Columns need no more than their lattices, which are far below the estimate for separate runs.
TEST(EnsembleMemory, OfColumnsIsNotThatOfSeparateRuns) {
  auto const scene = scene_of(single_spins(500).text, {"ensemble.vary={}"});
  auto share = all_replicas(scene);
  share.available = static_cast<std::int64_t>(estimate_of(scene)) / 4;
  EXPECT_NO_THROW(EnsembleRun(scene, {}, false, share));
}

// Chains are stepped as lattices of columns; the number of lattices depends on the machine. Each is
// an open run, and has another one for samples.
TEST(EnsembleMemory, OfColumnsCountsTheirRuns) {
  constexpr std::int64_t replicas = 640;
  std::string const field = "[field]\nexchange = 1.0\n[initial]\nrandom = { seed = 7 }\n";
  auto const scene = llg_scene(
      "0.1", "rkmk4", 4,
      "[lattice]\nshape = [64]\n" + field + fmt::format("[ensemble]\nreplicas = {}\n", replicas));
  if (!is_on_host(SceneRun::open(io::replica_of(scene, 0), {})->space()))
    GTEST_SKIP() << "on a device, one lattice has all columns";
  auto const refusal = [&](std::int64_t available) {
    auto share = all_replicas(scene);
    share.available = available;
    try {
      EnsembleRun const run(scene, {}, false, share);
    } catch (io::SceneError const& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  auto const needed_by = [&](std::int64_t lattices) {
    std::int64_t const columns = (replicas + lattices - 1) / lattices;
    auto const lattice = fmt::format("[lattice]\nshape = [{}, 64]\n", columns);
    auto const plan =
        make_plan(llg_scene("0.1", "rkmk4", 4, lattice + field), Precision::double_precision);
    return lattices * (plan.memory.total() + 2 * bytes_of_open_run + columns * bytes_of_column);
  };
  constexpr std::int64_t too_little = 1'000'000;
  auto const text = refusal(too_little);
  std::vector<std::int64_t> needed;
  for (std::int64_t lattices = 1; lattices <= replicas / 16; ++lattices)
    if (text.find(fmt::format("ensemble.replicas: the run needs {} of memory, and {} is "
                              "available; accepted: fewer replicas",
                              bytes_text(needed_by(lattices)), bytes_text(too_little))) !=
        std::string::npos)
      needed.push_back(needed_by(lattices));
  ASSERT_FALSE(needed.empty()) << text;
  auto const [least, most] = std::ranges::minmax(needed);
  EXPECT_EQ(refusal(most), "");
  EXPECT_NE(refusal(least - 1), "");
}

#if defined(__linux__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
double resident_bytes() {
  std::ifstream file("/proc/self/statm");
  double all = 0, resident = 0;
  file >> all >> resident;
  return resident * static_cast<double>(::sysconf(_SC_PAGESIZE));
}

TEST(EnsembleMemory, OfSingleSpinsIsNotAboveTheEstimate) {
  auto const scene = single_spins(1000);
  EnsembleRun const few(single_spins(20), {}, false);  // starts Kokkos
  double const before = resident_bytes();
  EnsembleRun const run(scene, {}, false);
  EXPECT_LE(resident_bytes() - before, 1.2 * estimate_of(scene));
}
#endif

}  // namespace
}  // namespace cayspin::simulation::test
