// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

// Explicit Butcher tableaux, as data: a new Runge-Kutta method is a struct like these.
// a: stages x stages, strictly lower triangular; b: weights; c: stage times in units of dt.
namespace cayspin::tableau {

struct Euler {
  static constexpr int stages = 1, order = 1;
  static constexpr double a[1][1] = {{0}};
  static constexpr double b[1] = {1};
  static constexpr double c[1] = {0};
};

struct Heun {
  static constexpr int stages = 2, order = 2;
  static constexpr double a[2][2] = {{0, 0}, {1, 0}};
  static constexpr double b[2] = {0.5, 0.5};
  static constexpr double c[2] = {0, 1};
};

struct Kutta3 {
  static constexpr int stages = 3, order = 3;
  static constexpr double a[3][3] = {{0, 0, 0}, {0.5, 0, 0}, {-1, 2, 0}};
  static constexpr double b[3] = {1. / 6, 2. / 3, 1. / 6};
  static constexpr double c[3] = {0, 0.5, 1};
};

struct Classical4 {
  static constexpr int stages = 4, order = 4;
  static constexpr double a[4][4] = {{0, 0, 0, 0}, {0.5, 0, 0, 0}, {0, 0.5, 0, 0}, {0, 0, 1, 0}};
  static constexpr double b[4] = {1. / 6, 1. / 3, 1. / 3, 1. / 6};
  static constexpr double c[4] = {0, 0.5, 0.5, 1};
};

/// Kutta's 3/8 rule.
struct ThreeEighths4 {
  static constexpr int stages = 4, order = 4;
  static constexpr double a[4][4] = {
      {0, 0, 0, 0}, {1. / 3, 0, 0, 0}, {-1. / 3, 1, 0, 0}, {1, -1, 1, 0}};
  static constexpr double b[4] = {1. / 8, 3. / 8, 3. / 8, 1. / 8};
  static constexpr double c[4] = {0, 1. / 3, 2. / 3, 1};
};

}  // namespace cayspin::tableau
