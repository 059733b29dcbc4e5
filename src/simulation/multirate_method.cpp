// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "multirate_method.hpp"

#include "io/relax.hpp"
#include "largest_field.hpp"
#include "thermal.hpp"

#include <cayspin/serialize.hpp>
#include <cayspin/stepper/multirate.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <tuple>
#include <utility>

namespace cayspin::simulation {
namespace {

/// Observer that does nothing, for substeps.
template <class Simulation>
class NoLooks final : public RunObserver<typename Simulation::Exec, typename Simulation::Spins> {
  using Exec = typename Simulation::Exec;
  using Spins = typename Simulation::Spins;
  bool due(Step const&) const override { return false; }
  Next operator()(Exec const&, Step const&, Spins const&) override { return Next::proceed; }
};

/// The scene's method as a stepper that takes any number of substeps per call.
template <class Simulation>
class MethodOfScene {
 public:
  using spins_type = typename Simulation::Spins;
  static constexpr int order = 4, work_fields = 0;  // order: an upper bound, which Multirate lowers
  static constexpr int ghosts = 1;                  // the inner method has requested its own

  MethodOfScene(Simulation& simulation, std::unique_ptr<OpenMethod> method)
      : simulation_(simulation), method_(std::move(method)) {}

  std::int64_t evaluations_done() const { return evaluations_; }
  std::size_t work_bytes() const { return 0; }

  template <class Exec, class Generator>
  void step(Exec const& exec, Generator const& generator, spins_type& spins, double t, double dt) {
    batch(exec, generator, spins, t, dt, 1);
  }
  template <class Exec, class Generator>
  bool takes_batches(Exec const&, Generator const&, spins_type const&) const {
    return true;
  }
  // Takes all steps in one call of the method.
  template <class Exec, class Generator>
  void batch(Exec const&, Generator const&, spins_type&, double t, double dt, std::int64_t count) {
    NoLooks<Simulation> nobody;
    simulation_.times = {t, dt, count};
    simulation_.observer = &nobody;
    evaluations_ += method_->advance().evaluations;
  }

 private:
  Simulation& simulation_;
  std::unique_ptr<OpenMethod> method_;
  std::int64_t evaluations_ = 0;
};

template <class Simulation, int Order>
class MultirateMethod final : public OpenMethod {
  using Inner = MethodOfScene<Simulation>;
  using Field = SceneField<typename Simulation::Spins>;

 public:
  MultirateMethod(Simulation& simulation, std::unique_ptr<OpenMethod> method, std::int64_t substeps)
      : simulation_(simulation),
        stepper_(simulation.spins, Inner(simulation, std::move(method)),
                 *simulation.generator.landau_lifshitz().field().slow(), {.substeps = substeps}) {}

  Summary advance() override {
    // A copy, because the substeps overwrite the simulation's times.
    auto const times = simulation_.times;
    return cayspin::detail::integrate_in_any_memory(simulation_.exec, stepper_,
                                                    simulation_.generator, simulation_.spins, times,
                                                    *simulation_.observer);
  }
  void serialize(Checkpoint& checkpoint) override {
    cayspin::serialize(stepper_, checkpoint, "method.");
  }

 private:
  Simulation& simulation_;
  Multirate<Inner, typename Field::SlowTerm, Order> stepper_;
};

[[noreturn]] void refuse(io::Scene const& scene, std::string const& key, std::string const& wrong,
                         char const* accepted) {
  throw io::scene_error(scene, key, fmt::format("{}; accepted: {}", wrong, accepted));
}

bool takes_slow_fields(io::Integrator const& integrator, Variant const& variant) {
  auto const& method = *integrator.method;
  bool const sees_each_stage = method.differentiates_field ||
                               integrator.isotropy == io::Isotropy::analytic ||
                               integrator.isotropy == io::Isotropy::finite_difference;
  return method.has_equal_steps() && !variant.remembers && variant.evaluations && !sees_each_stage;
}

bool is_multirate(io::Demagnetization const& demag, io::Scene const& scene) {
  if (demag.multirate) return *demag.multirate;
  if (io::is_to_relax(scene)) return false;
  if (scene.field.own.nonlocal) return scene.integrator.substeps > 1;
  if (scene.integrator.energy_control || is_thermal(scene) || io::needs_pass(scene)) return false;
  return scene.integrator.method->automatic ||
         takes_slow_fields(scene.integrator, find_variant(scene));
}

}  // namespace

int order_of_multirate(io::Scene const& scene, Variant const& variant) {
  // For larger damping, order 3 widens resonance lines by less than 1 %.
  constexpr double small = 0.015;
  return variant.order >= (least_damping(scene) < small ? 4 : 5) ? 4 : 3;
}

bool has_slow_field(io::Scene const& scene) {
  auto const& [slab, demag] = std::tie(scene.field.slab_demag, scene.field.demag);
  return (slab && slab->multirate) || (demag && is_multirate(*demag, scene)) ||
         (scene.field.own.nonlocal && scene.integrator.substeps > 1);
}

std::string without_multirate(io::Scene const& scene) {
  if (!scene.field.demag) return "field.slab_demag.multirate=false";
  // A scene with `demag = true` has no table to which a key could be added.
  auto const key = "field." + scene.field.demag->key;
  bool const is_table = std::ranges::any_of(
      scene.places, [&](auto const& place) { return place.first.starts_with(key + '.'); });
  return key + (is_table ? ".multirate=false" : "={multirate=false}");
}

void require_slow_field_fits(io::Scene const& scene, Variant const& variant) {
  auto const& integrator = scene.integrator;
  auto const& method = *integrator.method;
  if (!has_slow_field(scene)) {
    if (integrator.substeps > 1)
      refuse(scene, "integrator.substeps", "no term of the field is expensive",
             "1, or demag, or slab_demag.multirate = true, or a program's own nonlocal field");
    return;
  }
  if (auto const& demag = scene.field.demag;
      scene.field.own.nonlocal && demag && demag->multirate == false)
    refuse(scene, fmt::format("field.{}.multirate", demag->key),
           "false does not go with substeps and a program's own nonlocal field: demag is evaluated "
           "together with that field, once a step",
           "true, or no such key");
  if (!takes_slow_fields(integrator, variant))
    refuse(
        scene, "integrator.method",
        fmt::format("\"{}\" takes no expensive field: it chooses or remembers steps, iterates, or "
                    "differentiates the field",
                    method.word),
        "an explicit one-step method without a sigma of the field");
  if (integrator.energy_control)
    refuse(scene, "integrator.energy_control", "does not go with an expensive field",
           "no such key");
  if (is_thermal(scene))
    refuse(scene, "thermal.temperature", "noise does not go with an expensive field",
           "0, or no such table");
}

std::unique_ptr<OpenMethod> open_method(io::Scene const& scene, Plan const& plan,
                                        AnySimulation simulation) {
  auto method = plan.variant.open(simulation, plan.options);
  if (!has_slow_field(scene)) return method;
  return std::visit(
      [&]<class Simulation>(Simulation* of_types) -> std::unique_ptr<OpenMethod> {
        auto const with_order = [&]<int Order>() -> std::unique_ptr<OpenMethod> {
          return std::make_unique<MultirateMethod<Simulation, Order>>(*of_types, std::move(method),
                                                                      scene.integrator.substeps);
        };
        return order_of_multirate(scene, plan.variant) == 4 ? with_order.template operator()<4>()
                                                            : with_order.template operator()<3>();
      },
      simulation);
}

}  // namespace cayspin::simulation
