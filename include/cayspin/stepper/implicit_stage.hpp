// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/concepts.hpp>
#include <cayspin/stencil.hpp>
#include <cayspin/stepper/rate.hpp>

namespace cayspin::inline v0_1::detail {

/// One iterate of an implicit step, from A at `level`: the estimate of the end or of the middle.
template <class Isotropy, class Rotation, class Generator, class Real>
struct ImplicitStage {
  Generator generator;
  Isotropy isotropy;
  SiteArray<Real, 3> start, level;
  SiteArray<Real, 1> sigma;  // added to A along start, unless data is null
  OutputArray<Real, 3> next;
  Real dt;
  bool to_middle;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    using Value = typename Site::value_type;
    Stencil<Site, Real> const stencil(site, level);
    Vec3<Value> const m0 = site.load(start);
    Vec3<Value> xi = isotropy(stencil.center(), evaluate(generator, stencil));
    if (sigma.data != nullptr) xi = multiply_add(site.load(sigma), m0, xi);
    Vec3<Value> const m1 = Rotation::rotate(Vec3<Value>(Value(dt) * xi), m0);
    site.store(to_middle ? Vec3<Value>(Value(0.5) * (m0 + m1)) : m1, next);
  }
};

/// sigma of an implicit step: <A', X> / |X|^2, less m.A where A is made orthogonal.
template <class Generator, class Real>
struct ImplicitSigmaStage {
  Generator generator;  // prepared on the rates
  SiteArray<Real, 3> rates, spins;
  OutputArray<Real, 1> sigma;  // holds m.A before
  bool orthogonal;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    using Value = typename Site::value_type;
    Stencil<Site, Real> const x(site, rates);
    Value const square = dot(x.center(), x.center());
    Value numerator = dot(rate_of(generator, site.load(spins), x), x.center());
    if (orthogonal) numerator = numerator - site.load(sigma) * square;
    site.store(guarded_quotient(numerator, square), sigma);
  }
};

}  // namespace cayspin::inline v0_1::detail
