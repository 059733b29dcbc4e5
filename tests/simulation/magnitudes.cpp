// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Tests that the magnitude of a site's energy includes every term if one pass evaluates all terms.
// The guard's limit on a rise of the energy is proportional to this magnitude.
#include "scenes_of_text.hpp"

#include <cstdint>
#include <string>

namespace cayspin::simulation::test {
namespace {

double magnitude_of(io::Scene const& scene) {
  return SceneRun::open(scene, {})->sample().energy.magnitude;
}

io::Scene with_a_vacancy(std::string const& field) {
  return llg_scene("0.5", "rkmk4", 1,
                   "lattice = { shape = [4], occupied = 'i > 0' }\n"
                   "initial = { uniform = [0, 0, 1] }\nfield = { " +
                       field + " }\n");
}

TEST(Magnitudes, IncludeDemagnetization) {
  for (std::string const field : {
           "slab_demag = { normal = [0, 0, 1], strength = 0.5 }",
           "slab_demag = { normal = [0, 0, 1], strength = 0.5, where = 'host' }",
#ifdef CAYSPIN_HAS_FFTW
           "demag = { strength = 0.5 }",
#endif
       })
    EXPECT_GE(magnitude_of(with_a_vacancy(field + ", mu0 = 2")), 3 * 0.5) << field;
}

TEST(Magnitudes, IncludeTheFieldOfAProgram) {
  auto scene = with_a_vacancy("applied = [0, 0, 0]");
  scene.field.own.nonlocal = [](io::HostVectors const& spins, io::HostVectors const& field,
                                double) {
    auto const* const m = static_cast<double const*>(spins.data);
    auto* const h = static_cast<double*>(field.data);
    for (std::int64_t i = 0; i < 4; ++i)
      for (std::int64_t c = 0; c < 3; ++c)
        h[i * field.strides[2] + c * field.strides[3]] =
            -8 * m[i * spins.strides[2] + c * spins.strides[3]];
  };
  EXPECT_NEAR(magnitude_of(scene), 3 * 4, 1e-12);
}

// Parallel spins have no energy of exchange or DMI, so the magnitude follows only from the
// strengths of the bonds.
TEST(Magnitudes, IncludeDmiAtAnySpacing) {
  auto const magnitude = [](std::string const& dmi) {
    return magnitude_of(llg_scene("0.5", "rkmk4", 1,
                                  "lattice = { shape = [6, 6], spacing = [1e-4, 2e-4] }\n"
                                  "initial = { uniform = [0, 0, 1] }\nfield = { dmi = " +
                                      dmi + " }\n"));
  };
  double const expected = 36 * 1e-4 * (1e4 + 5e3);
  for (std::string const dmi :
       {"{ bulk = 1e-4 }", "{ bulk = 'i < 9 ? 1e-4 : 0' }", "{ d2d = 1e-4 }",
        "{ interfacial = 'i < 9 ? 1e-4 : 0', normal = [0, 0, 1] }"})
    EXPECT_NEAR(magnitude(dmi), expected, 1e-9) << dmi;
  // A DMI with site-dependent normals is a sum of three terms.
  EXPECT_NEAR(magnitude("{ interfacial = 1e-4, normal = ['0', '0', 'i < 9 ? 1 : 0'] }"),
              3 * expected, 1e-9);
}

TEST(Magnitudes, IncludeTheFactorOfABond) {
  auto const magnitude = [](std::string const& factor) {
    return magnitude_of(
        llg_scene("0.5", "rkmk4", 1,
                  "lattice = { shape = [2], regions = 'i' }\ninitial = { uniform = [0, 0, 1] }\n"
                  "field = { exchange = 1, exchange_between = [{ between = [0, 1], factor = " +
                      factor + " }] }\n"));
  };
  EXPECT_NEAR(magnitude("-1e5"), 1e5 * magnitude("1"), 1e-5);
  EXPECT_NEAR(magnitude("0.5"), magnitude("1"), 1e-12);
}

}  // namespace
}  // namespace cayspin::simulation::test
