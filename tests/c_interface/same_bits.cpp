// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Runs by the C interface, and by example programs in C and Fortran, are bitwise identical to
// `cayspin run`.
#include "../program/program_test.hpp"
#include "c_interface_test.hpp"

#include <cstdint>
#include <filesystem>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

using namespace cayspin::test;

namespace {

auto const scene = std::filesystem::path(CAYSPIN_SCENES) / "slab_switching.toml";

class SameBits : public cayspin::program::test::ProgramTest {
 protected:
  std::vector<double> of_program(std::string const& precision = "double") {
    auto const done = start(
        {"run", scene.string(), "--output", "program.h5", "--precision", precision, "--quiet"});
    EXPECT_EQ(done.status, 0) << done.errors;
    return last_spins("program.h5");
  }
  void expect_from(char const* example) {
    auto const theirs = of_program();
    auto const done = start({scene.string(), "example.h5"}, {.program = example});
    EXPECT_EQ(done.status, 0) << done.errors;
    EXPECT_NE(done.output.find("E = "), std::string::npos) << done.output;
    EXPECT_EQ(last_spins("example.h5"), theirs);
  }
};

TEST_F(SameBits, StepsInPieces) {
  for (auto const precision : {CAYSPIN_SINGLE, CAYSPIN_DOUBLE}) {
    cayspin_simulation* simulation = nullptr;
    ASSERT_EQ(cayspin_open_file(scene.c_str(), precision, nullptr, &simulation), CAYSPIN_OK);
    Simulation const owner(simulation);
    for (int64_t const count : {1, 7, 0, 492, 700})
      ASSERT_EQ(cayspin_step(simulation, count), CAYSPIN_OK) << cayspin_last_error();
    EXPECT_EQ(spins_of(simulation), of_program(precision == CAYSPIN_SINGLE ? "single" : "double"));
    std::filesystem::remove(in_folder("program.h5"));
  }
}

TEST_F(SameBits, RunWithAFile) {
  auto const theirs = of_program();
  cayspin_simulation* simulation = nullptr;
  ASSERT_EQ(cayspin_open_file(scene.c_str(), CAYSPIN_DOUBLE, nullptr, &simulation), CAYSPIN_OK);
  Simulation const owner(simulation);
  ASSERT_EQ(cayspin_run(simulation, in_folder("mine.h5").c_str(), 0), CAYSPIN_OK)
      << cayspin_last_error();
  for (char const* dataset : {"spins", "energy", "time", "norm_defect"})
    EXPECT_EQ(read_dataset("mine.h5", dataset).values, read_dataset("program.h5", dataset).values)
        << dataset;
  EXPECT_EQ(last_spins("mine.h5"), theirs);
}

#ifdef CAYSPIN_EXAMPLE_C
TEST_F(SameBits, ExampleInC) { expect_from(CAYSPIN_EXAMPLE_C); }
#endif
#ifdef CAYSPIN_EXAMPLE_FORTRAN
TEST_F(SameBits, ExampleInFortran) { expect_from(CAYSPIN_EXAMPLE_FORTRAN); }

// The example prints the energy and the mean spin of each replica after 100 steps, with all digits.
TEST_F(SameBits, ExampleOfAnEnsembleInFortran) {
  auto const file = write("ensemble.toml", scene_text("[ensemble]\nreplicas = 3\n"
                                                      "vary.\"field.applied.0\" = [0, 0.5, 2]\n"));
  auto const done = start({file.string()}, {.program = CAYSPIN_EXAMPLE_FORTRAN_ENSEMBLE});
  EXPECT_EQ(done.status, 0) << done.errors;
  std::istringstream output(done.output);
  std::vector<double> const printed{std::istream_iterator<double>(output), {}};

  cayspin_ensemble* ensemble = nullptr;
  ASSERT_EQ(cayspin_ensemble_open_file(file.c_str(), CAYSPIN_DOUBLE, nullptr, &ensemble),
            CAYSPIN_OK);
  Ensemble const owner(ensemble);
  ASSERT_EQ(cayspin_ensemble_step(ensemble, 100), CAYSPIN_OK) << cayspin_last_error();
  double energies[3] = {}, m[9] = {};
  ASSERT_EQ(cayspin_ensemble_energies(ensemble, energies), CAYSPIN_OK);
  ASSERT_EQ(cayspin_ensemble_magnetizations(ensemble, m), CAYSPIN_OK);
  std::vector<double> expected;
  for (int replica = 0; replica < 3; ++replica) {
    expected.push_back(energies[replica]);
    expected.insert(expected.end(), &m[3 * replica], &m[3 * replica] + 3);
  }
  EXPECT_EQ(printed, expected) << done.output;
}
#endif

}  // namespace
