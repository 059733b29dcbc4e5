// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/ghosts.hpp>
#include <cayspin/detail/reduce_sites.hpp>
#include <cayspin/spin_field.hpp>
#include <cayspin/stencil.hpp>

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <type_traits>

namespace cayspin {

namespace detail {

/// The mean of one component over each plane normal to an axis, summed in a fixed order. Along x a
/// task is a pack of planes, along y and z one plane.
template <class Value, class Real>
struct AverageLayers {
  Real const* component;
  RowLayout layout;
  int axis;
  double* averages;

  KOKKOS_FUNCTION void operator()(std::int64_t task) const {
    if (axis == 0) {
      std::int64_t const x = task * lanes_of<Value>;
      Value sum(0.0);
      for (std::int64_t row = 0; row < layout.rows(); ++row)
        sum = sum + load<Value>(component + row * layout.pitch + x);
      store(Value(sum * Value(1.0 / static_cast<double>(layout.rows()))), averages + x);
    } else {
      std::int64_t const first = axis == 1 ? task : task * layout.ny;
      std::int64_t const step = axis == 1 ? layout.ny : 1;
      std::int64_t const count = axis == 1 ? layout.nz : layout.ny;
      double sum = 0;
      for (std::int64_t i = 0; i < count; ++i) {
        Real const* const row = component + (first + i * step) * layout.pitch;
        for (std::int32_t x = 0; x < layout.nx; ++x) sum += row[x];
      }
      averages[task] = sum / (static_cast<double>(count) * layout.nx);
    }
  }
};

struct LayerField {
  static constexpr int degree = 2;  // H is linear in the spins
  double const* averages;
  int axis;
  double strength;

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> field(
      Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    Value const h = along<Value>(stencil.site());
    Value const zero(0);
    return {axis == 0 ? h : zero, axis == 1 ? h : zero, axis == 2 ? h : zero};
  }

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION typename Stencil::value_type energy_density(
      Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    auto const m = stencil.center();
    Value const m_along = axis == 0 ? m.x : axis == 1 ? m.y : m.z;
    return Value(-0.5) * along<Value>(stencil.site()) * m_along;
  }

 private:
  template <class Value, class Site>
  KOKKOS_FORCEINLINE_FUNCTION Value along(Site const& site) const {
    Value const average =
        axis == 0 ? site.load_profile(averages)
                  : Value(static_cast<scalar_t<Value>>(averages[axis == 1 ? site.y() : site.z()]));
    return Value(static_cast<scalar_t<Value>>(-strength)) * average;
  }
};

}  // namespace detail

/// The demagnetising field of a layered slab: (m.n) is averaged over each plane of sites normal to
/// n, an axis of the lattice: H = -strength <m.n> n, E = strength <m.n> (m.n) / 2 per site.
template <class MemorySpace = Kokkos::DefaultExecutionSpace::memory_space>
class LayerAveragedSlabDemag {
 public:
  /// `axis`: 0, 1 or 2 for a normal along x, y or z.
  LayerAveragedSlabDemag(Lattice const& lattice, int axis, double strength = 1)
      : axis_(checked(axis)),
        strength_(strength),
        lattice_(detail::validated(lattice)),
        averages_("cayspin::LayerAveragedSlabDemag::averages",
                  static_cast<std::size_t>(layers() + detail::cache_line_bytes)) {
    detail::require_whole("cayspin::LayerAveragedSlabDemag", lattice);
  }

  template <class Spins>
  void check_spins(Spins const& spins) const {
    static_assert(std::is_same_v<typename Spins::memory_space, MemorySpace>,
                  "LayerAveragedSlabDemag was made for spins in another memory space.");
    require_lattice("cayspin::LayerAveragedSlabDemag", lattice_, spins.lattice());
  }

  template <class Exec, class Spins>
  detail::LayerField prepare(Exec const& exec, Spins const& spins, double) const {
    using Real = typename Spins::value_type;
    using Value = std::conditional_t<detail::is_host_execution<Exec>, detail::Pack<double>, double>;
    constexpr std::int64_t lanes = detail::lanes_of<Value>;
    std::int64_t const tasks = axis_ == 0 ? (spins.layout().nx + lanes - 1) / lanes : layers();
    auto const array = spins.array();
    detail::for_each_task(
        exec, "cayspin::LayerAveragedSlabDemag", tasks, spins.sites(),
        detail::AverageLayers<Value, Real>{array.data + axis_ * array.stride, spins.layout(), axis_,
                                           averages_.data()});
    return {averages_.data(), axis_, strength_};
  }

 private:
  std::int64_t layers() const { return lattice_.shape[static_cast<std::size_t>(axis_)]; }
  static int checked(int axis) {
    if (axis < 0 || axis > 2)
      throw std::invalid_argument("cayspin::LayerAveragedSlabDemag: the axis is 0, 1 or 2");
    return axis;
  }

  int axis_;
  double strength_;
  Lattice lattice_;
  Kokkos::View<double*, MemorySpace> averages_;
};

}  // namespace cayspin
