// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/generator/orthogonal.hpp>
#include <cayspin/generator/rigid_body.hpp>
#include <cayspin/spin_field.hpp>

#include <cayspin_paper/series_source.hpp>

#include <optional>
#include <utility>
#include <vector>

namespace cayspin::simulation {

/// Rigid bodies with one inertia for all, or with one for each body; selected at run time.
template <class Many>
struct SceneBodiesNow : cayspin::detail::BodyGenerator<SceneBodiesNow<Many>> {
  RigidBody one;
  Many many;
  bool each;

  SceneBodiesNow(RigidBody const& one, Many const& many, bool each)
      : one(one), many(many), each(each) {}

  template <class Value, class Site>
  KOKKOS_FORCEINLINE_FUNCTION cayspin::detail::SymmetricMatrix<Value> inverse_inertia(
      Site const& site) const {
    return each ? many.template inverse_inertia<Value>(site)
                : one.template inverse_inertia<Value>(site);
  }
};

/// The generator of rigid bodies, for methods that treat them differently from spins; with or
/// without the component of A along the spin, selected at run time.
template <class Bodies>
struct RigidBodiesNow {
  static constexpr bool is_local = true;
  Bodies bodies;
  bool orthogonal;

  KOKKOS_FORCEINLINE_FUNCTION bool is_orthogonal() const { return orthogonal; }

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> operator()(
      Stencil const& stencil) const {
    auto const a = bodies(stencil);
    return orthogonal ? cayspin::detail::orthogonal_part(a, stencil.center()) : a;
  }
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> series_source(
      Stencil const& stencil) const {
    return bodies(stencil);
  }
  template <int K, class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> derivative(Vec3<Value> const* m,
                                                     Vec3<Value> const* source) const {
    return orthogonal ? cayspin::detail::orthogonal_derivative<K>(bodies, m, source)
                      : cayspin::detail::series_derivative<K>(bodies, m, source);
  }
  template <class Value, class Site>
  KOKKOS_FORCEINLINE_FUNCTION auto inverse_inertia(Site const& site) const {
    return bodies.template inverse_inertia<Value>(site);
  }
};

/// The bodies of a scene of kind rigid_body.
template <class Spins>
class SceneBodies {
  using Ensemble = RigidBodyEnsemble<typename Spins::value_type, typename Spins::memory_space>;

 public:
  using Many = decltype(std::declval<Ensemble const&>().prepare(
      std::declval<typename Spins::memory_space::execution_space const&>(),
      std::declval<Spins const&>(), 0.0));

  /// `inverse_inertia`: one tensor for all bodies, or one per body.
  SceneBodies(std::vector<SymmetricTensor> const& inverse_inertia, Lattice const& lattice)
      : one_(inverse_inertia.front()) {
    if (inverse_inertia.size() == 1) return;
    typename Ensemble::Tensors const tensors("inverse_inertia", lattice);
    std::vector<double> numbers;
    numbers.reserve(6 * inverse_inertia.size());
    for (auto const& tensor : inverse_inertia)
      numbers.insert(numbers.end(), tensor.begin(), tensor.end());
    copy_from_host(numbers, tensors);
    each_.emplace(tensors);
  }

  template <class Exec>
  SceneBodiesNow<Many> prepare(Exec const& exec, Spins const& spins, double t) const {
    return SceneBodiesNow<Many>(
        one_, each_ ? cayspin::detail::prepare_term(*each_, exec, spins, t) : Many{},
        each_.has_value());
  }

 private:
  RigidBody one_;
  std::optional<Ensemble> each_;
};

template <class Spins>
struct RigidBodies {
  SceneBodies<Spins> bodies;
  bool orthogonal;

  template <class Exec>
  auto prepare(Exec const& exec, Spins const& spins, double t) const {
    return RigidBodiesNow{bodies.prepare(exec, spins, t), orthogonal};
  }
  template <class Exec>
  bool is_stationary(Exec const&, Spins const&) const {
    return true;
  }
};

}  // namespace cayspin::simulation
