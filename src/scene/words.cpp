// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include <cayspin/io/words.hpp>

#include <array>

namespace cayspin::io {
namespace {

constexpr auto system_kinds = std::to_array<Word<SystemKind>>({
    {"llg", SystemKind::llg},
    {"rigid_body", SystemKind::rigid_body},
});

constexpr auto boundary_kinds = std::to_array<Word<BoundaryKind>>({
    {"open", BoundaryKind::open},
    {"periodic", BoundaryKind::periodic},
});

constexpr auto methods = std::to_array<Word<Method>>({
    {"euler", Method::euler},
    {"implicit_euler", Method::implicit_euler},
    {"heun", Method::heun},
    {"rkmk4", Method::rkmk4},
    {"rkmk4_as_printed", Method::rkmk4_as_printed},
    {"rkmk5", Method::rkmk5},
    {"rkmk8", Method::rkmk8},
    {"series4", Method::series4},
    {"series4_paper", Method::series4_paper},
    {"ab2", Method::ab2},
    {"implicit_midpoint", Method::implicit_midpoint},
    {"cf4", Method::cf4},
    {"fx3", Method::fx3},
    {"fx4", Method::fx4},
    {"red_black2", Method::red_black2},
    {"red_black4", Method::red_black4},
    {"tsit5", Method::tsit5},
    {"dp5", Method::dp5},
    {"bs3", Method::bs3},
    {"classical_euler", Method::classical_euler},
    {"classical_heun", Method::classical_heun},
    {"classical_rk4", Method::classical_rk4},
    {"projected_euler", Method::projected_euler},
    {"projected_heun", Method::projected_heun},
    {"projected_rk4", Method::projected_rk4},
    {"projected_rk5", Method::projected_rk5},
    {"projected_rk8", Method::projected_rk8},
    {"projected_dp5", Method::projected_dp5},
    {"auto", Method::automatic},
});

constexpr auto generators = std::to_array<Word<Generator>>({
    {"default", Generator::standard},
    {"orthogonal", Generator::orthogonal},
    {"tangent", Generator::tangent},
});

constexpr auto isotropies = std::to_array<Word<Isotropy>>({
    {"zero", Isotropy::zero},
    {"constant", Isotropy::constant},
    {"analytic", Isotropy::analytic},
    {"finite_difference", Isotropy::finite_difference},
    {"finite_difference_backward", Isotropy::finite_difference_backward},
    {"energy", Isotropy::energy},
});

constexpr auto rotations = std::to_array<Word<Rotation>>({
    {"cayley", Rotation::cayley},
    {"exponential", Rotation::exponential},
});

}  // namespace

template <>
std::span<Word<SystemKind> const> words() {
  return system_kinds;
}
template <>
std::span<Word<BoundaryKind> const> words() {
  return boundary_kinds;
}
template <>
std::span<Word<Method> const> words() {
  return methods;
}
template <>
std::span<Word<Generator> const> words() {
  return generators;
}
template <>
std::span<Word<Isotropy> const> words() {
  return isotropies;
}
template <>
std::span<Word<Rotation> const> words() {
  return rotations;
}

namespace {

bool is_of_high_order(Method method) { return method == Method::rkmk5 || method == Method::rkmk8; }

}  // namespace

bool is_classical(Method method) {
  return method == Method::classical_euler || method == Method::classical_heun ||
         method == Method::classical_rk4;
}

bool is_baseline(Method method) {
  return is_classical(method) || method == Method::projected_euler ||
         method == Method::projected_heun || method == Method::projected_rk4 ||
         method == Method::projected_rk5 || method == Method::projected_rk8 ||
         method == Method::projected_dp5;
}

bool is_adaptive(Method method) {
  return method == Method::tsit5 || method == Method::dp5 || method == Method::bs3 ||
         method == Method::projected_dp5;
}

bool is_series(Method method) {
  return method == Method::series4 || method == Method::series4_paper;
}

bool needs_cayley(Method method) {
  return method == Method::rkmk4_as_printed || is_of_high_order(method) ||
         method == Method::implicit_midpoint || is_series(method) || is_red_black(method) ||
         method == Method::fx3 || method == Method::fx4;
}

bool is_red_black(Method method) {
  return method == Method::red_black2 || method == Method::red_black4;
}

bool needs_exponential(Method method) { return method == Method::cf4; }

namespace {

bool is_of_the_paper(Method method) {  // its explicit methods
  return method == Method::euler || method == Method::heun || method == Method::rkmk4;
}

}  // namespace

bool takes_tangent(Method method) {
  return is_of_the_paper(method) || is_of_high_order(method) ||
         (is_adaptive(method) && !is_baseline(method));
}

bool takes_compensation(Method method) {
  return method == Method::rkmk4 || method == Method::rkmk5 || method == Method::projected_rk4 ||
         method == Method::projected_rk5;
}

bool takes_isotropy(Method method, Isotropy isotropy, SystemKind kind) {
  switch (isotropy) {
    case Isotropy::zero:
      return !is_baseline(method);
    case Isotropy::constant:
      return takes_tangent(method) || method == Method::rkmk4_as_printed || method == Method::ab2 ||
             method == Method::implicit_euler || method == Method::cf4;
    case Isotropy::analytic:
      return method == Method::euler || method == Method::implicit_euler;
    case Isotropy::finite_difference:
    case Isotropy::finite_difference_backward:
      return method == Method::euler;
    case Isotropy::energy:
      return kind == SystemKind::llg
                 ? is_of_the_paper(method)
                 : is_series(method) || method == Method::heun || method == Method::rkmk4;
  }
  return false;
}

}  // namespace cayspin::io
