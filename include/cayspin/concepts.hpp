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

// The five contracts of the library: what a user may bring, and what each of them may leave out.
// Terms and generators are templates over the stencil; the concepts check them with the host's
// stencil of Spins, by default spins of double precision in host memory.
namespace cayspin::inline v0_1 {

namespace detail {

template <class Spins>
using ExecutionOf = typename Spins::memory_space::execution_space;

template <class Spins>
using StencilOf = Stencil<Site<Pack<typename Spins::value_type>>, typename Spins::value_type>;

template <class Term, class Spins>
using PreparedFor =
    decltype(prepare_term(std::declval<Term const&>(), std::declval<ExecutionOf<Spins> const&>(),
                          std::declval<Spins const&>(), 0.0));

/// A generator that any stepper takes.
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

/// Where the number of evaluations depends on the spins, the stepper counts them itself.
template <class Stepper>
concept counts_evaluations = requires(Stepper const& stepper) {
  { stepper.evaluations_done() } -> std::convertible_to<std::int64_t>;
};

/// Evaluations in the next step of a stepper that does not count them itself.
template <class Stepper>
int evaluations_of_next_step(Stepper const& stepper) {
  if constexpr (requires { stepper.next_step_evaluations(); })
    return stepper.next_step_evaluations();
  else
    return Stepper::evaluations;
}

}  // namespace detail

/// A term of the effective field, with H = -dE/dm. On devices it has const templates over the
/// stencil; Value = Stencil::value_type.
///
/// | member | says | left out |
/// |---|---|---|
/// | `Vec3<Value> field(stencil)` | H at the stencil's centre | required |
/// | `Value energy_density(stencil)` | the site's share of E | required |
/// | `Vec3<Value> add_field(stencil, h)` | h + H, where that takes less | h + field |
/// | `Vec3<Value> add_turning_field(stencil, h)` | the same, less a multiple of m | add_field |
/// | `static int degree` | 1: H without the spins, 2: linear in them | H is neither |
/// | `static bool is_local` | H depends on the spin itself and t only | false |
/// | `Vec3<Value> neighbor_field(stencil)` | H of the others, less a multiple of m | see below |
///
/// Conditions on values are select(condition, yes, no). No `if` works: on the host a value is a
/// pack of several sites. RedBlack moves a spin in the field of the others, by neighbor_field: H
/// has no other part then. Where a term that is not local leaves it out, the whole field is
/// evaluated for each iterate of a spin.
///
/// On the host, before a kernel, these are called:
///
/// | member | says | left out |
/// |---|---|---|
/// | `check_spins(spins)` | throws for other spins and wrong numbers | takes any spins |
/// | `auto prepare(exec, spins, t)` | the term for kernels at time t | the term itself |
/// | `static bool depends_on_time` | H changes with t, not by what is prepared | false |
/// | `bool is_stationary(exec, spins)` | prepared once for all t and spins | true without prepare |
/// | `bool needs_time_alone(exec, spins)` | t is enough to prepare | one of the two above |
/// | `bool is_affine()` | H is affine in the spins | where it has a degree |
/// | `static bool is_conservative` | false: H is the derivative of no energy, as a torque | true |
///
/// A term with a prepare has the device members in what that returns. One that is made of others
/// gets the host members from Forwarding (field/forwarding.hpp), and has gather (field/parts.hpp)
/// on devices. The derivatives that some methods of the paper ask for are in cayspin_paper.
template <class Term, class Spins = SpinField<double, Kokkos::HostSpace>>
concept FieldTerm = requires {
  requires detail::has_field<detail::PreparedFor<Term, Spins>, detail::StencilOf<Spins>>;
  requires detail::has_energy_density<detail::PreparedFor<Term, Spins>, detail::StencilOf<Spins>>;
};

/// The A of m' = A x m. The host members are those of a FieldTerm, and so are those of an energy.
///
/// | member | says | left out |
/// |---|---|---|
/// | `Vec3<Value> operator()(stencil)` | A at the stencil's centre | required |
/// | `Vec3<Value> turning_part(stencil)` | A, less a multiple of m: what turns m | A |
/// | `Value energy_density(stencil)` | the site's share of E | it has no energy |
/// | `bool conserves_energy()` | E is kept: A = -dE/dm + c m (host) | EnergyControl refuses it |
/// | `bool is_orthogonal()` | A has no part along m | false |
template <class Type, class Spins = SpinField<double, Kokkos::HostSpace>>
concept Generator =
    detail::is_generator<detail::PreparedFor<Type, Spins>, detail::StencilOf<Spins>>;

/// A method that takes steps. A stepper is made for a lattice and holds its work memory. A step may
/// exchange the memory of the spins with the stepper's own.
///
/// | member | says | left out |
/// |---|---|---|
/// | `spins_type` | the SpinField that it advances | required |
/// | `step(exec, generator, spins, t, dt)` | advances spins from t to t + dt | required |
/// | `static int evaluations` | of the generator in each step | evaluations_done() is required |
/// | `int64 evaluations_done()` | of the generator so far | evaluations is required |
/// | `int next_step_evaluations()` | those of a first step may be more | evaluations |
/// | `static int order` | of the error | not known |
/// | `static int ghosts` | a step needs at each inner end of a part of a lattice | no parts |
/// | `reset()` | forgets the steps so far | there is nothing to forget |
/// | `check_spins(spins)` | throws for spins of another lattice | step does |
/// | `bool takes_batches(exec, generator, spins)` | may batch be called? | false |
/// | `batch(exec, generator, spins, t, dt, count)` | count steps, same bits | one by one |
/// | `static int work_fields` | fields of three numbers per site | not known |
/// | `size_t work_bytes()` | bytes of work memory | not known |
/// | `visit_exchanged(visit)` | visit(field) for fields that a step exchanges for the spins | none
/// |
///
/// integrate() ends in the memory that the spins had at first, by visit_exchanged.
template <class Type>
concept Stepper =
    requires(Type& stepper, detail::ExecutionOf<typename Type::spins_type> const& exec,
             typename Type::spins_type& spins) {
      stepper.step(exec, detail::AnyGenerator(), spins, 0.0, 0.0);
      requires detail::has_evaluations<Type> || detail::counts_evaluations<Type>;
    };

/// A Stepper that chooses its own steps and delivers spins at the times that are asked for. It goes
/// on from a state of its own: what is written into the spins between two steps has no effect.
///
/// | member | says | left out |
/// |---|---|---|
/// | `int64 evaluations_done()` | evaluations of the generator so far | required |
/// | `int64 accepted_steps()` | own steps taken so far | required |
/// | `int64 rejected_steps()` | own steps thrown away so far | required |
/// | `reset()` | the next step begins at its own t and spins | required |
/// | `step_towards(exec, generator, spins, t, dt, wanted)` | writes spins at `wanted` only | step |
/// | `bool has_reached(t, dt)` | has it reached t, where a step of dt ends? | step is called |
template <class Type>
concept AdaptiveStepper = Stepper<Type> && detail::counts_evaluations<Type> &&
                          requires(Type& stepper, Type const& constant) {
                            { constant.accepted_steps() } -> std::convertible_to<std::int64_t>;
                            { constant.rejected_steps() } -> std::convertible_to<std::int64_t>;
                            stepper.reset();
                          };

/// What integrate() calls with the state before the first step and after each step.
///
/// | member | says | left out |
/// |---|---|---|
/// | `operator()(exec, Step, spins)` | returns nothing, or a Next | required |
/// | `bool due(Step)` | is the call wanted at this step? | true |
/// | `static bool changes_spins` | it writes into the spins: no AdaptiveStepper takes it | false |
template <class Type, class Spins = SpinField<double, Kokkos::HostSpace>>
concept Observer = requires(Type& observer, detail::ExecutionOf<Spins> const& exec,
                            Step const& step, Spins const& spins) {
  observer(exec, step, spins);
  requires std::is_void_v<decltype(observer(exec, step, spins))> ||
               std::is_same_v<decltype(observer(exec, step, spins)), Next>;
};

/// Evaluations of the generator in each step; none where their number depends on the spins.
template <class Stepper>
constexpr std::optional<int> evaluations_per_step() {
  if constexpr (detail::has_evaluations<Stepper>) {
    if (Stepper::evaluations > 0) return Stepper::evaluations;
  }
  return std::nullopt;
}

namespace detail {

/// An observer may be a std::reference_wrapper of one, too.
template <class Observer>
inline constexpr bool changes_spins =
    requires { requires std::remove_cvref_t<std::unwrap_ref_decay_t<Observer>>::changes_spins; };

template <class Observer>
bool is_due(Observer const& observer, Step const& step) {
  std::unwrap_reference_t<Observer> const& itself = observer;
  if constexpr (requires {
                  { itself.due(step) } -> std::convertible_to<bool>;
                })
    return itself.due(step);
  else
    return true;
}

}  // namespace detail
}  // namespace cayspin::inline v0_1
