// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Scenes with the field of all cells on all cells, beside the library's.
#include "scenes_of_text.hpp"
#include "simulation/dear_method.hpp"

#include <cayspin/cayspin.hpp>
#include <cayspin/demagnetization/demagnetizing_field.hpp>

#include <cmath>
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
          {"field.demag.dear=false",
           fmt::format("field.demag.periodic_images=[{},{},{}]", images[0], images[1], images[2])});
      auto const found = end_of(scene, precision);  // starts Kokkos
      auto const expected = precision == Precision::double_precision
                                ? end_by_steps<double>(scene, images)
                                : end_by_steps<float>(scene, images);
      EXPECT_LT(largest_distance(found, expected), 200 * epsilon(precision));
    }
}

TEST(Demagnetization, IsDearWhereTheMethodCan) {
  std::string const steps = "dt=0.05\nsteps=40\n";
  for (char const* const method : {"heun", "rkmk4", "rkmk8", "projected_rk4"})
    EXPECT_TRUE(has_dear_field(demag_film(fmt::format("method='{}'\n{}", method, steps))))
        << method;
  for (char const* const integrator :
       {"method='tsit5'\ntolerance=1e-4\nend=1", "method='ab2'\ndt=0.1\nsteps=9",
        "method='implicit_midpoint'\ndt=0.1\nsteps=9"})
    EXPECT_FALSE(has_dear_field(demag_film(integrator))) << integrator;
  EXPECT_FALSE(
      has_dear_field(demag_film("method='heun'\n" + steps, {"thermal={temperature=0.1}"})));
  EXPECT_FALSE(has_dear_field(demag_film("method='heun'\n" + steps, {"field.demag.dear=false"})));
  EXPECT_TRUE(has_dear_field(demag_film("method='auto'\nerror=1e-3\n" + steps)));
}

TEST(Demagnetization, OnceAStepConvergesToThatOfEachStage) {
  auto const exact =
      end_of(demag_film("method='rkmk8'\ndt=0.005\nsteps=200", {"field.demag.dear=false"}));
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
              {"field.demag.dear=true"},
              "takes no dear field"},
        {"method='red_black2'\ndt=0.1\nsteps=9", {}, "field.demag: method \"red_black2\""},
        {heun, {"lattice.crystal='bcc'"}, "field."}}) {
    SCOPED_TRACE(integrator);
    expect_refused([&] { return demag_film(integrator, overrides); }, message);
  }
}

}  // namespace
}  // namespace cayspin::simulation::test
