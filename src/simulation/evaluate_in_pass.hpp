// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "pass_terms.hpp"

#include <cayspin/detail/reduce_sites.hpp>
#include <cayspin/detail/row_fields.hpp>
#include <cayspin/scalars.hpp>
#include <cayspin/stencil.hpp>

#include <cstdint>

namespace cayspin::simulation {

/// Writes H and E of every site, or H along a row.
template <class Real>
struct EvaluateInPass {
  PassTerms<Real> terms;
  cayspin::detail::SiteArray<Real, 3> spins;
  cayspin::detail::SiteArray<Real, 1> moves, dampings;  // without data: all do, and none
  bool precession;
  cayspin::detail::OutputArray<Real, 3> field;
  cayspin::detail::OutputArray<Real, 1> energies;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    auto const found = terms(Stencil<Site, Real>(site, spins));
    site.store(turning(site, found.field), field);
    site.store(found.energy, energies);
  }

  static void along_row(void const* kernel, cayspin::detail::Row const& row, std::int32_t begin,
                        std::int32_t end, cayspin::detail::RowFields<Real> const& to) {
    EvaluateInPass const& self = *static_cast<EvaluateInPass const*>(kernel);
    using Value = cayspin::detail::Pack<Real>;
    using Site = cayspin::detail::Site<Value>;
    auto const& terms = self.terms;
    if (terms.has_pairs) terms.pairs.evaluate_row(row, begin, end, to);
    if (terms.has_pairs && terms.has_few() && !self.dampings.data && !self.moves.data)
      return terms.add_few({self.spins.data + row.offset, self.spins.stride}, row, begin, end, to);
    for (std::int32_t x = begin; x < end; x += Site::lanes) {
      Site const site(row, x);
      auto const of_pairs = terms.has_pairs ? to.template load<Value>(x - begin) : zero<Value>();
      auto const found =
          terms.beside_pairs(Stencil<Site, Real>(site, self.spins), {of_pairs, Value(0)});
      to.store(self.turning(site, found.field), x - begin);
    }
  }

 private:
  /// With what dampings of sites add, and zero where a spin is frozen.
  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION auto turning(Site const& site,
                                           Vec3<typename Site::value_type> h) const {
    if (dampings.data) {
      auto const turned = site.load(dampings) * cross(site.load(spins), h);
      h = precession ? h + turned : turned;
    }
    if (moves.data) h = site.load(moves) * h;
    return h;
  }
};

/// NormDefectOfSites where there is a moment.
template <class Real>
struct NormDefectOfMoments {
  cayspin::detail::SiteArray<Real, 3> spins;
  cayspin::detail::SiteArray<Real, 1> moments;

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Value* values) const {
    using cayspin::detail::select;
    cayspin::detail::off_the_sphere(Vec3<Value>(site.load(spins)), values);
    Value const none(0.0), moment = site.load(moments);
    for (int i = 0; i < 2; ++i) values[i] = select<Value>(moment == none, none, values[i]);
  }
};

}  // namespace cayspin::simulation
