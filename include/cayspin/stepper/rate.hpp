// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/concepts.hpp>
#include <cayspin/detail/for_each_site.hpp>
#include <cayspin/isotropy/policies.hpp>
#include <cayspin/isotropy/sigma.hpp>
#include <cayspin/spin_field.hpp>
#include <cayspin/stencil.hpp>

// sigma from the derivative of the generator along the flow: first the rates X of all spins, then
// the generator's derivative along them.
namespace cayspin::inline v0_1::detail {

/// X = A x m and m.A of every spin.
template <class Generator, class Real>
struct RateStage {
  Generator generator;
  SiteArray<Real, 3> spins;
  OutputArray<Real, 3> rates;
  OutputArray<Real, 1> along;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    Stencil<Site, Real> const stencil(site, spins);
    auto const a = evaluate(generator, stencil);
    site.store(cross(a, stencil.center()), rates);
    site.store(dot(a, stencil.center()), along);
  }
};

/// sigma of A_o from A' at m, X = A x m, and m.A.
template <class Value>
KOKKOS_FORCEINLINE_FUNCTION Value sigma_along_flow(isotropy::Analytic, Vec3<Value> const& rate,
                                                   Vec3<Value> const& x, Vec3<Value> const&,
                                                   Value const& along) {
  // A spin at rest gets no part along m, because F = 0 keeps the bits of m.
  return guarded_quotient(multiply_subtract(along, dot(x, x), dot(rate, x)), dot(x, x));
}

/// The same by the second derivative of the orbit, m'' = A' x m + A x X with A = m x X + (m.A) m.
template <class Value>
KOKKOS_FORCEINLINE_FUNCTION Value sigma_along_flow(isotropy::Connection, Vec3<Value> const& rate,
                                                   Vec3<Value> const& x, Vec3<Value> const& m,
                                                   Value const& along) {
  Vec3<Value> const a = multiply_add(along, m, cross(m, x));
  Vec3<Value> const second = cross(rate, m) + cross(a, x);
  return guarded_quotient(dot(second, cross(m, x)), dot(x, x));
}

/// The prepared generator whose derivative is taken. sigma replaces any part along m that it has.
template <class Generator>
auto bare(Generator const& prepared) {
  if constexpr (requires { prepared.bare(); })
    return prepared.bare();
  else
    return prepared;
}

template <class Generator, class Value, class Stencil>
KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> rate_of(Generator const& generator, Vec3<Value> const& m,
                                                Stencil const& rates) {
  static_assert(
      requires {
        { generator.rate(m, rates) } -> std::convertible_to<Vec3<Value>>;
      },
      "isotropy::Analytic and Connection need the generator's derivative: a const, device-callable "
      "template rate(m, rates) that returns A' at the spin m along the rates A x m around it.");
  return generator.rate(m, rates);
}

/// The rates of the spins, and m.A: the inputs of sigma.
template <class Spins>
class Rates {
  using Real = typename Spins::value_type;
  using Along = ScalarField<Real, typename Spins::memory_space>;

 public:
  Rates() = default;
  Rates(std::string const& name, Lattice const& lattice)
      : rates_(name + "::rates", lattice),
        along_(name + "::generator_along_spin", lattice),
        streaming_(exceeds_caches<typename Spins::memory_space::execution_space>(rates_.bytes() +
                                                                                 bytes())) {}

  std::size_t bytes() const { return rates_.bytes() + along_.bytes(); }
  Spins const& field() const { return rates_; }
  SiteArray<Real, 3> array() const { return rates_.array(); }
  SiteArray<Real, 1> along() const { return along_.array(); }
  OutputArray<Real, 1> along_output() const { return along_.output(false); }

  template <class Exec, class Generator>
  void compute(Exec const& exec, std::string const& label, Generator const& generator,
               Spins const& spins, double t) const {
    auto prepared = bare(prepare_term(generator, exec, spins, t));
    for_each_site<Real>(
        exec, label, spins.layout(),
        RateStage<decltype(prepared), Real>{std::move(prepared), spins.array(),
                                            rates_.output(streaming_), along_.output(false)},
        spins.layout().own_and(1));
  }

 private:
  Spins rates_;
  Along along_;
  bool streaming_ = false;  // stores of rates go around the caches
};

/// Geometric Euler with sigma: m <- cay(dt (A_o + sigma m)) m, in place.
template <class Isotropy, class Rotation, class Generator, class Real>
struct CorrectedEulerStage {
  Generator generator;  // prepared on the rates
  Isotropy isotropy;
  SiteArray<Real, 3> rates;
  SiteArray<Real, 1> along;
  OutputArray<Real, 3> spins;
  Real dt;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    using Value = typename Site::value_type;
    Stencil<Site, Real> const x(site, rates);
    Vec3<Value> const m = site.load(spins);
    Value const sigma =
        sigma_along_flow(isotropy, rate_of(generator, m, x), x.center(), m, site.load(along));
    Vec3<Value> const f = Value(dt) * multiply_add(sigma, m, cross(m, x.center()));
    site.store(Rotation::rotate(f, m), spins);
  }
};

}  // namespace cayspin::inline v0_1::detail
