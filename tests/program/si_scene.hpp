// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "program_test.hpp"

#include <cayspin/units.hpp>

#include <sstream>

namespace cayspin::program::test {

inline constexpr double gamma_e = 1.760859e11;

/// Formats numbers with 17 digits.
template <class... Parts>
std::string text(Parts const&... parts) {
  std::ostringstream stream;
  stream.precision(17);
  (stream << ... << parts);
  return stream.str();
}

/// Scenes in SI: a film of a material, and one atom.
class SiScene : public ProgramTest {
 protected:
  static std::string film(std::string const& integrator, std::string const& applied) {
    return R"(units = "SI"
[material]
Ms = 8e5
A = 1.3e-11
Ku = 5e4
axis = [0, 0, 1]
D = 1e-3
normal = [0, 0, 1]
alpha = 0.3
damping_form = "gilbert"
[system]
kind = "llg"
[lattice]
shape = [12, 5]
spacing = [4e-9, 5e-9, 3e-9]
[field]
slab_demag = { normal = [0, 0, 1], strength = 0.9 }
applied = )" +
           applied +
           R"(
[initial]
random = { seed = 5 }
[integrator]
)" + integrator +
           R"(
[output]
file = "si.h5"
every = 10
)";
  }
  static units::Micromagnetic units() {
    return units::Micromagnetic(
        {.Ms = 8e5, .cell = {4e-9, 5e-9, 3e-9}, .damping = units::gilbert(0.3)});
  }
  static std::string atom(std::string const& more = "") {
    return R"(units = "SI"
[material]
mu_s = { bohr_magnetons = 2.0 }
alpha = 0.1
damping_form = "gilbert"
[system]
kind = "llg"
[lattice]
shape = [1]
spacing = 3e-10
[field]
applied = [0, 0, 1.0]
[initial]
uniform = [3, 0, 4]
[integrator]
method = "rkmk4"
dt = 1e-13
end = 1e-11
)" + more;
  }

  void expect_times(char const* dataset, double apart) const {
    auto const times = read_dataset("out.h5", dataset).values;
    ASSERT_GT(times.size(), 1U);
    for (std::size_t i = 0; i < times.size(); ++i)
      EXPECT_NEAR(times[i], apart * double(i), 1e-9 * apart) << dataset;
  }
};

}  // namespace cayspin::program::test
