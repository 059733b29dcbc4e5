// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/generator/rigid_body.hpp>
#include <cayspin/spin_field.hpp>

#include <optional>
#include <utility>
#include <vector>

namespace cayspin::program {

/// Rigid bodies that share an inertia, or have one each: asked at run time.
template <class Many>
struct SceneBodiesNow {
  RigidBody one;
  Many many;
  bool each;

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> operator()(
      Stencil const& stencil) const {
    return each ? many(stencil) : one(stencil);
  }
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION typename Stencil::value_type energy_density(
      Stencil const& stencil) const {
    return each ? many.energy_density(stencil) : one.energy_density(stencil);
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
    return SceneBodiesNow<Many>{one_, each_ ? each_->prepare(exec, spins, t) : Many{},
                                each_.has_value()};
  }

 private:
  RigidBody one_;
  std::optional<Ensemble> each_;
};

}  // namespace cayspin::program
