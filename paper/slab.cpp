// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "slab.hpp"

#include "choices.hpp"
#include "host_job.hpp"
#include "host_steps.hpp"
#include "statistics.hpp"

#include <algorithm>

namespace cayspin::paper {
namespace {

constexpr int sites = 100, watched = 37;
constexpr double finest_dt = 0.00015625, round_off = 1e-13;

io::Scene slab_scene(Slab const& slab) {
  io::Scene scene;
  scene.system.damping = slab.damping;
  scene.system.precession = slab.precession;
  scene.lattice.shape = {sites, 1, 1};
  scene.field.exchange = io::Exchange{1};
  scene.field.anisotropies = {{1, slab.axis}};
  auto const [x, y, z] = slab.applied;
  scene.field.applied = {x, y, z};
  scene.field.slab_demag = io::SlabDemagnetization{{1, 0, 0}};
  scene.initial = io::ExpressionStart{{"0.3 + 0.2*cos(pi*x)", "0.5 + 0.1*cos(2*pi*x)", "0.8"}};
  return scene;
}

std::vector<Vector> as_vectors(std::vector<double> const& numbers) {
  std::vector<Vector> vectors;
  for (std::size_t i = 0; i < numbers.size(); i += 3)
    vectors.push_back({numbers[i], numbers[i + 1], numbers[i + 2]});
  return vectors;
}

void record(SlabPath& path, double time, std::vector<Vector> const& spins) {
  path.times.push_back(time);
  path.spin.push_back(spins[watched]);
  double largest = 0;
  for (auto const& m : spins) {
    double const logarithm = 0.5 * std::log(dot(m, m));
    if (!(std::abs(logarithm) <= std::abs(largest))) largest = logarithm;
  }
  path.logarithms.push_back(largest);
}

std::vector<Vector> all_spins(HostSpins const& spins) {
  std::vector<Vector> vectors;
  for (std::int64_t i = 0; i < spins.sites(); ++i) vectors.push_back(spins.get(i));
  return vectors;
}

class WatchSpin : public HostObserver {
 public:
  WatchSpin(SlabPath& path, std::int64_t period) : path_(path), period_(period) {}
  bool due(Step const& step) const override { return step.number % period_ == 0; }
  Next operator()(HostSpace const&, Step const& step, HostSpins const& spins) override {
    record(path_, step.time, all_spins(spins));
    return Next::proceed;
  }

 private:
  SlabPath& path_;
  std::int64_t period_;
};

// Returns A_o of the slab at site i: A without its part along m.
Vector orthogonal_generator(Slab const& slab, std::vector<Vector> const& spins, std::size_t i) {
  Vector const& m = spins[i];
  Vector h{slab.applied[0] - m.x, slab.applied[1], slab.applied[2]};
  Vector const axis{slab.axis[0], slab.axis[1], slab.axis[2]};
  h = multiply_add(dot(m, axis), axis, h);
  if (i > 0) h = h + (spins[i - 1] - m);
  if (i + 1 < spins.size()) h = h + (spins[i + 1] - m);
  Vector const damped = slab.damping * cross(m, h);
  return orthogonal_part(slab.precession ? h + damped : damped, m);
}

std::vector<Vector> generators(Slab const& slab, std::vector<Vector> const& spins) {
  std::vector<Vector> w(spins.size());
  for (std::size_t i = 0; i < w.size(); ++i) w[i] = orthogonal_generator(slab, spins, i);
  return w;
}

std::vector<Vector> rotated(std::vector<Vector> spins, double dt, std::vector<Vector> const& a) {
  for (std::size_t i = 0; i < spins.size(); ++i)
    spins[i] = Cayley::rotate(Vector(dt * a[i]), spins[i]);
  return spins;
}

// Returns -<A_o', A_o x m> / |A_o|^2 of every site, where A_o is w, and A_o' = (other - w) / dt.
std::vector<double> sigmas(std::vector<Vector> const& spins, std::vector<Vector> const& w,
                           std::vector<Vector> const& other, double dt) {
  std::vector<double> sigma(spins.size());
  for (std::size_t i = 0; i < sigma.size(); ++i) {
    double const square = dot(w[i], w[i]);
    if (square == 0) continue;
    sigma[i] = dot(w[i] - other[i], cross(w[i], spins[i])) / (dt * square);
  }
  return sigma;
}

}  // namespace

SlabPath run_slab(Slab const& slab, MethodChoice const& choice, double dt, int looks) {
  auto scene = slab_scene(slab);
  scene.integrator = integrator_of(choice, dt, slab.end);
  SlabPath path;
  WatchSpin watch(path, std::max<std::int64_t>(1, scene.integrator.steps / looks));
  path.end = all_spins(run_on_host(scene, io::initial_spins(scene), {SymmetricTensor{}}, watch));
  return path;
}

std::vector<double> sigma_at_start(Slab const& slab, double dt) {
  auto const spins = as_vectors(io::initial_spins(slab_scene(slab)));
  auto const w = generators(slab, spins);
  return sigmas(spins, w, generators(slab, rotated(spins, dt, w)), dt);
}

SlabPath run_slab_with_sigma(Slab const& slab, double factor, double dt, int looks) {
  auto const steps = std::llround(slab.end / dt);
  auto const period = std::max<std::int64_t>(1, steps / looks);
  auto spins = as_vectors(io::initial_spins(slab_scene(slab)));
  SlabPath path;
  std::vector<Vector> before;
  for (std::int64_t n = 0;; ++n) {
    auto const w = generators(slab, spins);
    auto const sigma = n == 0 ? sigmas(spins, w, generators(slab, rotated(spins, dt, w)), dt)
                              : sigmas(spins, w, before, -dt);
    auto a = w;
    for (std::size_t i = 0; i < a.size(); ++i)
      a[i] = multiply_add(factor * sigma[i], spins[i], w[i]);
    if (n % period == 0) {
      record(path, static_cast<double>(n) * dt, spins);
      path.sigma.push_back(factor * sigma[watched]);
    }
    if (n == steps) break;
    before = w;
    spins = rotated(std::move(spins), dt, a);
  }
  path.end = spins;
  return path;
}

double largest_distance(SlabPath const& a, SlabPath const& b) {
  double largest = 0;
  for (std::size_t i = 0; i < std::min(a.spin.size(), b.spin.size()); ++i)
    largest = std::max(largest, distance(a.spin[i], b.spin[i]));
  return largest;
}

double distance_at_end(SlabPath const& a, SlabPath const& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.end.size(); ++i)
    largest = std::max(largest, distance(a.end[i], b.end[i]));
  return largest;
}

SlabPath reference_run(Slab const& slab) { return run_slab(slab, rkmk4_def, finest_dt, 1); }

Convergence converge(Slab const& slab, MethodChoice const& choice, SlabPath const& reference,
                     double coarsest) {
  Convergence convergence;
  for (int halvings = 0; halvings < 5; ++halvings) {
    double const dt = std::ldexp(coarsest, -halvings);
    auto const run = run_slab(slab, choice, dt, 1);
    double const error = distance_at_end(run, reference);
    if (error < round_off) continue;
    convergence.dts.push_back(dt);
    convergence.errors.push_back(error);
    convergence.first_component_errors.push_back(
        std::abs(run.end[watched].x - reference.end[watched].x));
  }
  return convergence;
}

double Convergence::order() const { return fitted_order(dts, errors); }

double Convergence::order_of_first_component() const {
  return fitted_order(dts, first_component_errors);
}

double Convergence::order_of_finest_pair() const {
  auto const n = errors.size();
  return std::log2(errors[n - 2] / errors[n - 1]) / std::log2(dts[n - 2] / dts[n - 1]);
}

}  // namespace cayspin::paper
