// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Continued runs on lattices that are large enough for sweeps (cayspin::Path), with fields that
// allow and fields that prevent sweeps. CAYSPIN_RANDOM_RESTARTS is the number of runs, by default
// 10; 0 means each variant of each method once with each field and precision.
#include "random_run.hpp"
#include "scenes_of_text.hpp"
#include "simulation/failure.hpp"

#include <cayspin/detail/memory.hpp>

#include <cstdio>
#include <optional>
#include <string>
#include <vector>

namespace cayspin::simulation::test {
namespace {

constexpr std::int64_t steps = 6;

struct KindOfField {
  char const* name;
  char const* keys;
};
constexpr KindOfField fields[] = {
    {"local", "applied = [0.3, -0.2, 0.4]\n"},
    {"host-made", "slab_demag = { normal = [0, 0, 1], strength = 0.5, where = 'host' }\n"},
    {"of t", "applied = ['0.5*cos(7*t)', '0.1', '0.4*sin(3*t)']\n"},
#if defined(CAYSPIN_HAS_FFTW)
    {"of all sites", "demag = { strength = 0.5 }\n"},
#endif
};

// Returns enough planes for four fields to exceed the caches of all cores.
std::int64_t least_planes(Precision precision, std::int64_t sites_of_plane) {
  auto const cores = static_cast<std::size_t>(expected_threads());
  std::size_t const number = precision == Precision::single_precision ? 4 : 8;
  auto const sites = cores * cayspin::detail::core_cache_bytes() / (3 * 4 * number);
  return 1 + static_cast<std::int64_t>(sites) / sites_of_plane * 5 / 4;
}

/// Returns false if the scene is invalid or the run fails with numbers that are not finite.
bool gives_the_bits_of_passes(Variant const& variant, KindOfField const& field, Precision precision,
                              RandomRun& random) {
  static constexpr std::int64_t planes[][2] = {{40, 36}, {67, 21}, {128, 16}};
  auto const [nx, ny] = planes[random.below(3)];
  MethodChoice choice{.method = variant.method};
  choice.compensated = variant.compensated;
  choice.isotropy = variant.isotropy;
  if (variant.in_chart) choice.generator = io::Generator::tangent;
  auto keys = choice.keys();
  for (auto& c : keys)
    if (c == ',') c = '\n';
  auto const text = fmt::format(
      "[system]\nkind = 'llg'\ndamping = 0.1\n[lattice]\nshape = [{}, {}, {}]\nboundary = '{}'\n"
      "[field]\nexchange = 1.0\n{}[initial]\nrandom = {{ seed = {} }}\n"
      "[integrator]\n{}\ndt = 0.02\nsteps = {}\n{}",
      nx, ny, least_planes(precision, nx * ny), random.one_in(2) ? "open" : "periodic", field.keys,
      1 + random.below(1000), keys, steps, variant.method->adaptive ? "tolerance = 1e-4\n" : "");
  std::optional<io::Scene> scene;
  try {
    scene = scene_of(text);
    make_plan(*scene, precision);
  } catch (io::SceneError const&) {
    return false;
  }
  auto const cut = 1 + random.below(steps - 1);
  SCOPED_TRACE(fmt::format("{}{} precision, cut after {} steps", text, to_string(precision), cut));
  try {
    expect_same_bits_after_a_break(*scene, cut, precision);
  } catch (NumbersFailed const&) {
    return false;
  }
  return true;
}

TEST(RestartingSweeps, GivesTheBitsOfARunWithoutABreak) {
  auto const asked = setting("CAYSPIN_RANDOM_RESTARTS", 10);
  std::vector<Variant const*> suitable;
  for (auto const& variant : variants())
    if (!variant.of_rigid_bodies) suitable.push_back(&variant);
  std::int64_t done = 0;
  if (asked > 0) {
    for (std::int64_t draw = 0; done < asked && draw < 50 * asked && !HasFailure(); ++draw) {
      RandomRun random(random_seed() + 77, draw);
      auto const& variant = *suitable[static_cast<std::size_t>(random.below(std::ssize(suitable)))];
      // Half of the draws accept only methods that store a residual.
      if (draw % 2 == 0 && !variant.compensated) continue;
      auto const& field = fields[random.below(std::ssize(fields))];
      done += gives_the_bits_of_passes(variant, field, precisions[random.below(2)], random);
    }
  } else {
    for (auto const* const variant : suitable)
      for (auto const& field : fields)
        for (auto const precision : precisions) {
          if (HasFailure()) return;
          RandomRun random(random_seed(), done);
          done += gives_the_bits_of_passes(*variant, field, precision, random);
        }
  }
  std::printf("    %lld scenes\n", static_cast<long long>(done));
  EXPECT_GE(done, asked);
}

}  // namespace
}  // namespace cayspin::simulation::test
