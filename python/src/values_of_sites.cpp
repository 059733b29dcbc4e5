// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "values_of_sites.hpp"

#include "simulation/failure.hpp"
#include "simulation/turning_of_sites.hpp"

#include <stdexcept>
#include <utility>
#include <vector>

namespace cayspin::python {

SiteNumbersOut at_sites(io::Scene const& scene, std::string const& expression) {
  auto const& [nx, ny, nz] = scene.lattice.shape;
  try {
    io::SiteNumbers numbers;
    numbers.expression = expression;
    auto values =
        io::numbers_of_sites(scene, numbers, "at_sites", {{0, 0, 0}, scene.lattice.shape});
    return array_of(std::move(values), {nz, ny, nx});
  } catch (std::invalid_argument const& error) {
    throw simulation::UsageError(std::string("at_sites: ") + error.what());
  }
}

SiteNumbersOut moments_over_g(io::Scene const& scene) {
  auto const& [nx, ny, nz] = scene.lattice.shape;
  std::vector<double> values;
  {
    nb::gil_scoped_release const released;
    values = simulation::moments_over_g(scene);
  }
  return array_of(std::move(values), {nz, ny, nx});
}

}  // namespace cayspin::python
