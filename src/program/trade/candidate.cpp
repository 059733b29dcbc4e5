// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "candidate.hpp"

#include <fmt/format.h>

#include <limits>

namespace cayspin::program::trade {

std::string Candidate::name() const {
  std::string name(io::to_string(method));
  if (generator != io::Generator::standard) name += fmt::format(" {}", io::to_string(generator));
  if (rotation != io::Rotation::cayley && !io::needs_exponential(method))
    name += fmt::format(" {}", io::to_string(rotation));
  if (sigma != 0) name += fmt::format(" sigma {:.3g}", sigma);
  if (precision == Precision::single_precision) name += ", single";
  if (compensated) name += " compensated";
  return name;
}

double Candidate::least_tolerance() const {
  // As measured on films; the steps' number does not matter.
  if (compensated && precision == Precision::single_precision)
    return 4 * double(std::numeric_limits<float>::epsilon());
  return precision == Precision::single_precision ? StepOptions::least_tolerance<float>()
                                                  : StepOptions::least_tolerance<double>();
}

namespace {

double sum_of_couplings(io::Scene const& scene) {
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis)
    if (scene.lattice.shape[axis] > 1)
      sum += 2 * scene.field.exchange.value_or(0) /
             (scene.lattice.spacing[axis] * scene.lattice.spacing[axis]);
  return sum;
}

bool is_possible(io::Scene const& scene, Candidate const& candidate) {
  try {
    io::check_combination(with(scene, candidate, 1, 1, {1, 1}));
    return true;
  } catch (io::SceneError const&) {
    return false;
  }
}

}  // namespace

std::vector<Candidate> candidates(io::Scene const& scene) {
  using enum io::Method;
  using enum io::Generator;
  auto const exponential = io::Rotation::exponential;
  std::vector<Candidate> all{{rkmk4},
                             {rkmk4, tangent},
                             {rkmk5},
                             {rkmk5, tangent},
                             {rkmk8},
                             {rkmk8, tangent},
                             {cf4, standard, exponential},
                             {bs3},
                             {bs3, tangent},
                             {dp5},
                             {dp5, tangent},
                             {tsit5},
                             {tsit5, tangent},
                             {heun},
                             {heun, tangent},
                             {ab2},
                             {euler},
                             {implicit_midpoint},
                             {projected_heun},
                             {projected_rk4},
                             {projected_rk5},
                             {projected_rk8},
                             {projected_dp5}};
  // Exchange holds a multiple of the spin itself, which a constant sigma takes out: what is left
  // turns neighbours alike.
  if (double const sum = sum_of_couplings(scene); sum != 0)
    for (auto const method : {rkmk4, rkmk8, cf4, dp5, tsit5})
      all.push_back({.method = method, .sigma = sum});
  if (!io::depends_on_time(scene)) all.push_back({series4});
  for (auto const method : {fx3, fx4, red_black2, red_black4}) all.push_back({method});
  for (auto& candidate : all)
    if (io::needs_exponential(candidate.method)) candidate.rotation = exponential;
  std::erase_if(all, [&](Candidate const& candidate) { return !is_possible(scene, candidate); });
  auto const twice = all.size();
  for (std::size_t i = 0; i < twice; ++i) {
    auto const method = all[i].method;
    Candidate single = all[i];
    single.precision = Precision::single_precision;
    if (method == heun || method == rkmk4 || method == projected_rk4) all.push_back(single);
    single.compensated = io::takes_compensation(method);
    if (single.compensated) all.push_back(single);
  }
  return all;
}

io::Scene with(io::Scene scene, Candidate const& candidate, double horizon, std::int64_t looks,
               Steps const& steps) {
  auto& integrator = scene.integrator;
  integrator.method = candidate.method;
  integrator.generator = candidate.generator;
  integrator.rotation = candidate.rotation;
  integrator.isotropy = candidate.sigma != 0 ? io::Isotropy::constant : io::Isotropy::zero;
  integrator.sigma = candidate.sigma;
  integrator.compensated = candidate.compensated;
  integrator.until_torque.reset();
  integrator.error.reset();
  integrator.energy_control = false;
  integrator.min_dt = io::Integrator{}.min_dt;
  integrator.max_dt = io::Integrator{}.max_dt;
  if (candidate.is_adaptive()) {
    integrator.tolerance = steps.tolerance;
    integrator.steps = looks;
  } else {
    integrator.tolerance.reset();
    integrator.steps = steps.count;
  }
  integrator.dt = horizon / static_cast<double>(integrator.steps);
  scene.output.every = scene.output.scalars_every = integrator.steps / looks;
  return scene;
}

}  // namespace cayspin::program::trade
