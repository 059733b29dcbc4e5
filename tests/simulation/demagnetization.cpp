// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Scenes with a demagnetising field, compared with the library's steppers and with sums over pairs.
#include "../support/larger.hpp"
#include "scenes_of_text.hpp"
#include "simulation/multirate_method.hpp"

#include <cayspin/cayspin.hpp>
#include <cayspin/demagnetization/demagnetizing_field.hpp>

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace cayspin::simulation::test {
namespace {

io::Scene demag_film(std::string const& integrator,
                     std::vector<std::string> const& overrides = {}) {
  return scene_of(R"toml(
[system]
kind = "llg"
damping = 0.1
[lattice]
shape = [9, 6, 2]
spacing = [1.0, 1.5, 0.5]
[field]
exchange = 0.5
applied = [0.1, 0, 0.2]
demag = { strength = 0.8 }
[initial]
random = { seed = 5 }
[integrator]
)toml" + integrator,
                  overrides);
}

template <class Real>
std::vector<double> end_by_steps(io::Scene const& scene, std::array<int, 3> const& images) {
  using Spins = SpinField<Real>;
  Kokkos::DefaultExecutionSpace const exec;
  Lattice const lattice{.shape = scene.lattice.shape, .spacing = scene.lattice.spacing};
  Spins spins("spins", lattice);
  copy_from_host(io::initial_spins(scene), spins);
  HostField const demag(spins, DemagnetizingField<Real>(lattice, {0.8, images}));
  LandauLifshitz const generator(
      EffectiveField(Exchange(lattice, 0.5), demag, Zeeman{{0.1, 0, 0.2}}), 0.1);
  LieHeun<Spins> stepper(spins);
  integrate(exec, stepper, generator, spins, Times{0, scene.integrator.dt, scene.integrator.steps});
  auto const end = copy_to_host(spins);
  return {end.begin(), end.end()};
}

TEST(Demagnetization, OfScenesIsThatOfTheLibrary) {
  for (auto const precision : precisions)
    for (auto const& images : {std::array{0, 0, 0}, {2, 1, 0}}) {
      auto const scene = demag_film(
          "method='heun'\ndt=0.05\nsteps=40",
          {"field.demag.multirate=false",
           fmt::format("field.demag.periodic_images=[{},{},{}]", images[0], images[1], images[2])});
      auto const found = end_of(scene, precision);  // starts Kokkos
      auto const expected = precision == Precision::double_precision
                                ? end_by_steps<double>(scene, images)
                                : end_by_steps<float>(scene, images);
      EXPECT_LT(largest_distance(found, expected), 200 * epsilon(precision));
    }
}

/// Returns the field of all sources at each site, summed over all pairs of cells and their images.
/// The number of cells along axes with images has to be odd: each pair then has one nearest image.
std::vector<double> sum_over_pairs(Lattice const& lattice, std::array<int, 3> const& images,
                                   std::vector<double> const& sources) {
  std::vector<double> field(sources.size());
  auto const place = [&](std::int64_t site) {
    std::int64_t const nx = lattice.shape[0], ny = lattice.shape[1];
    return std::array{site % nx, site / nx % ny, site / (nx * ny)};
  };
  auto const distances = [&](std::size_t axis, std::int64_t apart) {
    std::int64_t const n = lattice.shape[axis];
    std::vector<double> found;
    if (images[axis] > 0 && 2 * std::abs(apart) > n) apart -= apart > 0 ? n : -n;
    for (int image = -images[axis]; image <= images[axis]; ++image)
      found.push_back(static_cast<double>(apart + image * n) * lattice.spacing[axis]);
    return found;
  };
  for (std::int64_t site = 0; site < lattice.sites(); ++site)
    for (std::int64_t other = 0; other < lattice.sites(); ++other) {
      auto const a = place(site), b = place(other);
      double const* const m = &sources[3 * static_cast<std::size_t>(other)];
      double* const h = &field[3 * static_cast<std::size_t>(site)];
      for (double const x : distances(0, a[0] - b[0]))
        for (double const y : distances(1, a[1] - b[1]))
          for (double const z : distances(2, a[2] - b[2])) {
            auto const n = demagnetizing_tensor({x, y, z}, lattice.spacing);
            h[0] -= n.xx * m[0] + n.xy * m[1] + n.xz * m[2];
            h[1] -= n.xy * m[0] + n.yy * m[1] + n.yz * m[2];
            h[2] -= n.xz * m[0] + n.yz * m[1] + n.zz * m[2];
          }
    }
  return field;
}

// About a quarter of the random moments are 0.
TEST(Demagnetization, OfMomentsIsTheSumOverAllPairsOfCells) {
  struct Box {
    std::array<std::int64_t, 3> shape;
    std::array<double, 3> spacing;
    std::array<int, 3> images;
  };
  for (auto const& [shape, spacing, images] : {Box{{13, 9, 1}, {1, 1.5, 0.3}, {0, 0, 0}},
                                               {{7, 5, 4}, {1, 0.7, 1.3}, {0, 0, 0}},
                                               {{9, 7, 1}, {1, 1, 2}, {1, 2, 0}},
                                               {{5, 4, 3}, {0.8, 1, 1.1}, {2, 0, 1}}}) {
    auto const periodic = [&](std::size_t axis) { return images[axis] > 0 ? "periodic" : "open"; };
    auto const scene =
        scene_of(fmt::format(R"toml(
system = {{ kind = "llg", damping = 0 }}
[lattice]
shape = [{}]
spacing = [{}]
boundary = ["{}", "{}", "{}"]
moments = "random(i + 20*j + 400*k, 1) < 0.25 ? 0 : 0.1 + 2*random(i + 20*j + 400*k, 2)"
[field]
demag = {{ strength = 1.7, periodic_images = [{}], multirate = false }}
[initial]
random = {{ seed = 5 }}
[integrator]
method = "heun"
dt = 0.05
steps = 1
)toml",
                             fmt::join(shape, ", "), fmt::join(spacing, ", "), periodic(0),
                             periodic(1), periodic(2), fmt::join(images, ", ")));
    Lattice const lattice{.shape = shape, .spacing = spacing};
    auto const moments = io::moments_of_sites(scene, {{0, 0, 0}, shape});
    ASSERT_GT(std::count(moments.begin(), moments.end(), 0.0), 5);
    for (auto const precision : precisions) {
      auto const run = SceneRun::open(scene, {.precision = precision});
      auto sources = spins_of(*run);
      for (std::size_t i = 0; i < sources.size(); ++i) sources[i] *= 1.7 * moments[i / 3];
      auto const expected = sum_over_pairs(lattice, images, sources);
      auto const found = packed<double>(run->field().vectors);
      double largest = 0, error = 0, energy = 0;
      for (std::size_t i = 0; i < found.size(); ++i) {
        largest = cayspin::test::larger(largest, std::abs(expected[i]));
        energy -= sources[i] / 1.7 * expected[i] / 2;
        if (moments[i / 3] != 0)
          error = cayspin::test::larger(error, std::abs(found[i] - expected[i]));
      }
      SCOPED_TRACE(fmt::format("{}", fmt::join(shape, ", ")));
      EXPECT_LT(error, 450 * epsilon(precision) * largest);  // 1e-13 in double
      EXPECT_NEAR(run->sample().energy.value, energy, 450 * epsilon(precision) * std::abs(energy));
    }
  }
}

TEST(Demagnetization, IsMultirateWhereTheMethodCan) {
  std::string const steps = "dt=0.05\nsteps=40\n";
  for (char const* const method : {"heun", "rkmk4", "rkmk8", "projected_rk4"})
    EXPECT_TRUE(has_slow_field(demag_film(fmt::format("method='{}'\n{}", method, steps))))
        << method;
  for (char const* const integrator :
       {"method='tsit5'\ntolerance=1e-4\nend=1", "method='ab2'\ndt=0.1\nsteps=9",
        "method='implicit_midpoint'\ndt=0.1\nsteps=9"})
    EXPECT_FALSE(has_slow_field(demag_film(integrator))) << integrator;
  EXPECT_FALSE(
      has_slow_field(demag_film("method='heun'\n" + steps, {"thermal={temperature=0.1}"})));
  EXPECT_FALSE(
      has_slow_field(demag_film("method='heun'\n" + steps, {"field.demag.multirate=false"})));
  EXPECT_TRUE(has_slow_field(demag_film("method='auto'\nerror=1e-3\n" + steps)));
}

TEST(Demagnetization, OnceAStepConvergesToThatOfEachStage) {
  auto const exact =
      end_of(demag_film("method='rkmk8'\ndt=0.005\nsteps=200", {"field.demag.multirate=false"}));
  double errors[2];
  for (int i = 0; i < 2; ++i) {
    int const steps = 40 << i;
    errors[i] =
        largest_distance(end_of(demag_film(fmt::format(
                             "method='rkmk4'\nsubsteps=2\ndt={}\nsteps={}", 1. / steps, steps))),
                         exact);
  }
  EXPECT_NEAR(std::log2(errors[0] / errors[1]), 3, 0.3);
  EXPECT_LT(errors[1], 1e-5);
}

TEST(Demagnetization, GoesOnWithTheSameBits) {
  for (auto const precision : precisions)
    for (char const* const integrator :
         {"method='rkmk4'\nsubsteps=3\ndt=0.05\nsteps=20", "method='ab2'\ndt=0.05\nsteps=20"}) {
      SCOPED_TRACE(integrator);
      expect_same_bits_after_a_break(demag_film(integrator), 7, precision);
    }
}

TEST(Demagnetization, IsRefusedInOneLine) {
  struct Wrong {
    std::string integrator;
    std::vector<std::string> overrides;
    std::string message;
  };
  std::string const heun = "method='heun'\ndt=0.05\nsteps=40\n";
  for (auto const& [integrator, overrides, message] :
       {Wrong{"method='tsit5'\ntolerance=1e-4\nend=1",
              {"field.demag.multirate=true"},
              "takes no expensive field"},
        {"method='red_black2'\ndt=0.1\nsteps=9", {}, "field.demag: method \"red_black2\""},
        {heun, {"lattice.crystal='bcc'"}, "field."}}) {
    SCOPED_TRACE(integrator);
    expect_refused([&] { return demag_film(integrator, overrides); }, message);
  }
}

}  // namespace
}  // namespace cayspin::simulation::test
