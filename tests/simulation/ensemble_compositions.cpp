// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Random compositions of terms, shapes, site-dependent values, methods and precisions as ensembles:
// each replica has the bits of a run of its own.
#include "io/method.hpp"
#include "random_composition.hpp"
#include "scenes_of_text.hpp"
#include "simulation/ensemble_run.hpp"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

namespace cayspin::simulation::test {
namespace {

constexpr std::int64_t replicas_of_composition = 3;

template <class Real>
std::vector<double> numbers_of_replica(std::vector<std::byte> const& all, std::int64_t replica) {
  auto const bytes = all.size() / static_cast<std::size_t>(replicas_of_composition);
  std::vector<Real> numbers(bytes / sizeof(Real));
  std::memcpy(numbers.data(), all.data() + static_cast<std::size_t>(replica) * bytes, bytes);
  return {numbers.begin(), numbers.end()};
}

/// Returns false if the scene is large or is refused, for example by its method.
bool has_the_bits_of_runs(unsigned seed) {
  Composition composition(seed);
  auto const& numbers = composition.numbers;
  auto const precision = composition.one_of(precisions);
  auto const* const method = composition.one_of(io::methods());
  if (method->automatic || numbers.lattice.sites() > 1000) return false;
  constexpr int steps = 6;
  auto text = composition.text +
              fmt::format(
                  "[integrator]\nmethod = '{}'\ndt = {}\nsteps = {}\n{}[ensemble]\nreplicas "
                  "= {}\n",
                  method->word, 0.02 / numbers.scale, steps,
                  method->adaptive ? "tolerance = 1e-4\n" : "", replicas_of_composition);
  if (numbers.damping_of_sites.empty()) text += "vary.\"system.damping\" = [0.1, 0.3, 0.05]\n";
  std::optional<io::Scene> scene;
  try {
    scene = scene_of(text);
  } catch (io::SceneError const&) {
    return false;
  }
  SCOPED_TRACE(fmt::format("seed {}, {} precision\n{}", seed, to_string(precision), text));
  EnsembleRun run(*scene, {.precision = precision}, false);
  EXPECT_EQ(run.advance(steps, run.looks(false, {})), Advanced::whole);
  auto const all = run.spins();
  auto const scalars = run.scalars();
  for (std::int64_t const replica : {0, 2}) {
    auto const own = SceneRun::open(io::replica_of(*scene, replica), {.precision = precision});
    own->advance(steps);
    auto const found = precision == Precision::double_precision
                           ? numbers_of_replica<double>(all, replica)
                           : numbers_of_replica<float>(all, replica);
    auto const expected = spins_of(*own);
    EXPECT_TRUE(found == expected)
        << "replica " << replica << " is " << largest_distance(found, expected) << " apart";
    EXPECT_EQ(scalars[static_cast<std::size_t>(replica)].energy, own->sample().energy.value);
  }
  return true;
}

TEST(EnsembleCompositions, HaveTheBitsOfRunsOfTheirOwn) {
  int compared = 0;
  for (unsigned seed = 1000; seed < 1032; ++seed) compared += has_the_bits_of_runs(seed);
  EXPECT_GT(compared, 8);
}

}  // namespace
}  // namespace cayspin::simulation::test
