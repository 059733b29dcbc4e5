// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/concepts.hpp>
#include <cayspin/detail/for_each_site.hpp>
#include <cayspin/generator/landau_lifshitz.hpp>
#include <cayspin/generator/orthogonal.hpp>
#include <cayspin/generator/rigid_body.hpp>
#include <cayspin/isotropy/sigma.hpp>
#include <cayspin/spin_field.hpp>
#include <cayspin/stencil.hpp>
#include <cayspin/stepper/implicit.hpp>
#include <cayspin/stepper/methods.hpp>
#include <cayspin/stepper/stepper_base.hpp>

#include <cayspin_paper/field_rate.hpp>

#include <concepts>
#include <cstddef>
#include <string>
#include <type_traits>
#include <utility>

// sigma from the derivative of the generator along the flow. First the rates X of all spins are
// computed, then the generator's derivative along them. field_rate.hpp lists the members that field
// terms need. A user's generator needs
//   Vec3<Value> rate(m, rates)    A' at m along the rates of the stencil's array
//   auto bare()                   the generator that keeps the part of A along m; only needed if
//                                 the generator itself removes that part
namespace cayspin::inline v0_2 {
namespace isotropy {

/// sigma from A' along the flow: xi = A_o + sigma * m, where sigma = m.A - <A', X> / |X|^2 and
/// X = A x m. The derivative of an affine field is its linear part, applied to X. For LieEuler;
/// ImplicitLieEuler adds sigma * m with the opposite sign of <A', X>. Lewis and Nigam 2002, Sec.
/// 4.1 and 4.2, with the sign and the norm corrected. sigma is zero if X is zero.
struct Analytic {};

/// Like Analytic, but sigma is computed as the geodesic curvature k_g of the orbit times its speed,
/// sigma = k_g * |X| = <m'', m x m'> / |m'|^2 with m' = X, which is a partial connection form. For
/// LieEuler only. Lewis and Nigam 2002, Sec. 3.2.
struct Connection {};

}  // namespace isotropy

namespace detail {

/// Functor that computes X = A x m and m.A of every spin.
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

/// Returns sigma for A_o, from A' at m, X = A x m, and m.A.
template <class Value>
KOKKOS_FORCEINLINE_FUNCTION Value sigma_along_flow(isotropy::Analytic, Vec3<Value> const& rate,
                                                   Vec3<Value> const& x, Vec3<Value> const&,
                                                   Value const& along) {
  // At equilibrium sigma is zero, so that F is zero and m stays bitwise unchanged.
  return guarded_quotient(multiply_subtract(along, dot(x, x), dot(rate, x)), dot(x, x));
}

/// Computes sigma from the second derivative of the orbit, m'' = A' x m + A x X, with
/// A = m x X + (m.A) * m.
template <class Value>
KOKKOS_FORCEINLINE_FUNCTION Value sigma_along_flow(isotropy::Connection, Vec3<Value> const& rate,
                                                   Vec3<Value> const& x, Vec3<Value> const& m,
                                                   Value const& along) {
  Vec3<Value> const a = multiply_add(along, m, cross(m, x));
  Vec3<Value> const second = cross(rate, m) + cross(a, x);
  return guarded_quotient(dot(second, cross(m, x)), dot(x, x));
}

/// Returns the prepared generator whose derivative is taken: one that does not remove the part of A
/// along m, which sigma replaces.
template <class Generator>
auto bare(Generator const& prepared) {
  if constexpr (requires { prepared.bare(); })
    return prepared.bare();
  else
    return prepared;
}
template <class Generator>
Generator bare(Orthogonal<Generator> const& prepared) {
  return prepared.part();
}

/// Returns A' at the spin m, the derivative along `rates`, a stencil of the rates X. For
/// LandauLifshitz the term damping * (X x H) is left out: it is normal to X and does not contribute
/// to sigma.
template <class Generator, class Value, class Stencil>
KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> rate_of(Generator const& generator, Vec3<Value> const& m,
                                                Stencil const& rates) {
  using Site = std::remove_cvref_t<decltype(rates.site())>;
  if constexpr (is_landau_lifshitz<Generator>) {
    return generator.in_field(SpinAlone<Site>(rates.site(), m),
                              FieldRate<Value>{m}(generator.field(), rates));
  } else if constexpr (is_body<Generator>) {
    return generator(rates);  // A is linear
  } else {
    static_assert(
        requires {
          { generator.rate(m, rates) } -> std::convertible_to<Vec3<Value>>;
        },
        "isotropy::Analytic and Connection need the generator's derivative: a const, "
        "device-callable template rate(m, rates) that returns A' at the spin m along the rates "
        "A x m around it.");
    return generator.rate(m, rates);
  }
}

/// The rates X of the spins and m.A, from which sigma is computed.
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
  bool streaming_ = false;  // stores of rates bypass the caches
};

/// Functor that takes a step of geometric Euler, in place: m <- cay(dt * (A_o + sigma * m)) m.
template <class Isotropy, class Rotation, class Generator, class Real>
struct CorrectedEulerStage {
  Generator generator;  // prepared for the rates
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

/// Functor that computes sigma of an implicit step: <A', X> / |X|^2, minus m.A if the generator
/// removes the part of A along m.
template <class Generator, class Real>
struct ImplicitSigmaStage {
  Generator generator;  // prepared for the rates
  SiteArray<Real, 3> rates, spins;
  OutputArray<Real, 1> sigma;  // holds m.A on input
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

/// isotropy::Analytic for an implicit step: sigma = +<A', X> / |X|^2 at m0, with the sign opposite
/// to LieEuler's; energy error of order 2. Lewis and Nigam 2002, Sec. 4.2.
template <class Spins>
class ImplicitSigma<Spins, isotropy::Analytic> {
  using Real = typename Spins::value_type;

 public:
  static constexpr bool is_there = true;
  static constexpr int evaluations = 2, ghosts = 2, work_fields = 2;

  ImplicitSigma(std::string const& name, Lattice const& lattice)
      : rates_(name, lattice), rates_label_(name + "::rates"), sigma_label_(name + "::sigma") {}

  std::size_t bytes() const { return rates_.bytes(); }
  SiteArray<Real, 1> array() const { return rates_.along(); }

  template <class Exec, class Generator>
  void find(Exec const& exec, Generator const& generator, Spins const& spins, double t, double dt) {
    bool orthogonal = false;
    if constexpr (requires { generator.is_orthogonal(); }) orthogonal = generator.is_orthogonal();
    rates_.compute(exec, rates_label_, generator, spins, t);
    auto prepared = bare(prepare_rate(generator, exec, rates_.field(), t, dt));
    for_each_site<Real>(
        exec, sigma_label_, spins.layout(),
        ImplicitSigmaStage<decltype(prepared), Real>{
            std::move(prepared), rates_.array(), spins.array(), rates_.along_output(), orthogonal},
        spins.layout().own);
  }

 private:
  Rates<Spins> rates_;
  std::string rates_label_, sigma_label_;
};

}  // namespace detail

/// Geometric Euler with sigma from the generator's derivative; energy error of order 2. A step
/// evaluates the generator once, and its derivative once.
template <class Spins, class Rotation, class Isotropy>
  requires(std::same_as<Isotropy, isotropy::Analytic> ||
           std::same_as<Isotropy, isotropy::Connection>)
class LieEuler<Spins, Isotropy, Rotation> : public detail::StepperBase<Spins> {
 public:
  using typename detail::StepperBase<Spins>::Real;
  static constexpr int order = 1;
  static constexpr int evaluations = 2;
  static constexpr int ghosts = 2;
  static constexpr int work_fields = 2;  // 4 numbers per site: the rate, and m.A

  explicit LieEuler(Spins const& like, Isotropy isotropy = {}, Rotation = {})
      : LieEuler::StepperBase("LieEuler", like.lattice(), ghosts),
        isotropy_(isotropy),
        rates_("LieEuler", like.lattice()) {}

  std::size_t work_bytes() const { return rates_.bytes(); }

  /// Advances `spins` from t to t + dt under `generator`, whose derivative must be available
  /// (see the top of this file). Throws std::invalid_argument when `spins` is not on the lattice
  /// given at construction, or the field has biquadratic couplings.
  template <class Exec, class Generator>
  void step(Exec const& exec, Generator const& generator, Spins& spins, double t, double dt) {
    auto const region = this->begin_step(exec, spins);
    rates_.compute(exec, rates_label_, generator, spins, t);
    auto prepared = detail::bare(detail::prepare_rate(generator, exec, rates_.field(), t, dt));
    using Kernel = detail::CorrectedEulerStage<Isotropy, Rotation, decltype(prepared), Real>;
    Kernel const kernel{std::move(prepared), isotropy_,           rates_.array(),
                        rates_.along(),      spins.output(false), static_cast<Real>(dt)};
    detail::for_each_site<Real>(exec, rotate_label_, spins.layout(), kernel, spins.layout().own);
    detail::update_ghosts(exec, this->lattice_, spins);
  }

 private:
  std::string rates_label_ = this->label("::rates"), rotate_label_ = this->label("::rotate");
  Isotropy isotropy_;
  detail::Rates<Spins> rates_;
};

}  // namespace cayspin::inline v0_2
