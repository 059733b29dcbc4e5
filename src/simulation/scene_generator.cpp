// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "scene_generator.hpp"

#include "dear_method.hpp"
#include "space.hpp"

#include <cayspin/io/scene.hpp>

#include <filesystem>
#include <system_error>
#include <utility>

namespace cayspin::simulation {

template <class Spins>
SceneField<Spins> field_of(io::Scene const& scene, Lattice const& lattice, bool has_dear) {
  std::optional<FieldInPass<Spins>> pass;
  if (io::needs_pass(scene)) pass.emplace(scene, lattice);
  auto field = io::without_numbers_of_sites(scene.field);
  std::error_code ignored;
  if (field.demag && std::filesystem::is_regular_file(scene.path, ignored))
    field.demag->kept_in = std::filesystem::path(scene.path).replace_extension(".demag");
  return SceneField<Spins>(field, lattice, has_dear, std::move(pass));
}

template <class Spins>
SceneGenerator<Spins>::SceneGenerator(io::Scene const& scene, Lattice const& lattice)
    : SceneGenerator(scene, lattice,
                     scene.system.kind == io::SystemKind::llg ? std::vector{SymmetricTensor{}}
                                                              : io::inverse_inertia(scene)) {}

template <class Spins>
SceneGenerator<Spins>::SceneGenerator(io::Scene const& scene, Lattice const& lattice,
                                      std::vector<SymmetricTensor> const& inverse_inertia)
    : llg_(field_of<Spins>(scene, lattice, has_dear_field(scene)), scene.system.damping,
           scene.system.precession || scene.system.dampings.there()),
      is_llg_(scene.system.kind == io::SystemKind::llg),
      orthogonal_(scene.integrator.generator == io::Generator::orthogonal),
      bodies_(inverse_inertia, lattice) {}

template <class Spins>
SceneGenerator<Spins> SceneGenerator<Spins>::precession_alone() const {
  SceneGenerator other = *this;
  other.llg_ = LandauLifshitz(llg_.field().made_for(FieldFor::itself), 0, true);
  other.orthogonal_ = false;
  other.alone_ = true;
  return other;
}

template <class Spins>
SceneGeneratorNow<Spins> SceneGenerator<Spins>::now(
    LandauLifshitz<SceneFieldNow<typename Spins::value_type>> const& llg,
    SceneBodiesNow<typename SceneBodies<Spins>::Many> const& bodies, bool is_llg) const {
  SceneGeneratorNow<Spins> now{llg, bodies, is_llg, orthogonal_};
  if (auto const& pass = llg_.field().pass(); pass && !alone_) now.own = pass->own_of_sites();
  return now;
}

template <class Spins>
template <class Exec>
SceneGeneratorNow<Spins> SceneGenerator<Spins>::prepare(Exec const& exec, Spins const& spins,
                                                        double t) const {
  return now(llg_.prepare(exec, spins, t), bodies_.prepare(exec, spins, t), is_llg_);
}

template <class Spins>
template <class Exec>
SceneGeneratorNow<Spins> SceneGenerator<Spins>::prepare_for_rows(Exec const& exec,
                                                                 Spins const& spins,
                                                                 double t) const {
  auto const llg = llg_.prepare_for_rows(exec, spins, t);
  return now(llg, bodies_.prepare(exec, spins, t), is_llg_ && !llg.part().along_rows.is_whole);
}

template <class Spins>
template <class Exec>
SceneGeneratorNow<Spins> SceneGenerator<Spins>::prepare_local(Exec const& exec, Spins const& spins,
                                                              double t) const {
  return now(llg_.prepare_local(exec, spins, t), bodies_.prepare(exec, spins, t), is_llg_);
}

template <class Spins>
template <class Exec>
SceneGeneratorNow<Spins> SceneGenerator<Spins>::prepare_rate(Exec const& exec, Spins const& rates,
                                                             double t, double dt) const {
  return now(llg_.prepare_rate(exec, rates, t, dt), bodies_.prepare(exec, rates, t), is_llg_);
}

#define CAYSPIN_INSTANTIATE(Space, Real)                                        \
  template SceneGeneratorNow<SpinField<Real, Space::memory_space>>              \
  SceneGenerator<SpinField<Real, Space::memory_space>>::prepare(                \
      Space const&, SpinField<Real, Space::memory_space> const&, double) const; \
  template SceneGeneratorNow<SpinField<Real, Space::memory_space>>              \
  SceneGenerator<SpinField<Real, Space::memory_space>>::prepare_for_rows(       \
      Space const&, SpinField<Real, Space::memory_space> const&, double) const; \
  template SceneGeneratorNow<SpinField<Real, Space::memory_space>>              \
  SceneGenerator<SpinField<Real, Space::memory_space>>::prepare_local(          \
      Space const&, SpinField<Real, Space::memory_space> const&, double) const; \
  template SceneGeneratorNow<SpinField<Real, Space::memory_space>>              \
  SceneGenerator<SpinField<Real, Space::memory_space>>::prepare_rate(           \
      Space const&, SpinField<Real, Space::memory_space> const&, double, double) const;
CAYSPIN_FOR_EACH_SPACE(CAYSPIN_INSTANTIATE, double)
CAYSPIN_FOR_EACH_SPACE(CAYSPIN_INSTANTIATE, float)
#undef CAYSPIN_INSTANTIATE

#define CAYSPIN_INSTANTIATE(Space, Real)                                               \
  template class SceneGenerator<SpinField<Real, Space::memory_space>>;                 \
  template SceneField<SpinField<Real, Space::memory_space>> field_of(io::Scene const&, \
                                                                     Lattice const&, bool);
CAYSPIN_FOR_EACH_SPACE(CAYSPIN_INSTANTIATE, double)
CAYSPIN_FOR_EACH_SPACE(CAYSPIN_INSTANTIATE, float)
#undef CAYSPIN_INSTANTIATE

}  // namespace cayspin::simulation
