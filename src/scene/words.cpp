// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include <cayspin/io/words.hpp>

#include <array>

namespace cayspin::inline v0_1::io {
namespace {

constexpr auto system_kinds = std::to_array<Word<SystemKind>>({
    {"llg", SystemKind::llg},
    {"rigid_body", SystemKind::rigid_body},
});

constexpr auto boundary_kinds = std::to_array<Word<BoundaryKind>>({
    {"open", BoundaryKind::open},
    {"periodic", BoundaryKind::periodic},
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

}  // namespace cayspin::inline v0_1::io
