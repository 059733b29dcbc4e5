// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/ghosts.hpp>
#include <cayspin/detail/reduce_sites.hpp>
#include <cayspin/part.hpp>
#include <cayspin/spin_field.hpp>
#include <cayspin/stencil.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <type_traits>

namespace cayspin::inline v0_1 {

namespace detail {

/// The mean of one component over each plane normal to x, summed in a fixed order. A task is a pack
/// of planes.
template <class Value, class Real>
struct AverageAlongX {
  Real const* component;
  RowLayout layout;
  double* averages;

  KOKKOS_FUNCTION void operator()(std::int64_t task) const {
    std::int64_t const x = task * lanes_of<Value>;
    Value sum(0.0);
    for (std::int32_t z = 0; z < layout.nz; ++z)
      for (std::int32_t y = 0; y < layout.ny; ++y)
        sum = sum + load<Value>(component + layout.row_offset(y, z) + x);
    store(Value(sum * Value(1.0 / static_cast<double>(layout.rows()))), averages + x);
  }
};

/// The rows of a component that a part has of layers normal to y or z.
template <class Real>
struct RowsOfLayers {
  Real const* component;
  RowLayout layout;
  int axis;

  template <class Add>
  KOKKOS_FUNCTION void for_each_sum(std::int64_t layer, Add const& add) const {
    auto const& own = layout.own;
    std::int64_t const begin = axis == 1 ? own.z_begin : own.y_begin;
    std::int64_t const end = axis == 1 ? own.z_end : own.y_end;
    for (std::int64_t i = begin; i < end; ++i) {
      Real const* const row =
          component + (axis == 1 ? layout.row_offset(layer, i) : layout.row_offset(i, layer));
      double sum = 0;
      for (std::int32_t x = 0; x < layout.nx; ++x) sum += row[x];
      add(sum);
    }
  }
};

/// The means over whole layers. A task is a layer.
template <class Real>
struct AverageLayers {
  RowsOfLayers<Real> rows;
  double sites_of_layer;
  double* averages;

  KOKKOS_FUNCTION void operator()(std::int64_t layer) const {
    double sum = 0;
    rows.for_each_sum(layer, [&](double of_row) { sum += of_row; });
    averages[layer] = sum / sites_of_layer;
  }
};

/// The same on a host: the order of rows does not matter.
template <class Real>
struct AverageLayersExactly {
  RowsOfLayers<Real> rows;
  double sites_of_layer;
  double* averages;

  void operator()(std::int64_t layer) const {
    ExactSum sum;
    rows.for_each_sum(layer, [&](double of_row) { sum.add(of_row); });
    averages[layer] = sum.rounded() / sites_of_layer;
  }
};

/// What a part has of layers that other parts share, as words.
template <class Real>
struct SumLayersOfPart {
  RowsOfLayers<Real> rows;
  std::int64_t own_begin;
  std::int64_t* words;  // of the first of the part's own layers

  void operator()(std::int64_t own_layer) const {
    ExactSum sum;
    rows.for_each_sum(own_begin + own_layer, [&](double of_row) { sum.add(of_row); });
    sum.carry();
    std::copy_n(sum.data(), ExactSum::words, words + own_layer * ExactSum::words);
  }
};

struct LayerField {
  static constexpr int degree = 2;  // H is linear in the spins
  double const* averages;
  int axis;
  double strength;

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> field(Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    Value const h = along<Value>(stencil.site());
    Value const zero(0);
    return {axis == 0 ? h : zero, axis == 1 ? h : zero, axis == 2 ? h : zero};
  }

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION ValueOf<Stencil> energy_density(Stencil const& stencil) const {
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
/// On a part of a lattice: in host memory, for normals along y and z.
template <class MemorySpace = Kokkos::DefaultExecutionSpace::memory_space>
class LayerAveragedSlabDemag {
 public:
  /// `axis`: 0, 1 or 2 for a normal along x, y or z. Throws std::invalid_argument for another axis
  /// or a strength that is not finite.
  LayerAveragedSlabDemag(Lattice const& lattice, int axis, double strength = 1)
      : axis_(checked(axis)),
        strength_(detail::finite(strength, "cayspin::LayerAveragedSlabDemag: the strength")),
        lattice_(detail::validated(lattice)),
        averages_("cayspin::LayerAveragedSlabDemag::averages",
                  static_cast<std::size_t>(layers(lattice) + detail::cache_line_bytes)) {
    if (lattice.part == nullptr) return;
    if (axis == 0 || !on_host)
      throw std::invalid_argument(
          "cayspin::LayerAveragedSlabDemag: works on a part of a lattice in host memory, with a "
          "normal along y or z");
    if (is_shared())
      words_ = Words("cayspin::LayerAveragedSlabDemag::words",
                     static_cast<std::size_t>(layers(whole(lattice)) * detail::ExactSum::words));
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
    auto const array = spins.array();
    Real const* const component = array.data + axis_ * array.stride;
    if (axis_ == 0)
      average_along_x(exec, component, spins);
    else
      average_rows(exec, detail::RowsOfLayers<Real>{component, spins.layout(), axis_}, spins);
    return {averages_.data(), axis_, strength_};
  }

 private:
  using Words = Kokkos::View<std::int64_t*, MemorySpace>;
  static constexpr bool on_host = detail::is_host_execution<typename MemorySpace::execution_space>;
  static constexpr char const* name = "cayspin::LayerAveragedSlabDemag";

  template <class Exec, class Real, class Spins>
  void average_along_x(Exec const& exec, Real const* component, Spins const& spins) const {
    using Value = std::conditional_t<detail::is_host_execution<Exec>, detail::Pack<double>, double>;
    constexpr std::int64_t lanes = detail::lanes_of<Value>;
    detail::for_each_task(
        exec, name, (spins.layout().nx + lanes - 1) / lanes, spins.sites(),
        detail::AverageAlongX<Value, Real>{component, spins.layout(), averages_.data()});
  }

  template <class Exec, class Rows, class Spins>
  void average_rows(Exec const& exec, Rows const& rows, Spins const& spins) const {
    using Real = typename Spins::value_type;
    auto const& all = whole(lattice_);
    double const sites = static_cast<double>(all.sites() / layers(all));
    if constexpr (!detail::is_host_execution<Exec>) {
      detail::for_each_task(exec, name, layers(lattice_), spins.sites(),
                            detail::AverageLayers<Real>{rows, sites, averages_.data()});
    } else if (!is_shared()) {
      detail::for_each_task(exec, name, layers(lattice_), spins.sites(),
                            detail::AverageLayersExactly<Real>{rows, sites, averages_.data()});
    } else {
      std::int64_t const ghosts = lattice_.ghosts[axis()].before;
      Kokkos::deep_copy(exec, words_, 0);
      detail::for_each_task(exec, name, lattice_.own(axis()), spins.sites(),
                            detail::SumLayersOfPart<Real>{rows, ghosts, words_of(ghosts)});
      exec.fence("cayspin::LayerAveragedSlabDemag: layers of the part summed");
      lattice_.part->sum({words_.data(), words_.size()});
      for (std::int64_t layer = 0; layer < layers(lattice_); ++layer) {
        detail::ExactSum sum;
        std::copy_n(words_of(layer), detail::ExactSum::words, sum.data());
        averages_(static_cast<std::size_t>(layer)) = sum.rounded() / sites;
      }
    }
  }

  /// Do other parts have sites of the same layers?
  bool is_shared() const {
    auto const other = static_cast<std::size_t>(3 - axis_);
    return axis_ != 0 && lattice_.own(other) != whole(lattice_).shape[other];
  }
  /// Of a layer of the part.
  std::int64_t* words_of(std::int64_t layer) const {
    auto const extent = layers(whole(lattice_));
    auto const number = (lattice_.part->begin()[axis()] + layer + extent) % extent;
    return words_.data() + number * detail::ExactSum::words;
  }

  std::size_t axis() const { return static_cast<std::size_t>(axis_); }
  std::int64_t layers(Lattice const& lattice) const { return lattice.shape[axis()]; }
  static int checked(int axis) {
    if (axis < 0 || axis > 2)
      throw std::invalid_argument("cayspin::LayerAveragedSlabDemag: the axis is 0, 1 or 2");
    return axis;
  }

  int axis_;
  double strength_;
  Lattice lattice_;
  Kokkos::View<double*, MemorySpace> averages_;
  Words words_;  // of all layers, where parts share them
};

}  // namespace cayspin::inline v0_1
