// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/optional_members.hpp>
#include <cayspin/spin_field.hpp>
#include <cayspin/stencil.hpp>

namespace cayspin::inline v0_2::detail {

/// Functor that writes a prepared term's field into an array.
template <class Term, class Real>
struct FieldOfSites {
  Term term;
  SiteArray<Real, 3> spins;
  OutputArray<Real, 3> output;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    using AtSite = Stencil<Site, Real>;
    check_field<Term, AtSite>();
    site.store(term.field(AtSite(site, spins)), output);
  }
};

}  // namespace cayspin::inline v0_2::detail
