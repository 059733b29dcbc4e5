// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// A film of permalloy whose demagnetising field is evaluated rarely: by Multirate, once a step, and
// by the multirate methods of SUNDIALS' ARKODE (MIS-KW3, MRI-GARK-ERK33a and ERK45a), three or five
// times a step. Inner methods are of order 4, and their steps are of nearly equal length. Prints
// for each run: evaluations of the demagnetising field, seconds, the largest distance of any spin
// from a reference at four times; then fitted orders, and the cost at given errors.
#include "ladder.hpp"
#include "sundials_spins.hpp"

#include <cayspin/demagnetization/demagnetizing_field.hpp>
#include <cayspin/field/slow_field.hpp>
#include <cayspin/stepper/multirate.hpp>

#include <arkode/arkode_arkstep.h>
#include <arkode/arkode_mristep.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace cayspin;
using by_sundials::RightSide;
using ladder::Spins;

constexpr double horizon = 16, damping = 0.02, exchange = 32.3;

Lattice film() { return {.shape = {200, 50, 1}, .spacing = {2.5, 2.5, 3}}; }

std::vector<double> start() {
  using std::numbers::pi;
  return ladder::start_of(film(), [](double x, double y, double) {
    return Vec3<double>{1, 0.4 + 0.3 * std::cos(pi * y), 0.3 * std::cos(pi * x)};
  });
}

auto cheap_field() {
  return EffectiveField(Exchange(film(), exchange), Zeeman{{-0.0245, 0.0043, 0}});
}

using Demag = HostField<Spins, DemagnetizingField<double>>;
using SlowDemag = SlowField<Spins, Demag>;

/// Runs cayspin's steppers with a generator whose demagnetising field counts its evaluations.
class Own {
 public:
  explicit Own(Demag const& demag)
      : like_("bench::like", film()),
        slow_(like_, demag),
        generator_(EffectiveField(Exchange(film(), exchange), Zeeman{{-0.0245, 0.0043, 0}}, slow_),
                   damping),
        start_(start()) {}

  template <class Stepper>
  ladder::Run operator()(Stepper stepper, std::int64_t steps) const {
    auto const before = slow_.evaluations_done();
    auto run = ladder::take_steps(stepper, generator_, film(), start_, horizon, steps);
    run.multirate = slow_.evaluations_done() - before;
    return run;
  }
  template <int Order>
  ladder::Run multirate(std::int64_t steps, std::int64_t substeps) const {
    return (*this)(Multirate<Rkmk4<Spins>, SlowDemag, Order>(like_, Rkmk4<Spins>(like_), slow_,
                                                             {.substeps = substeps}),
                   steps);
  }
  Spins const& like() const { return like_; }

 private:
  Spins like_;
  SlowDemag slow_;
  decltype(LandauLifshitz(
      EffectiveField(Exchange(film(), exchange), Zeeman{{}}, std::declval<SlowDemag const&>()),
      damping)) generator_;
  std::vector<double> start_;
};

/// Runs MRIStep of ARKODE: the demagnetising field is the slow part, the other terms are the fast
/// part.
class Mri {
 public:
  Mri(Demag const& demag, ARKODE_MRITableID table)
      : table_(table),
        slow_(film(), LandauLifshitz(EffectiveField(demag), damping), true),
        fast_(film(), LandauLifshitz(cheap_field(), damping)),
        start_(start()) {}

  ladder::Run operator()(std::int64_t steps, std::int64_t substeps) {
    using by_sundials::require;
    slow_.evaluations = fast_.evaluations = 0;
    Spins spins("bench::start", film());
    copy_from_host(start_, spins);
    auto const y = slow_.vectors.make(context_);
    slow_.vectors.write(spins, y.get());
    double const dt = horizon / static_cast<double>(steps);
    void* inner = ARKStepCreate(fast_rate, nullptr, 0, y.get(), context_);
    require(inner != nullptr, "ARKStepCreate");
    ARKStepSetUserData(inner, this);
    ARKStepSetOrder(inner, 4);
    ARKStepSetFixedStep(inner, dt / static_cast<double>(substeps));
    ARKStepSetMaxNumSteps(inner, 1000000);
    MRIStepInnerStepper stepper = nullptr;
    require(ARKStepCreateMRIStepInnerStepper(inner, &stepper) == 0, "the inner stepper");
    void* outer = MRIStepCreate(slow_rate, nullptr, 0, y.get(), stepper, context_);
    require(outer != nullptr, "MRIStepCreate");
    MRIStepSetUserData(outer, this);
    MRIStepCoupling coupling = MRIStepCoupling_LoadTable(table_);
    require(MRIStepSetCoupling(outer, coupling) == 0, "MRIStepSetCoupling");
    MRIStepSetFixedStep(outer, dt);
    MRIStepSetMaxNumSteps(outer, 1000000);
    ladder::Run run;
    ladder::Clock clock;
    for (int look = 1; look <= ladder::looks; ++look) {
      double const until = horizon * look / ladder::looks;
      double reached = 0;
      MRIStepSetStopTime(outer, until);
      int const flag = MRIStepEvolve(outer, until, y.get(), &reached, ARK_NORMAL);
      Kokkos::fence("cayspin::bench: looked at");
      run.seconds += clock.seconds();
      if (flag < 0) break;
      slow_.vectors.read(y.get(), spins);
      run.states.push_back(copy_to_host(spins));
      clock.reset();
    }
    run.multirate = slow_.evaluations;
    run.evaluations = fast_.evaluations;
    run.steps = steps;
    MRIStepCoupling_Free(coupling);
    MRIStepFree(&outer);
    MRIStepInnerStepper_Free(&stepper);
    ARKStepFree(&inner);
    return run;
  }

 private:
  static int slow_rate(double t, N_Vector y, N_Vector to, void* data) {
    static_cast<Mri*>(data)->slow_(t, y, to);
    return 0;
  }
  static int fast_rate(double t, N_Vector y, N_Vector to, void* data) {
    static_cast<Mri*>(data)->fast_(t, y, to);
    return 0;
  }

  sundials::Context context_;
  ARKODE_MRITableID table_;
  RightSide<decltype(LandauLifshitz(EffectiveField(std::declval<Demag const&>()), damping))> slow_;
  RightSide<decltype(LandauLifshitz(cheap_field(), damping))> fast_;
  std::vector<double> start_;
};

/// Returns the order of a method: minus the slope of log(error) against log(steps), fitted by least
/// squares to the errors of at most 2e-3.
double fitted_order(ladder::Ladder const& ladder) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (auto const& rung : ladder.rungs) {
    if (rung.error > 2e-3) continue;
    double const of_steps = std::log(rung.steps), of_error = std::log(rung.error);
    n += 1, x += of_steps, y += of_error, xx += of_steps * of_steps, xy += of_steps * of_error;
  }
  return (x * y - n * xy) / (n * xx - x * x);
}

void report(ladder::Ladder const& ladder) {
  for (auto const& rung : ladder.rungs)
    std::printf("%-27s %5.0f steps | %5.0f slow %6.0f others %7.4f s | error %.1e\n",
                ladder.name.c_str(), rung.steps, rung.multirate, rung.evaluations, rung.seconds,
                rung.error);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  Kokkos::ScopeGuard const kokkos(argc, argv);
  if (!ladder::has_one_thread()) return 2;
  Demag const demag(film(), DemagnetizingField<double>(film()));
  Own const own(demag);
  auto const coarse = own(Rkmk4<Spins>(own.like()), 2000).states;
  auto const reference = own(Rkmk4<Spins>(own.like()), 4000).states;
  std::printf("rkmk4 in 2000 and 4000 steps agree to %.1e\n", ladder::distance(coarse, reference));

  double const largest =
      largest_stable_step<Rkmk4<Spins>>(exchange_bound(film(), exchange) + 1, damping);
  std::vector<ladder::Ladder> ladders;
  // A step has a multiple of `stages` inner steps, each at most 0.4 times the largest stable one.
  auto const compare = [&](std::string const& name, bool is_own, double coarsest, int stages,
                           auto&& run) {
    auto const once = [&](int rung) {
      std::int64_t const steps = ladder::steps_of(rung, horizon / coarsest);
      double const least = 2.5 * horizon / static_cast<double>(steps) / largest;
      return run(steps, static_cast<std::int64_t>(stages * std::ceil(least / stages)));
    };
    ladders.push_back(
        ladder::climb(name, is_own, reference, {.least_error = 4e-6, .rungs = 9}, once));
    report(ladders.back());
  };
  compare("rkmk4, demag in each stage", true, largest, 1,
          [&](auto steps, auto) { return own(Rkmk4<Spins>(own.like()), steps); });
  compare("Multirate, order 3", true, 0.4, 1,
          [&](auto steps, auto substeps) { return own.multirate<3>(steps, substeps); });
  compare("Multirate, order 4", true, 0.4, 1,
          [&](auto steps, auto substeps) { return own.multirate<4>(steps, substeps); });
  for (auto const& [name, table, stages] :
       {std::tuple{"MIS-KW3", ARKODE_MIS_KW3, 3},
        std::tuple{"MRI-GARK-ERK33a", ARKODE_MRI_GARK_ERK33a, 3},
        std::tuple{"MRI-GARK-ERK45a", ARKODE_MRI_GARK_ERK45a, 5}}) {
    Mri mri(demag, table);
    compare(name, false, 1.4, stages, mri);
  }
  std::vector<double> const errors{1e-3, 1e-4, 1e-5};
  std::printf("\n%-27s | order", "evaluations of the expensive field, ms to");
  for (double const error : errors) std::printf(" | %-16.0e", error);
  for (auto const& one : ladders) {
    std::printf("\n%-27s | %5.2f", one.name.c_str(), fitted_order(one));
    for (double const error : errors)
      std::printf(" | %6.0f %9.4g", ladder::amount_to(one, error, &ladder::Rung::multirate),
                  1e3 * ladder::amount_to(one, error, &ladder::Rung::seconds));
  }
  std::printf("\n");
}
