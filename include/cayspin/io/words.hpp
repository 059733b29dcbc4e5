// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <algorithm>
#include <span>
#include <string_view>

/// The words a scene may use, each kind in one table: the scene reader, `cayspin methods` and the
/// error messages all read these tables, and a new method enters here.
namespace cayspin::io {

enum class SystemKind { llg, rigid_body };
enum class BoundaryKind { open, periodic };

enum class Method {
  euler,
  implicit_euler,
  heun,
  rkmk4,
  rkmk4_as_printed,
  rkmk5,
  rkmk8,
  series4,
  series4_paper,
  ab2,
  implicit_midpoint,
  cf4,
  fx3,
  fx4,
  red_black2,
  red_black4,
  tsit5,
  dp5,
  bs3,
  classical_euler,
  classical_heun,
  classical_rk4,
  projected_euler,
  projected_heun,
  projected_rk4,
  projected_rk5,
  projected_rk8,
  projected_dp5,
  automatic  ///< the word "auto": chosen by a run's error
};

/// `standard` is the scene's word "default": the system's own A, unchanged.
enum class Generator { standard, orthogonal, tangent };
enum class Isotropy {
  zero,
  constant,
  analytic,
  finite_difference,
  finite_difference_backward,
  energy
};
enum class Rotation { cayley, exponential };

/// One word of a scene.
template <class Value>
struct Word {
  std::string_view name;
  Value value;
};

/// All words of a kind, in the order of the documentation. Specialised for every enum above.
template <class Value>
std::span<Word<Value> const> words();

template <>
std::span<Word<SystemKind> const> words();
template <>
std::span<Word<BoundaryKind> const> words();
template <>
std::span<Word<Method> const> words();
template <>
std::span<Word<Generator> const> words();
template <>
std::span<Word<Isotropy> const> words();
template <>
std::span<Word<Rotation> const> words();

/// The scene's spelling of a value.
template <class Value>
std::string_view to_string(Value value) {
  auto const table = words<Value>();
  return std::ranges::find(table, value, &Word<Value>::value)->name;
}

/// The table entry spelled `name`, or nullptr.
template <class Value>
Word<Value> const* find_word(std::string_view name) {
  auto const table = words<Value>();
  auto const found = std::ranges::find(table, name, &Word<Value>::name);
  return found == table.end() ? nullptr : &*found;
}

/// True for the methods outside the Lie group (classical_*, projected_*), which take neither
/// generator, isotropy nor rotation.
bool is_baseline(Method method);

/// True for classical_*, which let |m| drift.
bool is_classical(Method method);

/// True for series4 and series4_paper.
bool is_series(Method method);

/// True for the embedded methods, which choose their steps by a tolerance.
bool is_adaptive(Method method);

/// True for the methods that are formulated in Cayley coordinates only.
bool needs_cayley(Method method);

/// True for red_black2 and red_black4, which need a lattice of two colours.
bool is_red_black(Method method);

/// True for the methods that are made of exact exponentials.
bool needs_exponential(Method method);

/// True for the methods that run in the stereographic chart too.
bool takes_tangent(Method method);

/// True for the methods that come with compensated sums too.
bool takes_compensation(Method method);

/// Is there such a sigma for the method on such a system?
bool takes_isotropy(Method method, Isotropy isotropy, SystemKind kind);

}  // namespace cayspin::io
