// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The magnitude of a site's energy, to which the guard's limit of rises is proportional, where one
// pass evaluates all terms: it includes each term.
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

}  // namespace
}  // namespace cayspin::simulation::test
