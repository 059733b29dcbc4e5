// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "terms_of_scene.hpp"

#include <cayspin/detail/execution.hpp>
#include <cayspin/detail/for_each_site.hpp>
#include <cayspin/detail/reduce_sites.hpp>

#include <Kokkos_Profiling_ScopedRegion.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

namespace cayspin::simulation {

template <class Spins>
template <class Exec>
auto FieldInPass<Spins>::Terms::at(Exec const& exec, SceneFieldNow<Real> const& usual,
                                   Spins const& spins, double t, FieldFor purpose) const
    -> PassTerms<Real> {
  auto others = usual;
  others.zeeman = {};
  others.has_applied = false;
  auto const velocity = torques_.velocity ? (*torques_.velocity)(t) : Vec3<double>{0, 0, 0};
  auto const strengths = torques_.strengths ? (*torques_.strengths)(t) : Vec3<double>{0, 0, 0};
  bool const has_usual = has_lattice_terms_ || others.quadratic.present() || others.has_stored;
  PassTerms<Real> terms{.usual = others,
                        .pairs = pairs_.prepare(exec, spins, t),
                        .zhang_li = {lattice_, velocity, torques_.nonadiabaticity},
                        .slonczewski = Slonczewski({.damping_like = strengths.x,
                                                    .field_like = strengths.y,
                                                    .polarization = torques_.polarization}),
                        .applied = usual.zeeman,
                        .sites = sites_.data(),
                        .cubics = cubics_.data(),
                        .exchange_of_sites = {},
                        .dmi_of_sites = {},
                        .anisotropies_of_sites = anisotropies_.data(),
                        .anisotropies = static_cast<std::int32_t>(anisotropies_.size()),
                        .cubics_of_cell = static_cast<std::int32_t>(cubics_.size()),
                        .moments = moments_.array(),
                        .applied_in_field = usual.zeeman.applied,
                        .has_usual = has_usual,
                        .has_pairs = has_pairs_,
                        .has_zhang_li = torques_.velocity.has_value(),
                        .has_slonczewski = torques_.strengths.has_value(),
                        .has_vacancies = has_vacancies_,
                        .is_gradient = purpose == FieldFor::energy};
  if (exchange_of_sites_) terms.exchange_of_sites = exchange_of_sites_->prepared();
  if (dmi_of_sites_) {
    terms.dmi_of_sites.constants = dmi_of_sites_->array();
    std::copy_n(dmi_vectors_, 3, terms.dmi_of_sites.vectors);
  }
  return terms;
}

template <class Spins>
auto FieldInPass<Spins>::Terms::in_stages(SceneFieldNow<Real> const& usual) const
    -> std::optional<SceneFieldNow<Real>> {
  if (lattice_.cell_sites > 1 || has_pairs_) return std::nullopt;
  auto const& site = cell_[0];
  auto now = usual;
  now.lattice_terms = seen_;
  now.quadratic = usual.quadratic.with(site.quadratic, site.gyromagnetic * site.per_moment);
  now.zeeman.applied = site.gyromagnetic * usual.zeeman.applied;
  now.has_stored = false;
  return now;
}

template <class Spins>
FieldInPass<Spins>::FieldInPass(io::Scene const& scene, Lattice const& lattice)
    : terms_(std::make_shared<Terms const>(scene, lattice)) {}

template <class Spins>
template <class Exec>
SceneFieldNow<typename Spins::value_type> FieldInPass<Spins>::evaluate(
    Exec const& exec, SceneFieldNow<Real> const& usual, Spins const& spins, double t,
    FieldFor purpose) const {
  return evaluate_with(exec, usual, spins, t, purpose, terms_->adds_applied(purpose));
}

template <class Spins>
template <class Exec>
SceneFieldNow<typename Spins::value_type> FieldInPass<Spins>::evaluate_with(
    Exec const& exec, SceneFieldNow<Real> const& usual, Spins const& spins, double t,
    FieldFor purpose, bool adds_applied) const {
  Kokkos::Profiling::ScopedRegion const region("cayspin::FieldInPass");
  // Bonds reach further than the ghosts that a stage before this one has kept up to date. The field
  // of ghosts is nobody's concern: what a stage makes of it is replaced before the next look.
  cayspin::detail::update_ghosts(exec, terms_->lattice_, spins);
  EvaluateInPass<Real> kernel{.terms = terms_->at(exec, usual, spins, t, purpose),
                              .spins = spins.array(),
                              .moves = {},
                              .field = terms_->field_.output(false),
                              .energies = terms_->energies_.output(false)};
  if (terms_->moves_ && purpose != FieldFor::generator) kernel.moves = terms_->moves_->array();
  auto now = nothing();
  if (adds_applied) {
    now.zeeman.applied = gyromagnetic() * usual.zeeman.applied;
    kernel.terms.applied_in_field = {0, 0, 0};
  }
  cayspin::detail::for_each_site<Real>(exec, "cayspin::FieldInPass", spins.layout(), kernel,
                                       spins.layout().own);
  now.stored = {terms_->field_.array(), -0.5};
  now.has_stored = true;
  now.energies = terms_->energies_.array();
  now.lattice_terms.magnitude +=
      terms_->largest_moment_ * std::sqrt(dot(usual.zeeman.applied, usual.zeeman.applied));
  return now;
}

template <class Spins>
template <class Exec>
SceneFieldNow<typename Spins::value_type> FieldInPass<Spins>::along_rows(
    Exec const& exec, SceneFieldNow<Real> const& usual, Spins const& spins, double t,
    FieldFor purpose) const {
  if constexpr (cayspin::detail::is_host_execution<Exec>) {
    // The bonds of couplings reach further than the ghosts that a stage has kept up to date.
    bool const reaches_far = terms_->has_pairs_ && terms_->lattice_.part != nullptr;
    if (!reaches_far && purpose == FieldFor::generator) {
      auto& last = terms_->last_along_rows_;
      last = (last + 1) % terms_->along_rows_.size();
      auto& kept = terms_->along_rows_[last];
      auto const terms = terms_->at(exec, usual, spins, t, purpose);
      if (auto now = terms_->in_stages(usual)) {
        auto const& site = terms_->cell_[0];
        AddedTerms<Real> added{terms, {}, site.gyromagnetic * site.per_moment};
        if (terms_->missing_) added.missing.exchange = terms_->missing_->array();
        if (added.any())
          now->along_rows = {&evaluate_along<AddedTerms<Real>, Real>,
                             &kept.template emplace<AddedTerms<Real>>(added)};
        return *now;
      }
      auto now = nothing();
      bool const lacks_local = terms.has_pairs && terms.has_few() && terms_->sites_are_alike();
      if (lacks_local) {
        now.quadratic = terms_->cell_[0].quadratic;
        now.zeeman.applied = terms.applied_in_field;
      }
      now.along_rows = {&evaluate_along<WholeTerms<Real>, Real>,
                        &kept.template emplace<WholeTerms<Real>>(terms, lacks_local), true,
                        lacks_local};
      return now;
    }
  }
  return evaluate_with(exec, usual, spins, t, purpose, false);
}

template <class Spins>
OwnOfSites<typename Spins::value_type> FieldInPass<Spins>::own_of_sites() const {
  OwnOfSites<Real> own{.precession = terms_->precession_};
  if (terms_->moves_) own.rates = terms_->moves_->array();
  if (terms_->rates_) own.rates = terms_->rates_->array();
  if (terms_->dampings_) own.dampings = terms_->dampings_->array();
  return own;
}

template <class Spins>
double FieldInPass<Spins>::gyromagnetic() const {
  return terms_->cell_[0].gyromagnetic;
}

template <class Spins>
SceneFieldNow<typename Spins::value_type> FieldInPass<Spins>::nothing() const {
  return {terms_->none_, {}, {}, {}, false, false};
}

template <class Spins>
template <class Exec>
Vec3<double> FieldInPass<Spins>::magnetization(Exec const& exec, Spins const& spins) const {
  return cayspin::magnetization(exec, spins, terms_->moments_);
}

template <class Spins>
template <class Exec>
double FieldInPass<Spins>::norm_defect(Exec const& exec, Spins const& spins) const {
  using cayspin::detail::Maximum;
  auto const largest = cayspin::detail::reduce_sites<Maximum, 2>(
      exec, "cayspin::FieldInPass::norm_defect", spins.layout(),
      NormDefectOfMoments<Real>{spins.array(), terms_->moments_.array()});
  return cayspin::detail::norm_defect_of(largest[0], largest[1]);
}

template <class Spins>
bool FieldInPass<Spins>::rows_need_time_alone() const {
  return !terms_->has_pairs_;
}

template <class Spins>
bool FieldInPass<Spins>::is_affine() const {
  return terms_->is_affine_;
}

template <class Spins>
auto FieldInPass<Spins>::moves() const -> std::optional<ScalarField<Real, Memory>> const& {
  return terms_->moves_;
}

#define CAYSPIN_INSTANTIATE(Space, Real)                                                      \
  template class FieldInPass<SpinField<Real, Space::memory_space>>;                           \
  template SceneFieldNow<Real> FieldInPass<SpinField<Real, Space::memory_space>>::evaluate(   \
      Space const&, SceneFieldNow<Real> const&, SpinField<Real, Space::memory_space> const&,  \
      double, FieldFor) const;                                                                \
  template SceneFieldNow<Real> FieldInPass<SpinField<Real, Space::memory_space>>::along_rows( \
      Space const&, SceneFieldNow<Real> const&, SpinField<Real, Space::memory_space> const&,  \
      double, FieldFor) const;                                                                \
  template Vec3<double> FieldInPass<SpinField<Real, Space::memory_space>>::magnetization(     \
      Space const&, SpinField<Real, Space::memory_space> const&) const;                       \
  template double FieldInPass<SpinField<Real, Space::memory_space>>::norm_defect(             \
      Space const&, SpinField<Real, Space::memory_space> const&) const;
CAYSPIN_FOR_EACH_SPACE(CAYSPIN_INSTANTIATE, double)
CAYSPIN_FOR_EACH_SPACE(CAYSPIN_INSTANTIATE, float)
#undef CAYSPIN_INSTANTIATE

}  // namespace cayspin::simulation
