// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "candidate.hpp"

#include "simulation/multirate_method.hpp"
#include "simulation/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <limits>

namespace cayspin::program::trade {

std::string Candidate::name() const {
  std::string name(method->word);
  if (generator != io::Generator::standard) name += fmt::format(" {}", io::to_string(generator));
  if (rotation != method->usual_rotation()) name += fmt::format(" {}", io::to_string(rotation));
  if (sigma != 0) name += fmt::format(" sigma {:.3g}", sigma);
  if (precision == Precision::single_precision) name += ", single";
  if (compensated) name += " compensated";
  if (substeps > 0) name += fmt::format(", multirate, {}", counted(substeps, "substep"));
  return name;
}

double Candidate::least_tolerance() const {
  // This value was measured on films. It does not depend on the number of steps.
  if (compensated && precision == Precision::single_precision)
    return 4 * double(std::numeric_limits<float>::epsilon());
  return precision == Precision::single_precision ? StepOptions::least_tolerance<float>()
                                                  : StepOptions::least_tolerance<double>();
}

namespace {

// Returns a rate: (gyromagnetic ratio / moment) * (sum of a site's exchange couplings). Returns 0
// if this rate is not the same at all sites, or if it depends on t.
double rate_of_couplings(io::Scene const& scene) {
  auto const& lattice = scene.lattice;
  auto const rates = io::noise_of_cell_sites(scene);
  bool const is_uniform =
      !lattice.moments_of_sites.there() && !lattice.gyromagnetic_of_sites.there() &&
      !scene.field.exchange_factors.there() &&
      std::ranges::all_of(rates, [&](double rate) { return rate == rates.front(); });
  if (!is_uniform || scene.field.in_time.exchange != io::AppliedComponent(1.0)) return 0;
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis)
    if (lattice.shape[axis] > 1)
      sum += 2 * scene.field.exchange.value_or(io::Exchange{}).constant /
             (lattice.spacing[axis] * lattice.spacing[axis]);
  return rates.front() * sum;
}

bool is_possible(io::Scene const& scene, Candidate const& candidate, bool in_parts) {
  try {
    auto const tried = with(scene, candidate, 1, 1, {1, 1});
    io::check_combination(tried);
    auto const& variant = find_variant(tried);
    require_slow_field_fits(tried, variant);
    return !in_parts || variant.ghosts > 0;
  } catch (io::SceneError const&) {
    return false;
  }
}

// Returns the candidates in double precision. The list of methods says which variants of each
// method are tried.
std::vector<Candidate> in_double(io::Scene const& scene) {
  // Exchange adds a multiple of the spin itself to H, which does not turn the spin. If this
  // multiple is the same at all sites, a constant sigma removes it, and only the sum over the
  // neighbours remains.
  double const couplings = rate_of_couplings(scene);
  std::vector<Candidate> all;
  for (auto const* const method : io::methods()) {
    Candidate const plain{{.method = method, .rotation = method->usual_rotation()}};
    if (method->trials.contains(io::Trial::plain)) all.push_back(plain);
    if (method->trials.contains(io::Trial::in_chart)) {
      all.push_back(plain);
      all.back().generator = io::Generator::tangent;
    }
    if (method->trials.contains(io::Trial::sigma) && couplings != 0) {
      all.push_back(plain);
      all.back().isotropy = io::Isotropy::constant;
      all.back().sigma = couplings;
    }
  }
  if (has_slow_field(scene)) {
    auto const each_stage = all.size();
    for (std::size_t i = 0; i < each_stage; ++i)
      for (auto const substeps : {1, 2, 4}) {
        all.push_back(all[i]);
        all.back().substeps = substeps;
      }
  }
  std::ranges::stable_sort(all, std::greater{},
                           [](Candidate const& candidate) { return candidate.method->order; });
  return all;
}

}  // namespace

std::vector<Candidate> candidates(io::Scene const& scene, std::optional<Precision> precision,
                                  bool in_parts) {
  auto all = in_double(scene);
  auto const doubles = all.size();
  for (std::size_t i = 0; i < doubles; ++i) {
    auto single = all[i];
    single.precision = Precision::single_precision;
    auto const& trials = single.method->trials;
    if (trials.contains(io::Trial::single_precision)) all.push_back(single);
    single.compensated = true;
    if (trials.contains(io::Trial::compensated_single_precision)) all.push_back(single);
  }
  std::erase_if(all, [&](Candidate const& one) { return !is_possible(scene, one, in_parts); });
  if (precision)
    std::erase_if(all, [&](Candidate const& one) { return one.precision != *precision; });
  return all;
}

io::Scene with(io::Scene scene, Candidate const& candidate, double horizon, std::int64_t intervals,
               Steps const& steps) {
  auto& integrator = scene.integrator;
  candidate.put_into(integrator);
  if (scene.field.slab_demag) scene.field.slab_demag->multirate = candidate.substeps > 0;
  if (scene.field.demag) scene.field.demag->multirate = candidate.substeps > 0;
  integrator.until_torque.reset();
  integrator.error.reset();
  integrator.energy_control = false;
  integrator.min_dt = io::Integrator{}.min_dt;
  if (candidate.method->adaptive) {
    integrator.tolerance = steps.tolerance;
    integrator.steps = intervals;
  } else {
    integrator.tolerance.reset();
    integrator.steps = steps.count;
  }
  integrator.dt = horizon / static_cast<double>(integrator.steps);
  scene.output.every = scene.output.scalars_every = integrator.steps;
  return scene;
}

}  // namespace cayspin::program::trade
