// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "anisotropies_of_scene.hpp"
#include "bonds_between_regions.hpp"
#include "exchange_and_dmi_of_scene.hpp"
#include "moments_and_rates_of_scene.hpp"
#include "sources_of_scene.hpp"
#include "terms_of_scene.hpp"
#include "torques_of_scene.hpp"

#include <cayspin/detail/execution.hpp>
#include <cayspin/detail/for_each_site.hpp>
#include <cayspin/detail/reduce_sites.hpp>
#include <cayspin/scalars.hpp>

#include <Kokkos_Profiling_ScopedRegion.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <type_traits>
#include <vector>

// FieldInPass and its kernels, for the two files that each compile one precision.
namespace cayspin::simulation {

template <class Spins>
template <class Exec>
auto FieldInPass<Spins>::Terms::at(Exec const& exec, SceneFieldNow<Real> const& usual,
                                   Spins const& spins, double t, FieldFor purpose) const
    -> PassTerms<Real> {
  auto others = usual;
  others.zeeman = {};
  others.has_applied = false;
  if (per_moments_) others.has_stored = false;
  auto const factors = factors_at(t);
  if (in_time_) others.lattice_terms = lattice_terms_at(factors, 1);
  auto const velocity = torques_.velocity ? (*torques_.velocity)(t) : Vec3<double>{0, 0, 0};
  auto const strengths = torques_.strengths ? (*torques_.strengths)(t) : Vec3<double>{0, 0, 0};
  bool const has_usual = has_lattice_terms_ || others.quadratic.present() || others.has_stored;
  PassTerms<Real> terms{.usual = others,
                        .pairs = pairs_.prepare(exec, spins, t),
                        .zhang_li = {lattice_, velocity, torques_.nonadiabaticity},
                        .slonczewski = Slonczewski({.damping_like = strengths.x,
                                                    .field_like = strengths.y,
                                                    .polarization = torques_.polarization}),
                        .slonczewski_of_sites = {},
                        .applied = usual.zeeman,
                        .sites = sites_.data(),
                        .cubics = cubics_.data(),
                        .exchange_of_sites = {},
                        .dmi_of_sites = {},
                        .interlayer_of_sites = {.spins = {spins.array(), spins.layout()}},
                        .anisotropies_of_sites = anisotropies_.data(),
                        .crystals_of_sites = crystals_.data(),
                        .dmis = 0,
                        .anisotropies = static_cast<std::int32_t>(anisotropies_.size()),
                        .crystals = static_cast<std::int32_t>(crystals_.size()),
                        .cubics_of_cell = static_cast<std::int32_t>(cubics_.size()),
                        .anisotropies_in_time = anisotropies_in_time_,
                        .exchange_factor = factors.exchange,
                        .anisotropy_factor = factors.anisotropy,
                        .moments = moments_.array(),
                        .sources = sources_at(exec, t),
                        .per_moments = {},
                        .per_gyromagnetic = {},
                        .of_all = usual.stored,
                        .applied_in_field = usual.zeeman.applied,
                        .has_usual = has_usual,
                        .has_pairs = has_pairs_,
                        .has_zhang_li = torques_.velocity.has_value(),
                        .zhang_li_per_moment = torques_.velocity_per_moment,
                        .has_slonczewski = torques_.strengths && !torques_.needs_site_term,
                        .has_slonczewski_of_sites = torques_.needs_site_term,
                        .has_vacancies = has_vacancies_,
                        .has_of_all = per_moments_ && usual.has_stored,
                        .is_gradient = purpose == FieldFor::energy};
  if (per_moments_) terms.per_moments = per_moments_->array();
  if (per_gyromagnetic_) terms.per_gyromagnetic = per_gyromagnetic_->array();
  if (torques_.needs_site_term) terms.slonczewski_of_sites = slonczewski_of_sites(strengths);
  if (exchange_of_sites_) terms.exchange_of_sites = exchange_of_sites_->prepared();
  terms.interlayer_of_sites.distant = distant_bonds_.data();
  terms.interlayer_of_sites.distant_count = static_cast<std::int32_t>(distant_bonds_.size());
  if (exchange_at_faces_) {
    terms.interlayer_of_sites.exchange = exchange_at_faces_->array();
    terms.interlayer_of_sites.sweeps = sweeps_of_faces_;
  }
  for (int axis = 0; axis < 3; ++axis)
    if (interlayers_[axis].bilinear) {
      double const spacing = lattice_.spacing[static_cast<std::size_t>(axis)];
      terms.interlayer_of_sites.per_square[axis] = 2 / (spacing * spacing);
      terms.interlayer_of_sites.bilinear[axis] = interlayers_[axis].bilinear->array();
      terms.interlayer_of_sites.biquadratic[axis] = interlayers_[axis].biquadratic->array();
    }
  for (auto const& [constants, vectors] : dmis_of_sites_) {
    auto& dmi = terms.dmi_of_sites[terms.dmis++];
    dmi.constants = constants.array();
    for (std::size_t axis = 0; axis < 3; ++axis) dmi.vectors[axis] = factors.dmi * vectors[axis];
  }
  return terms;
}

template <class Spins>
auto FieldInPass<Spins>::Terms::factors_at(double t) const -> Factors {
  if (!in_time_) return {};
  auto const [exchange, anisotropy, dmi] = (*in_time_)(t);
  return {exchange, anisotropy, dmi};
}

template <class Spins>
SceneLatticeTerms FieldInPass<Spins>::Terms::lattice_terms_at(Factors const& factors,
                                                              double scale) const {
  auto field = uniform_;
  io::for_each_lattice_term(field, [&]<class Term>(std::optional<Term>& term) {
    constexpr bool is_exchange = std::is_same_v<Term, io::Exchange>;
    if (term) term->strength() *= scale * (is_exchange ? factors.exchange : factors.dmi);
  });
  return lattice_terms_of(field, lattice_);
}

template <class Spins>
auto FieldInPass<Spins>::Terms::in_stages(SceneFieldNow<Real> const& usual, double t) const
    -> std::optional<SceneFieldNow<Real>> {
  // If terms reach far, several ranks compute the whole H in memory. A run on one rank has to sum
  // the terms in the same order, so its stages do not evaluate some of them separately.
  if (lattice_.cell_sites > 1 || reaches_far() || per_moments_) return std::nullopt;
  auto const& site = cell_[0];
  double const seen = site.gyromagnetic * site.per_moment;
  auto const factors = factors_at(t);
  auto now = usual;
  now.lattice_terms = in_time_ ? lattice_terms_at(factors, seen) : seen_;
  now.couples_along_x = now.lattice_terms.couples_along_x();
  auto const axes = QuadraticTerms().with(site.quadratic, factors.anisotropy);
  now.quadratic = usual.quadratic.with(axes, seen);
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
  // All ghosts are updated, because bonds may reach further than the ghosts that the previous stage
  // has updated. H is not computed on ghost sites: each stage's result there is replaced before it
  // is read.
  cayspin::detail::update_ghosts(exec, terms_->lattice_, spins);
  EvaluateInPass<Real> kernel{.terms = terms_->at(exec, usual, spins, t, purpose),
                              .spins = spins.array(),
                              .moves = {},
                              .field = terms_->field_.output(false),
                              .energies = terms_->energies_.output(false),
                              .is_field = purpose == FieldFor::itself};
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
  auto const [exchange, anisotropy, dmi] = terms_->factors_at(t);
  now.lattice_terms.magnitude *=
      std::max({1.0, std::abs(exchange), std::abs(anisotropy), std::abs(dmi)});
  // A bound on a site's |energy| in the applied field and in the fields of the sources.
  auto const& applied = usual.zeeman.applied;
  now.lattice_terms.magnitude +=
      terms_->largest_moment_ * (std::sqrt(dot(applied, applied)) + kernel.terms.sources.largest);
  return now;
}

template <class Spins>
template <class Exec>
SceneFieldNow<typename Spins::value_type> FieldInPass<Spins>::along_rows(
    Exec const& exec, SceneFieldNow<Real> const& usual, Spins const& spins, double t,
    FieldFor purpose) const {
  if constexpr (cayspin::detail::is_host_execution<Exec>) {
    // On a part of a lattice, distant bonds may need ghosts that no stage updates; evaluate_with()
    // below updates all ghosts.
    bool const reaches_ghosts = terms_->reaches_far() && terms_->lattice_.part != nullptr;
    if (!reaches_ghosts && purpose == FieldFor::generator) {
      auto& last = terms_->last_along_rows_;
      last = (last + 1) % terms_->along_rows_.size();
      auto& kept = terms_->along_rows_[last];
      auto const terms = terms_->at(exec, usual, spins, t, purpose);
      if (auto now = terms_->in_stages(usual, t)) {
        auto const& site = terms_->cell_[0];
        AddedTerms<Real> added{terms, {}, site.gyromagnetic * site.per_moment, site.gyromagnetic};
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
bool FieldInPass<Spins>::rows_need_only_time() const {
  return !terms_->reaches_far();
}

template <class Spins>
bool FieldInPass<Spins>::is_affine() const {
  return terms_->is_affine_;
}

template <class Spins>
auto FieldInPass<Spins>::moments_of_sites() const -> std::optional<ScalarField<Real, Memory>> {
  if (!terms_->per_moments_) return std::nullopt;
  return terms_->moments_;
}

template <class Spins>
auto FieldInPass<Spins>::moves() const -> std::optional<ScalarField<Real, Memory>> const& {
  return terms_->moves_;
}

#define CAYSPIN_COMPILE_FIELD_IN_PASS(Space, Real)                                            \
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

}  // namespace cayspin::simulation
