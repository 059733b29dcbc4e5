// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "backends.hpp"

#include <cayspin/concepts.hpp>
#include <cayspin/detail/for_each_site.hpp>
#include <cayspin/stencil.hpp>

#include <utility>

namespace cayspin::test {

/// Functor that writes source.field(stencil), or for a generator source(stencil), at every site.
template <class Source, class Real>
struct Evaluate {
  Source source;
  SiteArray<Real, 3> spins;
  OutputArray<Real, 3> result;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    Stencil<Site, Real> const stencil(site, spins);
    if constexpr (requires { source.field(stencil); })
      site.store(source.field(stencil), result);
    else
      site.store(source(stencil), result);
  }
};

/// Returns H of a field term or A of a generator at every site, (sites, 3), computed in the
/// precision of the spins.
template <class Exec, class Source, class Spins>
std::vector<double> evaluated(Exec const& exec, Source const& source, Spins const& spins,
                              double t = 0, bool streaming = false) {
  using Real = typename Spins::value_type;
  auto prepared = detail::prepare_term(source, exec, spins, t);
  Spins const result("result", spins.lattice());
  detail::for_each_site<Real>(exec, "evaluate", spins.layout(),
                              Evaluate<decltype(prepared), Real>{std::move(prepared), spins.array(),
                                                                 result.output(streaming)});
  exec.fence();
  return numbers_of(result);
}

}  // namespace cayspin::test
