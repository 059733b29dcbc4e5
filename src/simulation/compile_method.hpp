// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "kokkos_settings.hpp"
#include "method_list.hpp"
#include "variant.hpp"

#include <cayspin/cayspin.hpp>

#include <cayspin_paper/analytic_sigma.hpp>
#include <cayspin_paper/rkmk4_as_printed.hpp>
#include <cayspin_paper/series4.hpp>

#include <limits>

// Compiles each row of the list of methods into its variants: one for each combination of options
// that changes the type of the stepper. The rotation also changes that type, but each variant
// contains the steppers of all its rotations.
namespace cayspin::simulation {

/// Template parameters that distinguish the variants of a row.
struct VariantKey {
  io::Isotropy isotropy = io::Isotropy::zero;
  bool in_chart = false, compensated = false, of_rigid_bodies = false;
};

template <std::size_t Number>
inline constexpr io::Method const& method_at = std::get<Number>(method_list);

/// The stepper whose bound on dt is used: Family::StableAs if it exists, otherwise the method's own
/// stepper.
template <class Family, class Spins, class Own>
struct BoundedStepper {
  using type = Own;
  static constexpr bool exists = requires { typename Own::tableau_type; };
};
template <class Family, class Spins, class Own>
  requires requires { typename Family::template StableAs<Spins>; }
struct BoundedStepper<Family, Spins, Own> {
  using type = typename Family::template StableAs<Spins>;
  static constexpr bool exists = true;
};

/// Variant `Key` of row `Number`.
template <std::size_t Number, VariantKey Key>
class Compiled {
  using Family = typename std::tuple_element_t<Number, decltype(method_list)>::family;
  using HostSpins = SpinField<double, Kokkos::DefaultHostExecutionSpace::memory_space>;

  static constexpr auto isotropy(MethodOptions const& options) {
    using enum io::Isotropy;
    if constexpr (Key.isotropy == analytic)
      return isotropy::Analytic{};
    else if constexpr (Key.isotropy == finite_difference)
      return isotropy::FiniteDifference{options.cap};
    else if constexpr (Key.isotropy == finite_difference_backward)
      return isotropy::FiniteDifferenceBackward{options.cap};
    else if constexpr (Key.isotropy == energy)
      return isotropy::Energy{};
    else
      return SceneIsotropy{options.sigma};
  }
  using Isotropy = decltype(isotropy({}));

  template <class Spins, class Rotation>
  static auto plain_stepper() {
    if constexpr (Key.in_chart)
      return std::type_identity<typename Family::template Chart<Spins>>{};
    else
      return std::type_identity<typename Family::template Stepper<Spins, Isotropy, Rotation>>{};
  }
  /// The method's stepper without compensation.
  template <class Spins, class Rotation>
  using Plain = typename decltype(plain_stepper<Spins, Rotation>())::type;

  template <class Spins, class Rotation>
  static auto whole_stepper() {
    using Of = Plain<Spins, Rotation>;
    if constexpr (Key.compensated)
      return std::type_identity<Compensated<Of>>{};
    else
      return std::type_identity<Of>{};
  }
  template <class Spins, class Rotation>
  using Stepper = typename decltype(whole_stepper<Spins, Rotation>())::type;

  static constexpr io::SetOf<io::Rotation> rotations() {
    if (method_at<Number>.is_baseline()) return {};
    if (Key.in_chart || Key.compensated || Key.isotropy == io::Isotropy::energy)
      return {method_at<Number>.usual_rotation()};
    return method_at<Number>.rotations;
  }
  template <class Work>
  static auto with_rotation(io::Rotation rotation, Work const& work) {
    // Unless both rotations are possible, the only one is Cayley, or the stepper ignores this type.
    if constexpr (rotations() == sets::both_rotations) {
      if (rotation == io::Rotation::exponential) return work(Exponential{});
    }
    return work(Cayley{});
  }

  template <class Of, class Spins>
  CAYSPIN_DETAIL_NOINLINE static Of make(Spins const& like, MethodOptions const& options) {
    if constexpr (std::is_constructible_v<Of, Spins, StepOptions, Isotropy>)
      return Of(like, options.steps, isotropy(options));
    else if constexpr (std::is_constructible_v<Of, Spins, StepOptions>)
      return Of(like, options.steps);
    else if constexpr (std::is_constructible_v<Of, Spins, Isotropy>)
      return Of(like, isotropy(options));
    else
      return Of(like);
  }
  template <class Generator>
  static decltype(auto) generator(Generator const& of_the_scene) {
    if constexpr (Key.of_rigid_bodies)
      return of_the_scene.rigid_bodies();
    else if constexpr (method_at<Number>.by_colour)
      return of_the_scene.landau_lifshitz();
    else
      return (of_the_scene);
  }

  static double stable_step(double field_bound, double damping, bool precession,
                            MethodOptions const& options) {
    return with_rotation(options.rotation, [&]<class Rotation>(Rotation) {
      if constexpr (!Key.of_rigid_bodies) {
        using Bounded = BoundedStepper<Family, HostSpins, Plain<HostSpins, Rotation>>;
        if constexpr (Bounded::exists)
          return largest_stable_step<typename Bounded::type>(
              field_bound, damping, {.precession = precession, .sigma = options.sigma});
      }
      return std::numeric_limits<double>::infinity();
    });
  }

  template <class Real>
  static constexpr int work_fields() {
    if constexpr (Key.of_rigid_bodies && requires { Family::work_fields_of_rigid_bodies; })
      return Family::work_fields_of_rigid_bodies;
    else
      return Stepper<SpinField<Real>, Cayley>::work_fields;
  }
  template <class Real>
  static std::int64_t work_bytes_of(Lattice const& lattice, bool by_time_only) {
    using Of = Stepper<SpinField<Real>, Cayley>;
    if constexpr (requires { Of::work_bytes(lattice, PredictedRun{}); })
      return static_cast<std::int64_t>(
          Of::work_bytes(lattice, {.threads = expected_threads(), .by_time_only = by_time_only}));
    auto const layout = cayspin::RowLayout::of<Real>(lattice);
    return static_cast<std::int64_t>(work_fields<Real>() * layout.allocation(3) * sizeof(Real));
  }
  static std::int64_t work_bytes(Lattice const& lattice, bool by_time_only, Precision precision) {
    return precision == Precision::double_precision ? work_bytes_of<double>(lattice, by_time_only)
                                                    : work_bytes_of<float>(lattice, by_time_only);
  }

  template <class Simulation, class Rotation>
  class Open final : public OpenMethod {
   public:
    Open(Simulation& simulation, MethodOptions const& options)
        : simulation_(simulation), stepper_(make<Of>(simulation.spins, options)) {}

    Summary advance() override {
      return cayspin::detail::integrate_in_any_memory(
          simulation_.exec, stepper_, generator(simulation_.generator), simulation_.spins,
          simulation_.times, *simulation_.observer);
    }
    void serialize(Checkpoint& checkpoint) override {
      cayspin::serialize(stepper_, checkpoint, "method.");
    }

   private:
    using Of = Stepper<typename Simulation::Spins, Rotation>;
    Simulation& simulation_;
    Of stepper_;
  };
  static std::unique_ptr<OpenMethod> open(AnySimulation any, MethodOptions const& options) {
    return std::visit(
        [&]<class Simulation>(Simulation* simulation) {
          return with_rotation(
              options.rotation, [&]<class Rotation>(Rotation) -> std::unique_ptr<OpenMethod> {
                return std::make_unique<Open<Simulation, Rotation>>(*simulation, options);
              });
        },
        any);
  }

  static std::optional<int> evaluations() {
    using Of = Stepper<HostSpins, Cayley>;
    if constexpr (requires { Of::evaluations; }) {
      if (Of::evaluations > 0) return Of::evaluations;
    }
    return std::nullopt;
  }

 public:
  static Variant variant() {
    static_assert(Stepper<HostSpins, Cayley>::order == method_at<Number>.order,
                  "A row of the list of methods names another order than its stepper has.");
    return {.method = &method_at<Number>,
            .isotropy = Key.isotropy,
            .in_chart = Key.in_chart,
            .compensated = Key.compensated,
            .of_rigid_bodies = Key.of_rigid_bodies,
            .rotations = rotations(),
            .order = Stepper<HostSpins, Cayley>::order,
            .evaluations = evaluations(),
            .remembers = remembers_steps<Stepper<HostSpins, Cayley>>,
            .ghosts = cayspin::detail::ghosts_of<Stepper<HostSpins, Cayley>>,
            .work_fields = work_fields<double>(),
            .work_bytes = work_bytes,
            .stable_step = stable_step,
            .open = open};
  }
};

/// Returns all variants of a row.
template <std::size_t Number>
std::vector<Variant> compile_method() {
  using enum io::Isotropy;
  constexpr io::Method const& method = method_at<Number>;
  using Family = typename std::tuple_element_t<Number, decltype(method_list)>::family;
  std::vector<Variant> all;
  if constexpr (!method.automatic) {
    auto const add = [&]<VariantKey Key>() { all.push_back(Compiled<Number, Key>::variant()); };
    constexpr auto has = [](io::Isotropy isotropy) {
      return method.takes(isotropy, io::SystemKind::llg);
    };
    add.template operator()<VariantKey{}>();
    if constexpr (method.compensated) add.template operator()<VariantKey{.compensated = true}>();
    if constexpr (requires { Family::distinguishes_rigid_bodies; })
      add.template operator()<VariantKey{.of_rigid_bodies = true}>();
    if constexpr (method.corrects_energy)
      add.template operator()<VariantKey{.isotropy = energy, .of_rigid_bodies = true}>();
    if constexpr (has(analytic)) add.template operator()<VariantKey{.isotropy = analytic}>();
    if constexpr (has(finite_difference))
      add.template operator()<VariantKey{.isotropy = finite_difference}>();
    if constexpr (has(finite_difference_backward))
      add.template operator()<VariantKey{.isotropy = finite_difference_backward}>();
    if constexpr (method.takes(io::Generator::tangent)) {
      add.template operator()<VariantKey{.in_chart = true}>();
      if constexpr (method.compensated)
        add.template operator()<VariantKey{.in_chart = true, .compensated = true}>();
    }
  }
  return all;
}

/// Returns the variants of rows `Shard`, `Shard` + `Shards`, ...
template <std::size_t Shard, std::size_t Shards>
std::vector<Variant> compile_shard() {
  constexpr std::size_t rows = std::tuple_size_v<decltype(method_list)>;
  std::vector<Variant> all;
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    auto const add = [&](std::vector<Variant> const& some) {
      all.insert(all.end(), some.begin(), some.end());
    };
    (add(compile_method<Shard + I * Shards>()), ...);
  }(std::make_index_sequence<(rows - Shard + Shards - 1) / Shards>{});
  return all;
}

}  // namespace cayspin::simulation
