// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "dear_method.hpp"

#include "io/relax.hpp"
#include "thermal.hpp"

#include <cayspin/exchange_memory.hpp>
#include <cayspin/stepper/multirate.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <tuple>
#include <utility>

namespace cayspin::simulation {
namespace {

/// Sees nothing: between substeps nobody looks.
template <class Simulation>
class NoLooks final : public RunObserver<typename Simulation::Exec, typename Simulation::Spins> {
  using Exec = typename Simulation::Exec;
  using Spins = typename Simulation::Spins;
  bool due(Step const&) const override { return false; }
  Next operator()(Exec const&, Step const&, Spins const&) override { return Next::proceed; }
};

/// The scene's method as a stepper that takes any number of substeps in one call.
template <class Simulation>
class MethodOfScene {
 public:
  using spins_type = typename Simulation::Spins;
  static constexpr int order = 4, work_fields = 0;  // the order: not above Multirate's
  static constexpr int ghosts = 1;                  // the method has asked for its own

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
  // Those of the simulation, all of them.
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
class DearMethod final : public OpenMethod {
  using Inner = MethodOfScene<Simulation>;
  using Field = SceneField<typename Simulation::Spins>;

 public:
  DearMethod(Simulation& simulation, std::unique_ptr<OpenMethod> method, std::int64_t substeps)
      : simulation_(simulation),
        stepper_(simulation.spins, Inner(simulation, std::move(method)),
                 *simulation.generator.landau_lifshitz().field().dear(), {.substeps = substeps}) {}

  Summary advance() override {
    // Substeps are integrated over times of their own.
    auto const times = simulation_.times;
    return cayspin::detail::integrate_in_any_memory(simulation_.exec, stepper_,
                                                    simulation_.generator, simulation_.spins, times,
                                                    *simulation_.observer);
  }
  void exchange_memory(Checkpoint& checkpoint) override {
    cayspin::exchange_memory(stepper_, checkpoint, "method.");
  }

 private:
  Simulation& simulation_;
  Multirate<Inner, typename Field::DearTerm, Order> stepper_;
};

[[noreturn]] void refuse(io::Scene const& scene, char const* key, std::string const& wrong,
                         char const* accepted) {
  throw io::scene_error(scene, key, fmt::format("{}; accepted: {}", wrong, accepted));
}

bool takes_dear_fields(io::Integrator const& integrator, Variant const& variant) {
  auto const& method = *integrator.method;
  bool const sees_each_stage = method.differentiates_field ||
                               integrator.isotropy == io::Isotropy::analytic ||
                               integrator.isotropy == io::Isotropy::finite_difference;
  return method.has_equal_steps() && !variant.remembers && variant.evaluations && !sees_each_stage;
}

bool is_dear(io::Demagnetization const& demag, io::Scene const& scene) {
  if (demag.dear) return *demag.dear;
  if (io::is_to_relax(scene)) return false;
  if (scene.integrator.energy_control || is_thermal(scene) || io::needs_pass(scene)) return false;
  return scene.integrator.method->automatic ||
         takes_dear_fields(scene.integrator, find_variant(scene));
}

}  // namespace

int order_of_dear(io::Scene const& scene, Variant const& variant) {
  constexpr double small = 0.015;  // above, order 3 widens lines by less than 1 %
  return variant.order >= (scene.system.damping < small ? 4 : 5) ? 4 : 3;
}

bool has_dear_field(io::Scene const& scene) {
  auto const& [slab, demag] = std::tie(scene.field.slab_demag, scene.field.demag);
  return (slab && slab->dear) || (demag && is_dear(*demag, scene)) ||
         (scene.field.own.nonlocal && scene.integrator.substeps > 1);
}

std::string without_dear(io::Scene const& scene) {
  if (!scene.field.demag) return "field.slab_demag.dear=false";
  // `demag = true` has no keys.
  bool const is_table = std::ranges::any_of(
      scene.places, [](auto const& place) { return place.first.starts_with("field.demag."); });
  return is_table ? "field.demag.dear=false" : "field.demag={dear=false}";
}

void require_dear_field_fits(io::Scene const& scene, Variant const& variant) {
  auto const& integrator = scene.integrator;
  auto const& method = *integrator.method;
  if (!has_dear_field(scene)) {
    if (integrator.substeps > 1)
      refuse(scene, "integrator.substeps", "no term of the field is dear",
             "1, or demag, or slab_demag.dear = true, or a program's own nonlocal field");
    return;
  }
  if (scene.field.own.nonlocal && scene.field.slab_demag && scene.field.slab_demag->dear)
    refuse(scene, "field.slab_demag.dear", "the program's own field is the dear one",
           "no such key");
  if (!takes_dear_fields(integrator, variant))
    refuse(scene, "integrator.method",
           fmt::format("\"{}\" takes no dear field: it chooses or remembers steps, iterates, or "
                       "differentiates the field",
                       method.word),
           "an explicit one-step method without a sigma of the field");
  if (integrator.energy_control)
    refuse(scene, "integrator.energy_control", "does not go with a dear field", "no such key");
  if (is_thermal(scene))
    refuse(scene, "thermal.temperature", "noise does not go with a dear field",
           "0, or no such table");
}

std::unique_ptr<OpenMethod> open_method(io::Scene const& scene, Plan const& plan,
                                        AnySimulation simulation) {
  auto method = plan.variant.open(simulation, plan.options);
  if (!has_dear_field(scene)) return method;
  return std::visit(
      [&]<class Simulation>(Simulation* of_types) -> std::unique_ptr<OpenMethod> {
        auto const with_order = [&]<int Order>() -> std::unique_ptr<OpenMethod> {
          return std::make_unique<DearMethod<Simulation, Order>>(*of_types, std::move(method),
                                                                 scene.integrator.substeps);
        };
        return order_of_dear(scene, plan.variant) == 4 ? with_order.template operator()<4>()
                                                       : with_order.template operator()<3>();
      },
      simulation);
}

}  // namespace cayspin::simulation
