// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/field/local_part.hpp>
#include <cayspin/optional_members.hpp>
#include <cayspin/spin_field.hpp>
#include <cayspin/stencil.hpp>
#include <cayspin/step.hpp>

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <type_traits>

// The five contracts of the library: what a user may bring, and what each of them may leave out.
// Terms and generators are templates over the stencil; the concepts check them with the host's
// stencil of Spins, by default spins of double precision in host memory.
namespace cayspin {

namespace detail {

template <class Spins>
using ExecutionOf = typename Spins::memory_space::execution_space;

template <class Spins>
using StencilOf = Stencil<Site<Pack<typename Spins::value_type>, true>, typename Spins::value_type>;

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

/// A stepper whose number of evaluations depends on the numbers counts them itself.
template <class Stepper>
concept counts_evaluations = requires(Stepper const& stepper) {
  { stepper.evaluations_done() } -> std::convertible_to<std::int64_t>;
};

}  // namespace detail

/// A term of the effective field, with H = -dE/dm. On devices, as const templates over the stencil
/// (Value = Stencil::value_type):
///
/// | member                         | says                                 | where it is left out |
/// |--------------------------------|--------------------------------------|----------------------|
/// | Vec3<Value> field(stencil)     | H at the stencil's centre            | required             |
/// | Value energy_density(stencil)  | the site's share of E                | required             |
/// | Value energy_magnitude(stencil)| the sum of its terms' abs(E)         | abs(energy_density)  |
/// | static int energy_terms,       | how many terms, and the E of each    | 1, energy_density    |
/// |   energy_densities(stencil, e) |   in e[0], e[1], ...                 |                      |
/// | static int degree              | 1: H does not depend on the spins,   | nothing: the next    |
/// |                                |   2: H is linear in them             |   two are asked      |
/// | Vec3<Value> linear_field(s)    | the linear part of an affine H       | by the degree        |
/// | Vec3<Value> field_rate(m, X)   | dH/dt at m along the rates X         | linear_field(X)      |
/// | static bool is_local           | H is of the spin itself and t alone  | false                |
/// | Vec3<Value> neighbor_field(s)  | H of the other spins                 | field, 0 where local |
/// | Vec3<Value> local_field(spin)  | the rest of H                        | 0, field where local |
/// | bool local_field_varies()      | does the rest change with the spin?  | true, false for 1    |
///
/// Steppers ask for linear_field, field_rate and degree where they need derivatives
/// (isotropy::Analytic and Series4), and for the local part where they split the field.
/// Multiples of the spin itself may be left out of neighbor_field and local_field.
///
/// On the host, called before kernels:
///
/// | member                          | says                                | where it is left out |
/// |---------------------------------|-------------------------------------|----------------------|
/// | check_spins(spins)              | throws for spins of another lattice | any spins are right  |
/// | auto prepare(exec, spins, t)    | the term for kernels, at time t     | the term itself      |
/// | auto prepare_rate(exec, rates,  | the same for dH/dt                  | prepare              |
/// |   t, dt)                        |                                     |                      |
/// | auto prepare_local(exec, spins, | the same for the local part;        | prepare where local, |
/// |   t)                            |   reads no spin                     |   otherwise nothing  |
/// | static bool depends_on_time     | H changes with t, and what is       | false                |
/// |                                 |   prepared does not with the spins  |                      |
/// | bool is_stationary(exec, spins) | what is prepared holds for all      | true without prepare |
/// |                                 |   times and spins                   |                      |
/// | bool needs_time_alone(exec,     | it can be prepared knowing t alone  | depends_on_time or   |
/// |   spins)                        |                                     |   is_stationary      |
///
/// A term with a prepare needs the device members in what that returns. One that is made of others
/// has the host members of those by Forwarding (field/forwarding.hpp). Conditions on values are
/// select(condition, yes, no): on the host a value is a pack of several sites, and no `if` works.
template <class Term, class Spins = SpinField<double, Kokkos::HostSpace>>
concept FieldTerm = requires {
  requires detail::has_field<detail::PreparedFor<Term, Spins>, detail::StencilOf<Spins>>;
  requires detail::has_energy_density<detail::PreparedFor<Term, Spins>, detail::StencilOf<Spins>>;
};

/// The A of m' = A x m. Members on the host are those of a FieldTerm; on devices:
///
/// | member                          | says                                | where it is left out |
/// |---------------------------------|-------------------------------------|----------------------|
/// | Vec3<Value> operator()(stencil) | A at the stencil's centre           | required             |
/// | energy_density and its like     | as of a FieldTerm                   | no energy            |
/// | bool is_conservative()          | E is kept, with A = -dE/dm up to a  | EnergyControl and    |
/// |                                 |   multiple of m (a host member)     |   EnergyProjection   |
/// |                                 |                                     |   refuse             |
/// | bool is_orthogonal()            | A has no part along m               | false                |
/// | G bare()                        | the same with that part             | itself               |
/// | Vec3<Value> rate(m, X)          | A' at m along the rates X           | isotropy::Analytic   |
/// |                                 |                                     |   refuses            |
/// | static bool is_local            | A is of the spin itself and t alone | false                |
/// | Vec3<Value> neighbor_field(s),  | A of a spin in a given field of     | field extrapolation  |
/// |   generator_at(spin, h)         |   the others                        |   refuses            |
/// | series_source(stencil),         | what Series4 differentiates, its    | Series4 refuses      |
/// |   linear_series_source(stencil),|   linear part, and d^K A / dt^K     |                      |
/// |   derivative<K>(m, source)      |                                     |                      |
template <class Type, class Spins = SpinField<double, Kokkos::HostSpace>>
concept Generator =
    detail::is_generator<detail::PreparedFor<Type, Spins>, detail::StencilOf<Spins>>;

/// A method that takes steps. A stepper is made for a lattice and holds its work memory.
///
/// | member                           | says                                | where it is left out
/// |
/// |----------------------------------|-------------------------------------|----------------------|
/// | spins_type                       | the SpinField that it advances      | required | |
/// step(exec, generator, spins, t,  | advances spins from t to t + dt     | required             |
/// |   dt)                            |                                     | | | static int
/// evaluations           | of the generator in each step       | one of these two is  | | int64
/// evaluations_done()         | of the generator so far             |   required           | |
/// static int order                 | of the error                        | not known            |
/// | reset()                          | forgets the steps so far            | nothing to forget |
/// | bool takes_batches(exec,         | may batch be called?                | false | | generator,
/// spins)              |                                     |                      | | batch(exec,
/// generator, spins, t, | `count` steps at once, to the same  | steps one by one     | |   dt,
/// count)                     |   bits                              |                      | |
/// static int work_fields           | fields of three numbers per site    | not known            |
/// | size_t work_bytes()              | bytes of work memory                | not known |
///
/// A step may exchange the memory of spins with the stepper's own.
template <class Type>
concept Stepper = requires(Type& stepper,
                           detail::ExecutionOf<typename Type::spins_type> const& exec,
                           typename Type::spins_type& spins) {
  stepper.step(exec, detail::AnyGenerator(), spins, 0.0, 0.0);
  requires detail::has_evaluations<Type> || detail::counts_evaluations<Type>;
};

/// A Stepper that chooses its own steps and delivers spins at the times that are asked for. It goes
/// on from a state of its own: what is written into `spins` between two steps has no effect.
///
/// | member                        | says                                          | left out |
/// |-------------------------------|-----------------------------------------------|----------|
/// | int64 evaluations_done()      | evaluations of the generator so far           | required |
/// | int64 accepted_steps()        | own steps taken so far                        | required |
/// | int64 rejected_steps()        | own steps thrown away so far                  | required |
/// | reset()                       | the next step begins at its own t and spins   | required |
template <class Type>
concept AdaptiveStepper = Stepper<Type> && detail::counts_evaluations<Type> &&
    requires(Type& stepper, Type const& constant) {
  { constant.accepted_steps() } -> std::convertible_to<std::int64_t>;
  { constant.rejected_steps() } -> std::convertible_to<std::int64_t>;
  stepper.reset();
};

/// Called by integrate() with the state before the first step and after each step.
///
/// | member                         | says                                  | where it is left out
/// |
/// |--------------------------------|---------------------------------------|----------------------|
/// | operator()(exec, Step, spins)  | returns nothing, or a Next            | required | | bool
/// due(Step)                 | is the call wanted at this step?      | true                 | |
/// static bool changes_spins      | writes into the spins; refused with   | false                |
/// |                                |   an AdaptiveStepper                  | |
template <class Type, class Spins = SpinField<double, Kokkos::HostSpace>>
concept Observer = std::is_invocable_v < Type&,
        detail::ExecutionOf<Spins>
const&, Step const&,
    Spins const& > &&requires(Type& observer, detail::ExecutionOf<Spins> const& exec,
                              Step const& step, Spins const& spins) {
  requires std::is_void_v<decltype(observer(exec, step, spins))> ||
      std::is_same_v<decltype(observer(exec, step, spins)), Next>;
};

/// Evaluations of the generator in each step; none where their number depends on the numbers.
template <class Stepper>
constexpr std::optional<int> evaluations_per_step() {
  if constexpr (detail::has_evaluations<Stepper>) {
    if (Stepper::evaluations > 0) return Stepper::evaluations;
  }
  return std::nullopt;
}

namespace detail {

template <class Observer>
inline constexpr bool changes_spins = [] {
  if constexpr (requires { Observer::changes_spins; }) return Observer::changes_spins;
  return false;
}();

template <class Observer>
bool is_due(Observer const& observer, Step const& step) {
  if constexpr (requires {
                  { observer.due(step) } -> std::convertible_to<bool>;
                })
    return observer.due(step);
  else
    return true;
}

}  // namespace detail
}  // namespace cayspin
