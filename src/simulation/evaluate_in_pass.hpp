// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "pass_terms.hpp"

#include <cayspin/detail/reduce_sites.hpp>
#include <cayspin/scalars.hpp>
#include <cayspin/stencil.hpp>

namespace cayspin::simulation {

/// Functor that writes the field and the energy of every site. The field is H times the
/// gyromagnetic ratio, or H if `is_field` is true, or -dE/dm if terms.is_gradient is true. It is
/// zero at sites that do not move.
template <class Real>
struct EvaluateInPass {
  PassTerms<Real> terms;
  cayspin::SiteArray<Real, 3> spins;
  cayspin::SiteArray<Real, 1> moves;  // 0 or 1; without data: all move
  cayspin::OutputArray<Real, 3> field;
  cayspin::OutputArray<Real, 1> energies;
  bool is_field = false;  // write H, not H times the gyromagnetic ratio

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    auto found = terms(Stencil<Site, Real>(site, spins));
    if (is_field)
      found.field =
          as_value<typename Site::value_type>(1 / terms.site_of_plane(site.z()).gyromagnetic) *
          found.field;
    if (moves.data) found.field = site.load(moves) * found.field;
    site.store(found.field, field);
    site.store(found.energy, energies);
  }
};

/// Like NormDefectOfSites, but ignores sites without a moment.
template <class Real>
struct NormDefectOfMoments {
  cayspin::SiteArray<Real, 3> spins;
  cayspin::SiteArray<Real, 1> moments;

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Value* values) const {
    using cayspin::detail::select;
    cayspin::detail::off_the_sphere(Vec3<Value>(site.load(spins)), values);
    Value const none(0.0), moment = site.load(moments);
    for (int i = 0; i < 2; ++i) values[i] = select<Value>(moment == none, none, values[i]);
  }
};

}  // namespace cayspin::simulation
