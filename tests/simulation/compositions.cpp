// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Random compositions of terms, shapes, site-dependent values, methods and precisions, compared
// with the library's own composed field. CAYSPIN_COMPOSITIONS is their number.
#include "../support/larger.hpp"
#include "composed_field.hpp"
#include "io/method.hpp"
#include "random_composition.hpp"
#include "scenes_of_text.hpp"

#include <cayspin/cayspin.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace cayspin::simulation::test {
namespace {

std::vector<double> numbers_of(std::vector<unsigned char> const& flags) {
  return {flags.begin(), flags.end()};
}

/// Counts of comparisons.
struct Seen {
  std::map<std::string, int> refused;  // times for each reason
  std::set<std::string_view> methods;
  unsigned moved = 0;  // compositions that move by much more than the allowed error
};

std::string_view key_of(std::string_view option) { return option.substr(0, option.find(' ')); }

void expect_same(unsigned seed, Seen& seen) {
  Composition composition(seed);
  auto& numbers = composition.numbers;
  auto const precision = composition.one_of(precisions);
  auto const* method = composition.one_of(io::methods());
  if (method->automatic) method = io::methods()[0];
  constexpr int steps = 4;
  double const h = 0.02, dt = h / numbers.scale;
  auto const text_with = [&](std::string_view word, std::string_view more) {
    return composition.text + fmt::format("[integrator]\nmethod = '{}'\ndt = {}\nsteps = {}\n{}\n",
                                          word, dt, steps, more);
  };
  static constexpr std::string_view options[] = {"isotropy = { constant = 0.3 }",
                                                 "isotropy = 'analytic'",
                                                 "isotropy = 'finite_difference_backward'",
                                                 "generator = 'tangent'",
                                                 "generator = 'orthogonal'",
                                                 "rotation = 'exponential'",
                                                 "compensated = true",
                                                 "energy_control = true",
                                                 "isotropy = 'finite_difference'"};
  std::string more = method->adaptive ? "tolerance = 1e-4\n" : "";
  if (composition.chance(0.4)) {
    auto const& option = composition.one_of(options);
    more += option;
    auto const& other = composition.one_of(options);
    if (composition.chance(0.3) && key_of(other) != key_of(option))
      more += fmt::format("\n{}", other);
  }
  auto text = text_with(method->word, more);
  std::optional<io::Scene> scene;
  try {
    scene = scene_of(text);
  } catch (io::SceneError const& error) {
    std::string const why = error.what();
    ++seen.refused[why.substr(why.find(": ") + 2)];
    method = io::find_method("heun");
    text = text_with("heun", "");
    scene = scene_of(text);
  }
  SCOPED_TRACE(fmt::format("seed {}, {} precision\n{}", seed, to_string(precision), text));
  io::SiteBox const box{{0, 0, 0}, numbers.lattice.shape};
  numbers.occupied = numbers_of(io::occupied(*scene, box));
  numbers.frozen = numbers_of(io::frozen(*scene, box));

  auto const run = SceneRun::open(*scene, {.precision = precision});
  auto const start = spins_of(*run);
  auto const field = composed_field(numbers);
  {
    auto const found = packed<double>(run->field().vectors);
    SpinField<double, Memory> spins("spins", numbers.lattice), wanted("field", numbers.lattice);
    copy_from_host(start, spins);
    evaluate_field(Space(), field, spins, 0, wanted);
    auto const expected = copy_to_host(wanted);
    double largest = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
      bool const is_site = numbers.occupied.empty() || numbers.occupied[i / 3] != 0;
      bool const moves = numbers.frozen.empty() || numbers.frozen[i / 3] == 0;
      if (is_site)
        largest = cayspin::test::larger(
            largest, std::abs(numbers.gyromagnetic * found[i] - moves * expected[i]));
    }
    // `expected` includes the gyromagnetic ratio.
    EXPECT_LT(largest, 64 * epsilon(precision) * numbers.scale);
  }
  if (!scene->field.torque.zhang_li && !scene->field.torque.slonczewski) {
    SpinField<double, Memory> spins("spins", numbers.lattice);
    copy_from_host(start, spins);
    EXPECT_NEAR(run->sample().energy.value, energy(Space(), field, spins, 0).value,
                64 * epsilon(precision) * numbers.scale * numbers.largest_moment /
                    numbers.gyromagnetic * static_cast<double>(numbers.lattice.sites()));
    double sum = 0;
    for (auto const& term : run->energies()) sum += term.second;
    EXPECT_NEAR(sum, run->sample().energy.value,
                64 * epsilon(precision) * numbers.scale * numbers.largest_moment /
                    numbers.gyromagnetic * static_cast<double>(numbers.lattice.sites()));
  }
  run->advance(scene->integrator.steps);
  auto const expected = spins_after(numbers, field, start, steps * dt);
  int const order = method->order;
  double const allowed = method->adaptive || method->stiff
                             ? 1e-4
                             : 8 * steps * std::pow(h, order + 1) + 64 * steps * epsilon(precision);
  EXPECT_LT(largest_distance(spins_of(*run), expected), allowed);
  seen.methods.insert(method->word);
  if (largest_distance(start, expected) > 4 * allowed) ++seen.moved;
}

TEST(Compositions, MatchTheComposedFieldOfTheLibrary) {
  end_of(
      llg_scene("0.1", "heun", 1, "lattice = { shape = [2] }\ninitial = { uniform = [0, 0, 1] }"));
  char const* const wanted = std::getenv("CAYSPIN_COMPOSITIONS");
  auto const count = static_cast<unsigned>(wanted ? std::atoi(wanted) : 200);
  Seen seen;
  for (unsigned seed = 0; seed < count; ++seed) expect_same(seed, seen);
  unsigned refusals = 0;
  for (auto const& [why, times] : seen.refused) {
    refusals += static_cast<unsigned>(times);
    fmt::print("refused {} times: {}\n", times, why);
  }
  fmt::print("{} refused of {}, {} methods, {} moved\n", refusals, count, seen.methods.size(),
             seen.moved);
  if (count < 200) return;
  // A third is refused. Of the 36 methods, four refuse most terms.
  EXPECT_GT(seen.methods.size(), 25U);
  EXPECT_LT(refusals, count / 2);
  EXPECT_GT(seen.moved, count / 4);
}

}  // namespace
}  // namespace cayspin::simulation::test
