// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

// Compiles steppers without the Kokkos library, which may contain instructions unknown to valgrind,
// and for processors with AVX2, whatever the machine has.
#include <Kokkos_Macros.hpp>

#undef KOKKOS_ARCH_AVX512XEON
#undef KOKKOS_ARCH_AVX512MIC
#undef KOKKOS_ARCH_AVX2
#define KOKKOS_ARCH_AVX2

#include <cayspin/detail/execution.hpp>

#include <valgrind/callgrind.h>

#include <cmath>
#include <vector>

namespace cayspin::instructions {

struct Memory;

/// Space that runs kernels immediately; callgrind counts their instructions.
struct Here {
  using execution_space = Here;
  using memory_space = Kokkos::HostSpace;
  using size_type = memory_space::size_type;
  void fence(std::string const&) const {}
  int concurrency() const { return 1; }
};

struct Memory {
  using memory_space = Memory;
  using execution_space = Here;
  using size_type = Kokkos::HostSpace::size_type;
};

}  // namespace cayspin::instructions

template <>
struct Kokkos::SpaceAccessibility<cayspin::instructions::Here, cayspin::instructions::Memory> {
  static constexpr bool accessible = true;
};

/// Minimal replacement for a View.
template <class Real>
class Kokkos::View<Real*, cayspin::instructions::Memory> {
 public:
  View() = default;
  template <class Allocation>
  View(Allocation const&, std::size_t size) : numbers_(size + line) {}
  std::size_t size() const { return numbers_.empty() ? 0 : numbers_.size() - line; }
  Real* data() const {
    auto const address = reinterpret_cast<std::uintptr_t>(numbers_.data());
    return reinterpret_cast<Real*>((address + 63) / 64 * 64);
  }

 private:
  static constexpr std::size_t line = 64 / sizeof(Real);
  std::vector<Real> numbers_;
};

namespace cayspin::inline v0_2::detail {

// Replaces the function that launches kernels, in all headers that are included below.
template <class Body>
void for_each_task(instructions::Here const&, std::string const&, std::int64_t count, std::int64_t,
                   Body const& body) {
  CALLGRIND_TOGGLE_COLLECT;
  for (std::int64_t task = 0; task < count; ++task) body(task);
  CALLGRIND_TOGGLE_COLLECT;
}

}  // namespace cayspin::inline v0_2::detail

// Profiling regions are the only functions of Kokkos' library that a step calls.
void Kokkos::Tools::pushRegion(std::string const&) {}
void Kokkos::Tools::popRegion() {}

#include <cayspin/lattice.hpp>
#include <cayspin/row_layout.hpp>

namespace cayspin::instructions {

template <class Real>
class Spins {
 public:
  using value_type = Real;
  static constexpr int components = 3;
  using memory_space = Memory;

  Spins() = default;
  Spins(std::string const& label, Lattice const& lattice)
      : lattice_(lattice),
        layout_(RowLayout::of<Real>(lattice)),
        numbers_(label, layout_.allocation(3)) {
    for (std::int64_t site = 0; site < layout_.sites(); ++site) {
      Real* const m = array().data + layout_.offset(site);
      double const angle = 0.7 * (site % 19), z = 0.1 * (site % 17) - 0.8;
      m[0] = static_cast<Real>(std::sqrt(1 - z * z) * std::cos(angle));
      m[layout_.component_stride] = static_cast<Real>(std::sqrt(1 - z * z) * std::sin(angle));
      m[2 * layout_.component_stride] = static_cast<Real>(z);
    }
  }

  Lattice const& lattice() const { return lattice_; }
  RowLayout const& layout() const { return layout_; }
  std::int64_t sites() const { return layout_.sites(); }
  std::size_t bytes() const { return numbers_.size() * sizeof(Real); }
  SiteArray<Real, 3> array() const {
    return {numbers_.data() + layout_.origin, layout_.component_stride};
  }
  OutputArray<Real, 3> output(bool streaming) const { return {array(), streaming}; }

  friend void swap(Spins& a, Spins& b) noexcept { std::swap(a.numbers_, b.numbers_); }

 private:
  Lattice lattice_;
  RowLayout layout_;
  Kokkos::View<Real*, Memory> numbers_;
};

}  // namespace cayspin::instructions
