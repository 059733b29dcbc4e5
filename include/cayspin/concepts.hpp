// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/optional_members.hpp>
#include <cayspin/spin_field.hpp>
#include <cayspin/stencil.hpp>
#include <cayspin/step.hpp>

#include <concepts>
#include <cstdint>
#include <functional>
#include <optional>
#include <type_traits>
#include <utility>

// The five concepts of the library: which members a user's type must have, and which are optional.
// The members of terms and generators that kernels call are templates over the stencil; the
// concepts check them with the host stencil of Spins (default: double precision in host memory).
namespace cayspin::inline v0_2 {

namespace detail {

template <class Spins>
using ExecutionOf = typename Spins::memory_space::execution_space;

template <class Spins>
using StencilOf = Stencil<Site<Pack<typename Spins::value_type>>, typename Spins::value_type>;

template <class Term, class Spins>
using PreparedFor =
    decltype(prepare_term(std::declval<Term const&>(), std::declval<ExecutionOf<Spins> const&>(),
                          std::declval<Spins const&>(), 0.0));

/// The generator that the Stepper concept passes to step() in its check.
struct AnyGenerator {
  template <class Stencil>
  KOKKOS_FUNCTION typename Stencil::vector_type operator()(Stencil const& stencil) const {
    return stencil.center();
  }
};

template <class Stepper>
concept has_evaluations = requires {
  { Stepper::evaluations } -> std::convertible_to<int>;
};

/// True when the stepper counts evaluations itself.
template <class Stepper>
concept counts_evaluations = requires(Stepper const& stepper) {
  { stepper.evaluations_done() } -> std::convertible_to<std::int64_t>;
};

/// Returns the number of evaluations in the next step of a stepper that does not count them itself.
template <class Stepper>
int evaluations_of_next_step(Stepper const& stepper) {
  if constexpr (requires { stepper.next_step_evaluations(); })
    return stepper.next_step_evaluations();
  else
    return Stepper::evaluations;
}

}  // namespace detail

/// A term of the effective field, with H = -dE/dm. Its device members are const templates over the
/// stencil; Value = Stencil::value_type.
///
/// | member | meaning | default |
/// |---|---|---|
/// | `Vec3<Value> field(stencil)` | H at the stencil's centre | required |
/// | `Value energy_density(stencil)` | the site's share of E | required |
/// | `Vec3<Value> add_field(stencil, h)` | h + H, in fewer operations | h + field |
/// | `Vec3<Value> add_turning_field(stencil, h)` | h + H, up to a multiple of m | add_field |
/// | `static int degree` | 1: H does not depend on the spins, 2: H is linear in them | unknown |
/// | `static bool is_local` | H depends only on the site's spin and t | false |
/// | `Vec3<Value> neighbor_field(stencil)` | part of H that the neighbours determine | see below |
///
/// Choose between values with select(condition, yes, no). `if` does not work, because on the host a
/// value is a pack of several sites. RedBlack calls neighbor_field instead of field. The result of
/// neighbor_field must not depend on the spin m of the site itself, and may differ from H only by a
/// multiple of m. If a non-local term has no neighbor_field, RedBlack evaluates the whole field for
/// each iterate of a spin.
///
/// These members are called on the host before a kernel:
///
/// | member | meaning | default |
/// |---|---|---|
/// | `check_spins(spins)` | throws for unsuitable spins or invalid values | accepts all spins |
/// | `auto prepare(exec, spins, t)` | the term for kernels at time t | the term itself |
/// | `static bool depends_on_time` | prepare depends only on t; its results stay valid | false |
/// | `bool is_stationary(exec, spins)` | prepare ignores t and spins | true without prepare |
/// | `bool needs_only_time(exec, spins)` | prepare ignores spins | see the two above |
/// | `bool is_affine()` | H is affine in the spins | true if it has a degree |
/// | `static bool is_conservative` | false if H is not -dE/dm, as for a torque | true |
///
/// If a term has prepare, the device members belong to the returned object. A term made of other
/// terms inherits the host members from Forwarding (field/forwarding.hpp), and its device members
/// may include gather (field/parts.hpp). Some methods of the 2002 paper also need derivatives of
/// terms; these members are described in cayspin_paper.
template <class Term, class Spins = SpinField<double, Kokkos::HostSpace>>
concept FieldTerm = requires {
  requires detail::has_field<detail::PreparedFor<Term, Spins>, detail::StencilOf<Spins>>;
  requires detail::has_energy_density<detail::PreparedFor<Term, Spins>, detail::StencilOf<Spins>>;
};

/// The generator A of m' = A x m. It may also have any of the host members of a FieldTerm.
///
/// | member | meaning | default |
/// |---|---|---|
/// | `Vec3<Value> operator()(stencil)` | A at the stencil's centre | required |
/// | `Vec3<Value> turning_part(stencil)` | A, up to a multiple of m | A |
/// | `Value energy_density(stencil)` | the site's share of E | no energy |
/// | `bool conserves_energy()` | host: E is conserved, A + dE/dm is along m | no EnergyControl |
/// | `bool is_orthogonal()` | A has no component along m | false |
template <class Type, class Spins = SpinField<double, Kokkos::HostSpace>>
concept Generator =
    detail::is_generator<detail::PreparedFor<Type, Spins>, detail::StencilOf<Spins>>;

/// A method that takes steps. A stepper is constructed for a lattice and owns its work memory. A
/// step may swap the memory of the spins with memory of the stepper.
///
/// | member | meaning | default |
/// |---|---|---|
/// | `spins_type` | the SpinField type that it advances | required |
/// | `step(exec, generator, spins, t, dt)` | advances spins from t to t + dt | required |
/// | `static int evaluations` | generator evaluations per step | evaluations_done() is required |
/// | `int64 evaluations_done()` | generator evaluations so far | evaluations is required |
/// | `int next_step_evaluations()` | generator evaluations in the next step | evaluations |
/// | `static int order` | order of convergence | unknown |
/// | `static int ghosts` | ghost layers that a step needs where parts meet | refuses parts |
/// | `reset()` | forgets the previous steps | nothing to forget |
/// | `check_spins(spins)` | throws for spins of another lattice | checked by step |
/// | `bool takes_batches(exec, generator, spins)` | batch may be called | false |
/// | `batch(exec, generator, spins, t, dt, count)` | like `count` steps, bit for bit | one by one |
/// | `static int work_fields` | number of work fields with three numbers per site | unknown |
/// | `size_t work_bytes()` | bytes of work memory | unknown |
/// | `visit_exchanged(visit)` | visits the fields that a step may swap with spins | none |
///
/// integrate() uses visit_exchanged to leave the spins in their original memory.
template <class Type>
concept Stepper =
    requires(Type& stepper, detail::ExecutionOf<typename Type::spins_type> const& exec,
             typename Type::spins_type& spins) {
      stepper.step(exec, detail::AnyGenerator(), spins, 0.0, 0.0);
      requires detail::has_evaluations<Type> || detail::counts_evaluations<Type>;
    };

/// A Stepper that chooses its own steps and delivers spins at the requested times. It continues
/// from an internal state: writing into the spins between two steps has no effect.
///
/// | member | meaning | default |
/// |---|---|---|
/// | `int64 evaluations_done()` | generator evaluations so far | required |
/// | `int64 accepted_steps()` | internal steps accepted so far | required |
/// | `int64 rejected_steps()` | internal steps rejected so far | required |
/// | `reset()` | the next step starts from the t and spins passed to it | required |
/// | `step_towards(exec, generator, spins, t, dt, wanted)` | see below | see below |
/// | `bool has_reached(t, dt)` | internal steps have reached t, up to round-off | see below |
///
/// integrate() calls step_towards instead of step if the stepper has both of the last two members.
/// step_towards writes the spins only when the internal steps have reached the time `wanted`, which
/// may be later than t + dt.
template <class Type>
concept AdaptiveStepper = Stepper<Type> && detail::counts_evaluations<Type> &&
                          requires(Type& stepper, Type const& constant) {
                            { constant.accepted_steps() } -> std::convertible_to<std::int64_t>;
                            { constant.rejected_steps() } -> std::convertible_to<std::int64_t>;
                            stepper.reset();
                          };

/// A callable that integrate() calls with the state before the first step and after each step.
///
/// | member | meaning | default |
/// |---|---|---|
/// | `operator()(exec, Step, spins)` | returns nothing or a Next | required |
/// | `bool due(Step)` | true if it wants the call at this step | true |
/// | `static bool changes_spins` | writes into the spins; not with an AdaptiveStepper | false |
template <class Type, class Spins = SpinField<double, Kokkos::HostSpace>>
concept Observer = requires(Type& observer, detail::ExecutionOf<Spins> const& exec,
                            Step const& step, Spins const& spins) {
  observer(exec, step, spins);
  requires std::is_void_v<decltype(observer(exec, step, spins))> ||
               std::is_same_v<decltype(observer(exec, step, spins)), Next>;
};

/// Returns Stepper::evaluations, the number of generator evaluations per step; empty if the stepper
/// does not declare it, or if it is not positive.
template <class Stepper>
constexpr std::optional<int> evaluations_per_step() {
  if constexpr (detail::has_evaluations<Stepper>) {
    if (Stepper::evaluations > 0) return Stepper::evaluations;
  }
  return std::nullopt;
}

namespace detail {

/// True if an observer, or the one that a std::reference_wrapper refers to, changes the spins.
template <class Observer>
inline constexpr bool changes_spins =
    requires { requires std::remove_cvref_t<std::unwrap_ref_decay_t<Observer>>::changes_spins; };

/// True if an observer, or the one that a std::reference_wrapper refers to, already applies the
/// first part of the next step, as ThermalNoise can.
template <class Observer>
inline constexpr bool begins_step =
    requires { requires std::remove_cvref_t<std::unwrap_ref_decay_t<Observer>>::begins_step; };

template <class Observer>
bool is_due(Observer const& observer, Step const& step) {
  std::unwrap_reference_t<Observer> const& itself = observer;
  static_assert(
      !requires(std::remove_cvref_t<decltype(itself)>& any) { any.due(step); } ||
          requires {
            { itself.due(step) } -> std::convertible_to<bool>;
          },
      "An observer's due(Step) must be const, and return a bool.");
  if constexpr (requires {
                  { itself.due(step) } -> std::convertible_to<bool>;
                })
    return itself.due(step);
  else
    return true;
}

}  // namespace detail
}  // namespace cayspin::inline v0_2
