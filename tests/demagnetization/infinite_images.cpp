// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The demagnetising field of lattices that are infinite along one or two axes, against closed forms
// and against the field of a lattice of several periods.
#include "../support/wrong_call.hpp"
#include "films.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <string>

namespace cayspin::test {
namespace {

constexpr int all = infinitely_many_images;

template <class Real>
class InfiniteImages : public ::testing::Test {};
using Precisions = ::testing::Types<float, double>;
TYPED_TEST_SUITE(InfiniteImages, Precisions);

/// Bound on the error: that of the sums over images plus that of the transforms.
template <class Real>
constexpr double limit = 1e-10 + 80 * std::numeric_limits<Real>::epsilon();

std::vector<double> uniform(Lattice const& lattice, std::array<double, 3> const& m) {
  std::vector<double> directions;
  for (std::int64_t site = 0; site < lattice.sites(); ++site)
    directions.insert(directions.end(), m.begin(), m.end());
  return directions;
}

template <class Field>
void expect_uniform(Field const& field, std::array<double, 3> const& h, double error,
                    std::string const& name) {
  for (std::int64_t site = 0; site < field.sites(); ++site) {
    auto const found = field.get(site);
    ASSERT_NEAR(found.x, h[0], error) << name << ", site " << site;
    ASSERT_NEAR(found.y, h[1], error) << name << ", site " << site;
    ASSERT_NEAR(found.z, h[2], error) << name << ", site " << site;
  }
}

// A film has N = 1 along its normal and 0 in its plane, for any normal.
TYPED_TEST(InfiniteImages, OfAFilmHaveATraceAlongItsNormal) {
  using Real = TypeParam;
  for (auto const& film : {Film{{20, 20, 1}, {all, all, 0}, {1, 1, 1}},
                           {{32, 5, 3}, {all, all, 0}, {2, 1.5, 0.1}},
                           {{1, 3, 14}, {0, all, all}, {40, 1, 1.2}},
                           {{1, 1, 2}, {0, all, all}, {1, 1, 1}},
                           {{30, 2, 1}, {all, 0, all}, {1, 0.5, 20}}}) {
    auto const lattice = film.lattice();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::array<double, 3> m{0, 0, 0}, h{0, 0, 0};
      m[axis] = 1;
      h[axis] = film.images[axis] == all ? 0 : -1;
      auto const field = field_on_host<Real>(lattice, uniform(lattice, m), {1, film.images});
      expect_uniform(field, h, limit<Real>, std::to_string(film.shape[0]));
    }
  }
}

/// Returns N along the edge a of an infinite bar with the edges a and b: Aharoni, J. Appl. Phys.
/// 83, 3432 (1998), eq. 1 with the third edge infinite.
double of_bar(double a, double b) {
  double const p = a / b;
  return ((1 - p * p) / (2 * p) * std::log1p(p * p) + p * std::log(p) + 2 * std::atan(1 / p)) /
         std::numbers::pi;
}

TYPED_TEST(InfiniteImages, OfABarHaveItsMean) {
  using Real = TypeParam;
  for (auto const& bar : {Film{{16, 3, 4}, {all, 0, 0}, {1, 1, 0.5}},
                          {{4, 30, 3}, {0, all, 0}, {0.3, 2, 1}},
                          {{5, 5, 1}, {0, 0, all}, {1, 1, 7}}}) {
    auto const lattice = bar.lattice();
    auto const axis =
        static_cast<std::size_t>(std::ranges::find(bar.images, all) - bar.images.begin());
    for (std::size_t along = 0; along < 3; ++along) {
      std::array<double, 3> m{0, 0, 0};
      m[along] = 1;
      auto const field = field_on_host<Real>(lattice, uniform(lattice, m), {1, bar.images});
      double mean = 0;
      for (std::int64_t site = 0; site < lattice.sites(); ++site) {
        auto const h = field.get(site);
        mean -= (h.x * m[0] + h.y * m[1] + h.z * m[2]) / static_cast<double>(lattice.sites());
      }
      auto const edge = [&](std::size_t i) {
        return static_cast<double>(bar.shape[i]) * bar.spacing[i];
      };
      double const expected = along == axis ? 0 : of_bar(edge(along), edge(3 - along - axis));
      EXPECT_NEAR(mean, expected, limit<Real>) << axis << along;
    }
  }
}

// Stripes of width a, alternately up and down, in a film of thickness d: N along the normal is the
// sum over odd n of 8 / (n * pi)^2 * (1 - exp(-k * d)) / (k * d), with k = n * pi / a.
TYPED_TEST(InfiniteImages, OfStripesAreTheirFourierSeries) {
  using Real = TypeParam;
  for (double const thickness : {0.1, 1.0, 5.0}) {
    constexpr double width = 1.5;
    double expected = 0;
    for (double n = 400001; n > 0; n -= 2) {
      double const kd = n * std::numbers::pi * thickness / width;
      expected += 8 / (n * n * std::numbers::pi * std::numbers::pi) * -std::expm1(-kd) / kd;
    }
    Film const film{{2, 3, 1}, {all, all, 0}, {width, 1, thickness}};
    auto const lattice = film.lattice();
    auto directions = uniform(lattice, {0, 0, 1});
    for (std::size_t site = 1; site < 6; site += 2) directions[3 * site + 2] = -1;
    auto const field = field_on_host<Real>(lattice, directions, {1, film.images});
    for (std::int64_t site = 0; site < 6; ++site)
      EXPECT_NEAR(field.get(site).z, (site % 2 == 0 ? -1 : 1) * expected, limit<Real>);
  }
}

// A lattice of several periods, with repeated spins, has the field of one period.
TYPED_TEST(InfiniteImages, AreThoseOfSeveralPeriods) {
  using Real = TypeParam;
  struct Case {
    Film film;
    std::array<std::int64_t, 3> periods;
  };
  for (auto const& [film, periods] : {Case{{{5, 4, 2}, {all, all, 0}, {1, 1.3, 0.4}}, {6, 2, 1}},
                                      {{{3, 24, 1}, {all, all, 0}, {1, 1, 1}}, {12, 1, 1}},
                                      {{{2, 3, 7}, {0, 0, all}, {1, 2, 0.5}}, {1, 1, 4}},
                                      {{{4, 3, 2}, {0, 2, all}, {1, 1, 3}}, {1, 1, 11}}}) {
    auto const lattice = film.lattice();
    auto repeated = film;
    for (std::size_t axis = 0; axis < 3; ++axis) repeated.shape[axis] *= periods[axis];
    auto const directions = random_directions(lattice.sites(), 3);
    std::vector<double> all_directions;
    std::vector<std::int64_t> origin;
    auto const [nx, ny, nz] = film.shape;
    for (std::int64_t k = 0; k < repeated.shape[2]; ++k)
      for (std::int64_t j = 0; j < repeated.shape[1]; ++j)
        for (std::int64_t i = 0; i < repeated.shape[0]; ++i) {
          origin.push_back((k % nz * ny + j % ny) * nx + i % nx);
          auto const* const m = &directions[static_cast<std::size_t>(3 * origin.back())];
          all_directions.insert(all_directions.end(), m, m + 3);
        }
    auto const field = field_on_host<Real>(lattice, directions, {1, film.images});
    auto const again = field_on_host<Real>(repeated.lattice(), all_directions, {1, film.images});
    for (std::int64_t site = 0; site < again.sites(); ++site) {
      auto const one = field.get(origin[static_cast<std::size_t>(site)]), other = again.get(site);
      ASSERT_NEAR(one.x, other.x, limit<Real>) << site;
      ASSERT_NEAR(one.y, other.y, limit<Real>) << site;
      ASSERT_NEAR(one.z, other.z, limit<Real>) << site;
    }
  }
}

TEST(InfiniteImagesOf, WhatTheyCannotTakeIsRefused) {
  using Field = DemagnetizingField<double>;
  auto const cube = Lattice::cubic(4, 4, 4);
  Lattice const flat{.shape = {4, 4, 1}, .spacing = {1, 1, 1e-10}};
  expect_refused({
      {"three axes",
       [&] {
         Field(cube, {1, {all, all, all}});
       }},
      {"another tensor",
       [&] {
         Field(cube,
               {1, {all, 0, 0}, [](auto const&, auto const&) { return DemagnetizingTensor{}; }});
       }},
      {"very different periods",
       [&] {
         Field(Lattice::square(1, 20000), {1, {all, all, 0}});
       }},
      {"edges of 1e10 : 1", [&] { Field{flat}; }},
  });
}

}  // namespace
}  // namespace cayspin::test
