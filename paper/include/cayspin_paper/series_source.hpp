// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/unrolled.hpp>
#include <cayspin/generator/landau_lifshitz.hpp>
#include <cayspin/generator/orthogonal.hpp>
#include <cayspin/generator/rigid_body.hpp>
#include <cayspin/optional_members.hpp>
#include <cayspin/stencil.hpp>

#include <cayspin_paper/field_rate.hpp>

#include <cstddef>
#include <type_traits>

// Derivatives of the library's generators for the series. A user's generator needs
//   Vec3<Value> series_source(stencil)           the source of A: H, or A itself
//   Vec3<Value> linear_series_source(stencil)    the linear part of the source; requires
//                                                is_affine() on the host
//   Vec3<Value> derivative<K>(m, source)         the K-th time derivative of A, from the
//                                                derivatives of m and of the source
//   static bool is_local                         A is linear in the site's spin, and does not
//                                                depend on neighbours
namespace cayspin::inline v0_2::detail {

template <int N, int K>
inline constexpr int binomial = K == 0 ? 1 : binomial<N - 1, K - 1> * N / K;
template <int N>
inline constexpr int binomial<N, 0> = 1;

/// Applies Leibniz' rule: calls term(binomial(K, j), j, K - j) for j = 0 .. K, all compile-time
/// constants.
template <int K, class Term>
KOKKOS_FORCEINLINE_FUNCTION void leibniz(Term const& term) {
  unrolled<K + 1>([&](auto j) {
    term(std::integral_constant<int, binomial<K, j()>>{}, j,
         std::integral_constant<int, K - j()>{});
  });
}

template <int K, class Generator, class Value>
KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> orthogonal_derivative(Generator const& generator,
                                                              Vec3<Value> const* m,
                                                              Vec3<Value> const* source);

/// The source that Series4 differentiates, and the derivatives of A that follow from it.
template <class Generator>
struct SeriesOf {
  static constexpr bool is_local = detail::is_local<Generator> || is_body<Generator>;

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION static VectorOf<Stencil> source(Generator const& generator,
                                                              Stencil const& stencil) {
    if constexpr (is_body<Generator>)
      return generator(stencil);
    else
      return generator.series_source(stencil);
  }
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION static VectorOf<Stencil> linear_source(Generator const& generator,
                                                                     Stencil const& stencil) {
    return generator.linear_series_source(stencil);
  }
  template <int K, class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> derivative(Generator const& generator,
                                                            Vec3<Value> const* m,
                                                            Vec3<Value> const* source) {
    if constexpr (is_body<Generator>)
      return source[K];
    else
      return generator.template derivative<K>(m, source);
  }
};

template <class Field, class Damping>
struct SeriesOf<LandauLifshitz<Field, Damping>> {
  using Generator = LandauLifshitz<Field, Damping>;
  static constexpr bool is_local = false;  // A is not linear in the spin

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION static VectorOf<Stencil> source(Generator const& generator,
                                                              Stencil const& stencil) {
    return generator.field().field(stencil);
  }
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION static VectorOf<Stencil> linear_source(Generator const& generator,
                                                                     Stencil const& stencil) {
    return LinearField()(generator.field(), stencil);
  }
  template <int K, class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> derivative(Generator const& generator,
                                                            Vec3<Value> const* m,
                                                            Vec3<Value> const* h) {
    static_assert(std::is_same_v<Damping, double>,
                  "Series4 needs a damping that is one number for all sites.");
    Vec3<Value> a = as_value<Value>(generator.has_precession() ? 1 : 0) * h[K];
    double const damping = generator.template damping<double>(0);
    leibniz<K>([&](auto weight, auto j, auto rest) {
      a = multiply_add(as_value<Value>(damping * weight), cross(m[j], h[rest]), a);
    });
    return a;
  }
};

template <class Inner>
struct SeriesOf<Orthogonal<Inner>> {
  using Generator = Orthogonal<Inner>;
  static constexpr bool is_local = SeriesOf<Inner>::is_local;

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION static VectorOf<Stencil> source(Generator const& generator,
                                                              Stencil const& stencil) {
    return SeriesOf<Inner>::source(generator.part(), stencil);
  }
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION static VectorOf<Stencil> linear_source(Generator const& generator,
                                                                     Stencil const& stencil) {
    return SeriesOf<Inner>::linear_source(generator.part(), stencil);
  }
  template <int K, class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> derivative(Generator const& generator,
                                                            Vec3<Value> const* m,
                                                            Vec3<Value> const* source) {
    return orthogonal_derivative<K>(generator.part(), m, source);
  }
};

template <int K, class Generator, class Value>
KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> series_derivative(Generator const& generator,
                                                          Vec3<Value> const* m,
                                                          Vec3<Value> const* source) {
  return SeriesOf<Generator>::template derivative<K>(generator, m, source);
}

/// Returns d^K/dt^K of A - (m.A) * m.
template <int K, class Generator, class Value>
KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> orthogonal_derivative(Generator const& generator,
                                                              Vec3<Value> const* m,
                                                              Vec3<Value> const* source) {
  constexpr std::size_t count = K + 1;
  Vec3<Value> a[count];
  Value along[count];
  unrolled<K + 1>([&](auto order) {
    a[order] = series_derivative<order()>(generator, m, source);
    along[order] = Value(0);
    leibniz<order()>([&](auto weight, auto j, auto rest) {
      along[order] = multiply_add(Value(weight()), dot(m[j], a[rest]), along[order]);
    });
  });
  Vec3<Value> result = a[K];
  leibniz<K>([&](auto weight, auto j, auto rest) {
    result = multiply_add(Value(Value(-weight()) * along[j]), m[rest], result);
  });
  return result;
}

}  // namespace cayspin::inline v0_2::detail
