// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Orders on the slab of Lewis and Nigam 2002 at damping 10, with constant sigma.
#include "../support/figures.hpp"
#include "../support/unit_slab.hpp"

#include <cayspin_paper/rkmk4_as_printed.hpp>

using namespace cayspin;
using namespace cayspin::test;

namespace {

using isotropy::Constant;
constexpr double round_off = 1e-13;
Vector const along_x{1, 0, 0};

template <class Stepper>
double order(Slab const& slab, double end_time, double sigma) {
  auto const reference = run<Rkmk4<Spins>>(slab.natural(), slab_start(), 0.00015625,
                                           std::llround(end_time / 0.00015625));
  std::vector<double> dts, errors;
  for (double const dt : {0.02, 0.01, 0.005, 0.0025, 0.00125}) {
    auto const end = run<Stepper>(slab.natural(), slab_start(), dt, std::llround(end_time / dt),
                                  Constant{sigma});
    double const error = largest_distance(end, reference);
    if (error < round_off) continue;
    dts.push_back(dt);
    errors.push_back(error);
  }
  EXPECT_GE(errors.size(), 3u);
  return fitted_order(dts, errors);
}

using Heun = LieHeun<Spins, Constant>;
using Corrected = Rkmk4<Spins, Constant>;
using Printed3 = Rkmk4AsPrinted<Spins, Constant>;

TEST(StrongDamping, WeakField) {
  Slab const slab = unit_slab({0.05, 0.05, 0}, 10, true, along_x);
  for (double const sigma : {-10.0, 0.0, 10.0}) {
    std::string const name = ", sigma " + std::to_string(static_cast<int>(sigma));
    expect_order("geometric Heun" + name, order<Heun>(slab, 1, sigma), 2, 0.05);
    expect_order("rkmk4" + name, order<Corrected>(slab, 1, sigma), 4, 0.05);
    expect_order("rkmk4 as printed" + name, order<Printed3>(slab, 1, sigma), 3, 0.05);
  }
}

// The coarsest step is just below the stability limit: not asymptotic.
TEST(StrongDamping, StrongField) {
  Slab const slab = unit_slab({5, 0, 0}, 10, true, along_x);
  for (double const sigma : {-40.0, -20.0, 0.0, 20.0, 40.0}) {
    std::string const name = ", sigma " + std::to_string(static_cast<int>(sigma));
    expect_order("geometric Heun" + name, order<Heun>(slab, 0.1, sigma), 2.11, 0.29);
    expect_order("rkmk4" + name, order<Corrected>(slab, 0.1, sigma), 4.145, 0.115);
    expect_order("rkmk4 as printed" + name, order<Printed3>(slab, 0.1, sigma), 3.16, 0.6);
  }
}

}  // namespace
