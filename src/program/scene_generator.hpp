// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "scene_field.hpp"

#include <cayspin/generator/landau_lifshitz.hpp>
#include <cayspin/generator/rigid_body.hpp>

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
  auto prepare(Exec const& exec, Spins const& spins, double t) const {
    using Many = decltype(each_->prepare(exec, spins, t));
    return SceneBodiesNow<Many>{one_, each_ ? each_->prepare(exec, spins, t) : Many{},
                                each_.has_value()};
  }

 private:
  RigidBody one_;
  std::optional<Ensemble> each_;
};

/// The A of any scene at one instant, for kernels. One type for all scenes: which system it is, and
/// whether the part along the spin is removed, is asked at run time.
template <class Field, class Bodies>
struct SceneGeneratorNow {
  LandauLifshitz<Field> llg;
  Bodies bodies;
  bool is_llg, orthogonal;

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> operator()(
      Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    Vec3<Value> const a = is_llg ? llg(stencil) : bodies(stencil);
    if (!orthogonal) return a;
    return multiply_add(Value(Value(0) - dot(stencil.center(), a)), stencil.center(), a);
  }
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION typename Stencil::value_type energy_density(
      Stencil const& stencil) const {
    return is_llg ? llg.energy_density(stencil) : bodies.energy_density(stencil);
  }
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION typename Stencil::value_type energy_magnitude(
      Stencil const& stencil) const {
    return is_llg ? llg.energy_magnitude(stencil) : Kokkos::abs(bodies.energy_density(stencil));
  }
};

/// The generator that a scene's [system], [field] and integrator.generator describe.
template <class Spins>
class SceneGenerator {
 public:
  /// Throws io::SceneError for an inertia that cannot be.
  SceneGenerator(io::Scene const& scene, Lattice const& lattice)
      : llg_(SceneField<Spins>(scene, lattice), scene.system.damping, scene.system.precession),
        is_llg_(scene.system.kind == io::SystemKind::llg),
        orthogonal_(scene.integrator.generator == io::Generator::orthogonal),
        bodies_(is_llg_ ? std::vector{SymmetricTensor{}} : io::inverse_inertia(scene), lattice) {}

  /// The effective field alone, as the generator of a precession about it.
  SceneGenerator precession_alone() const {
    SceneGenerator other = *this;
    other.llg_ = LandauLifshitz(llg_.field(), 0, true);
    other.orthogonal_ = false;
    return other;
  }

  template <class Exec>
  auto prepare(Exec const& exec, Spins const& spins, double t) const {
    auto llg = llg_.prepare(exec, spins, t);
    auto bodies = bodies_.prepare(exec, spins, t);
    using Field = std::remove_cvref_t<decltype(llg.field())>;
    return SceneGeneratorNow<Field, decltype(bodies)>{llg, bodies, is_llg_, orthogonal_};
  }

 private:
  LandauLifshitz<SceneField<Spins>> llg_;
  bool is_llg_, orthogonal_;
  SceneBodies<Spins> bodies_;
};

/// The isotropies that are a number, zero among them: asked at run time.
struct SceneIsotropy {
  double sigma = 0;

  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> operator()(Vec3<Value> const& m,
                                                     Vec3<Value> const& a) const {
    if (sigma == 0) return a;
    return multiply_add(Value(static_cast<cayspin::detail::scalar_t<Value>>(sigma)), m, a);
  }
};

}  // namespace cayspin::program
