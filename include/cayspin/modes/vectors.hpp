// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/for_each_site.hpp>
#include <cayspin/detail/reduce_sites.hpp>
#include <cayspin/detail/table.hpp>
#include <cayspin/detail/unrolled.hpp>
#include <cayspin/spin_field.hpp>
#include <cayspin/vec3.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

// Algebra of many fields of tangent vectors at once.
namespace cayspin::inline v0_2::detail {

/// Largest number of fields that one kernel combines.
inline constexpr std::size_t most_vectors = 320;

template <class Spins>
using VectorTable =
    Kokkos::View<SiteArray<typename Spins::value_type, 3>*, typename Spins::memory_space>;

template <class Spins>
VectorTable<Spins> table_of_vectors(std::span<Spins const> vectors) {
  std::vector<SiteArray<typename Spins::value_type, 3>> arrays;
  for (auto const& vector : vectors) arrays.push_back(vector.array());
  return table_of<typename Spins::memory_space>("cayspin::modes::vectors", arrays);
}

/// Returns the elements of a matrix, row by row.
template <class Real, class Memory>
Kokkos::View<Real*, Memory> table_of_numbers(Eigen::MatrixXd const& matrix) {
  std::vector<Real> numbers;
  for (Eigen::Index i = 0; i < matrix.rows(); ++i)
    for (Eigen::Index j = 0; j < matrix.cols(); ++j)
      numbers.push_back(static_cast<Real>(matrix(i, j)));
  return table_of<Memory>("cayspin::modes::numbers", numbers);
}

inline constexpr int tile = 4;

/// Functor that computes x_i.y_j for all pairs of a tile.
template <class Real>
struct ProductsOfTile {
  Kokkos::Array<SiteArray<Real, 3>, tile> x, y;

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Value* values) const {
    Vec3<Value> left[tile];
    unrolled<tile>([&](auto i) { left[i()] = site.load(x[i()]); });
    unrolled<tile>([&](auto j) {
      Vec3<Value> const right = site.load(y[j()]);
      unrolled<tile>([&](auto i) { values[tile * i() + j()] = dot(left[i()], right); });
    });
  }
};

/// Returns the inner products x_i.y_j; waits.
template <class Exec, class Spins>
Eigen::MatrixXd inner_products(Exec const& exec, std::span<Spins const> x,
                               std::span<Spins const> y) {
  using Real = typename Spins::value_type;
  static std::string const label = "cayspin::modes::inner_products";
  Eigen::MatrixXd products(x.size(), y.size());
  constexpr std::size_t step = tile;
  for (std::size_t i = 0; i < x.size(); i += step)
    for (std::size_t j = 0; j < y.size(); j += step) {
      ProductsOfTile<Real> kernel;
      for (std::size_t k = 0; k < step; ++k) {
        kernel.x[k] = x[std::min(i + k, x.size() - 1)].array();
        kernel.y[k] = y[std::min(j + k, y.size() - 1)].array();
      }
      auto const found = reduce_sites<Sum, tile * tile>(exec, label, x.front().layout(), kernel);
      for (std::size_t k = i; k < std::min(i + step, x.size()); ++k)
        for (std::size_t l = j; l < std::min(j + step, y.size()); ++l)
          products(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(l)) =
              found[step * (k - i) + (l - j)];
    }
  return products;
}

/// Functor that computes to_j = sum over i of c_ij * from_i; `to` may alias `from`. Rows of the
/// coefficients c are padded to whole tiles.
template <class Real, class Table, class Numbers>
struct CombineVectors {
  Table from, to;
  Numbers coefficients;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    using Value = typename Site::value_type;
    Value loaded[most_vectors];
    auto const inputs = static_cast<int>(from.extent(0)), outputs = static_cast<int>(to.extent(0));
    int const columns = (outputs + tile - 1) / tile * tile;
    for (int component = 0; component < 3; ++component) {
      for (int i = 0; i < inputs; ++i) loaded[i] = site.load(from(i), component);
      for (int first = 0; first < outputs; first += tile) {
        Value sums[tile];
        unrolled<tile>([&](auto j) { sums[j()] = Value(Real(0)); });
        for (int i = 0; i < inputs; ++i)
          unrolled<tile>([&](auto j) {
            Value const c(coefficients(i * columns + first + j()));
            sums[j()] = multiply_add(c, loaded[i], sums[j()]);
          });
        for (int j = 0; j < tile && first + j < outputs; ++j) {
          auto const& array = to(first + j);
          store(sums[j], array.data + component * array.stride + site.offset());
        }
      }
    }
  }
};

template <class Exec, class Spins>
void combine_vectors(Exec const& exec, std::span<Spins const> from,
                     Eigen::MatrixXd const& coefficients, std::span<Spins const> to) {
  using Real = typename Spins::value_type;
  using Memory = typename Spins::memory_space;
  if (to.empty()) return;
  static std::string const label = "cayspin::modes::combine_vectors";
  Eigen::MatrixXd filled =
      Eigen::MatrixXd::Zero(coefficients.rows(), (coefficients.cols() + tile - 1) / tile * tile);
  filled.leftCols(coefficients.cols()) = coefficients;
  auto const numbers = table_of_numbers<Real, Memory>(filled);
  for_each_site<Real>(exec, label, to.front().layout(),
                      CombineVectors<Real, VectorTable<Spins>, Kokkos::View<Real*, Memory>>{
                          table_of_vectors(from), table_of_vectors(to), numbers});
  exec.fence(label);  // the tables are destroyed at the end
}

/// Functor that computes G^-1 v = -p * m x v - q * v, the inverse of the operator G v = a * m x v -
/// b * v by which spins turn.
template <class Real>
struct InverseTurning {
  SiteArray<Real, 1> sideways, along;  // p = a / (a^2 + b^2) and q = b / (a^2 + b^2)

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> operator()(Site const& site, Vec3<Value> const& m,
                                                     Vec3<Value> const& v) const {
    Vec3<Value> const turned = Value(-site.load(sideways)) * cross(m, v);
    return multiply_add(Value(-site.load(along)), v, turned);
  }
};

/// Functor that computes G^-1 v as two vectors, from the skew and the symmetric part of G^-1.
template <class Real>
struct TurnBack {
  InverseTurning<Real> inverse;
  SiteArray<Real, 3> spins, vectors;
  OutputArray<Real, 3> skew, symmetric;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    using Value = typename Site::value_type;
    Vec3<Value> const m = site.load(spins), v = site.load(vectors);
    site.store(Vec3<Value>(Value(-site.load(inverse.sideways)) * cross(m, v)), skew);
    site.store(Vec3<Value>(Value(-site.load(inverse.along)) * v), symmetric);
  }
};

/// Functor that computes the residuals B x - rate * G^-1 x of modes
/// x = sum over i of c_i * vectors_i. Each mode has two columns of coefficients c: for its real and
/// its imaginary part.
template <class Real, class Table, class Numbers>
struct ResidualsOfModes {
  static constexpr int most = 4;

  Table vectors, products, to;
  Numbers coefficients;
  InverseTurning<Real> inverse;
  SiteArray<Real, 3> spins;
  Kokkos::Array<Kokkos::complex<double>, most> rates;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    using Value = typename Site::value_type;
    Vec3<Value> x[2 * most], bx[2 * most];
    auto const columns = static_cast<int>(to.extent(0));
    for (int k = 0; k < columns; ++k) x[k] = bx[k] = zero<Value>();
    for (int i = 0; i < static_cast<int>(vectors.extent(0)); ++i) {
      Vec3<Value> const v = site.load(vectors(i)), bv = site.load(products(i));
      for (int k = 0; k < columns; ++k) {
        Value const c(coefficients(i * columns + k));
        x[k] = multiply_add(c, v, x[k]);
        bx[k] = multiply_add(c, bv, bx[k]);
      }
    }
    Vec3<Value> const m = site.load(spins);
    for (int mode = 0; mode < columns / 2; ++mode) {
      Vec3<Value> const real = inverse(site, m, x[2 * mode]);
      Vec3<Value> const imaginary = inverse(site, m, x[2 * mode + 1]);
      Value const a(static_cast<Real>(rates[mode].real())),
          b(static_cast<Real>(rates[mode].imag()));
      site.store(bx[2 * mode] - Vec3<Value>(a * real - b * imaginary),
                 OutputArray<Real, 3>{to(2 * mode), false});
      site.store(bx[2 * mode + 1] - Vec3<Value>(b * real + a * imaginary),
                 OutputArray<Real, 3>{to(2 * mode + 1), false});
    }
  }
};

}  // namespace cayspin::inline v0_2::detail
