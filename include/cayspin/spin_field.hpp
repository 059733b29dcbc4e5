// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/execution.hpp>
#include <cayspin/detail/ghosts.hpp>
#include <cayspin/detail/memory.hpp>
#include <cayspin/row_layout.hpp>
#include <cayspin/vec3.hpp>

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace cayspin::inline v0_2 {

namespace detail {

inline Lattice const& validated(Lattice const& lattice) {
  lattice.validate();
  return lattice;
}

/// Functor that initialises a field. Its tasks are the rows, and then the margins before, between
/// and after the components. Packs at the ends of rows also compute with padding. The results are
/// discarded, but the padding must hold numbers that neither trap nor become denormal.
template <class Real>
struct FillField {
  Real* data;
  RowLayout layout;
  int components;
  Real last_component;

  std::int64_t tasks() const { return layout.rows() + 1 + components; }

  KOKKOS_FUNCTION void operator()(std::int64_t task) const {
    if (task < layout.rows()) {
      // The last row of a plane includes the padding of the plane.
      std::int64_t const y = task % layout.ny, z = task / layout.ny;
      std::ptrdiff_t const begin = layout.row_offset(y, z);
      std::ptrdiff_t const end = y + 1 < layout.ny ? begin + layout.pitch : (z + 1) * layout.plane;
      for (int c = 0; c < components; ++c)
        fill(component(c) + begin, component(c) + end,
             c + 1 == components ? last_component : Real(0));
    } else {
      auto const margin = static_cast<int>(task - layout.rows());
      std::ptrdiff_t const begin =
          margin == 0 ? 0 : component(margin - 1) + layout.nz * layout.plane;
      fill(begin, component(margin) + (margin == components ? layout.origin : 0), Real(0));
    }
  }

 private:
  KOKKOS_FUNCTION std::ptrdiff_t component(int c) const {
    return layout.origin + c * layout.component_stride;
  }
  KOKKOS_FUNCTION void fill(std::ptrdiff_t begin, std::ptrdiff_t end, Real value) const {
    for (std::ptrdiff_t i = begin; i < end; ++i) data[i] = value;
  }
};

template <class View, class Real, int Components, bool ToField>
struct CopySites {
  View view;
  SiteArray<Real, Components> array;
  RowLayout layout;
  KOKKOS_FUNCTION void operator()(std::int64_t site) const {
    std::ptrdiff_t const offset = layout.offset(site);
    for (int c = 0; c < Components; ++c) {
      Real& here = array.data[c * array.stride + offset];
      if constexpr (ToField) {
        here = static_cast<Real>(view(site, c));
      } else {
        view(site, c) = here;
      }
    }
  }
};

}  // namespace detail

/// `Components` numbers on every site of a lattice, each component in a separate array (RowLayout).
/// A handle: copies share the memory, as copies of a Kokkos::View do. A default-constructed or
/// moved-from field has no sites, and functions that take fields refuse it.
template <std::floating_point Real, int Components,
          class MemorySpace = Kokkos::DefaultExecutionSpace::memory_space>
class SiteField {
  static_assert(!std::is_same_v<Real, long double>, "cayspin fields hold float or double.");

 public:
  using value_type = Real;
  using memory_space = MemorySpace;
  using array_type = SiteArray<Real, Components>;
  static constexpr int components = Components;

  SiteField() = default;
  SiteField(SiteField const&) = default;
  SiteField& operator=(SiteField const&) = default;
  SiteField(SiteField&& other) noexcept : SiteField() { swap(*this, other); }
  SiteField& operator=(SiteField&& other) noexcept {
    SiteField moved(std::move(other));
    swap(*this, moved);
    return *this;
  }
  ~SiteField() = default;

  /// Allocates, and sets every site to (0, .., 0, last_component). Throws std::invalid_argument for
  /// an invalid lattice.
  SiteField(std::string const& label, Lattice const& lattice, Real last_component = Real(0))
      : lattice_(detail::validated(lattice)),
        layout_(RowLayout::of<Real>(lattice)),
        data_(Kokkos::view_alloc(Kokkos::WithoutInitializing, "cayspin::" + label),
              layout_.allocation(Components)) {
    using Exec = typename MemorySpace::execution_space;
    if constexpr (detail::is_host_execution<Exec>)
      detail::advise_huge_pages(data_.data(), data_.size() * sizeof(Real));
    Exec const exec;
    detail::FillField<Real> const fill{data_.data(), layout_, Components, last_component};
    detail::for_each_task(exec, "cayspin::SiteField::fill", fill.tasks(), layout_.sites(), fill);
    exec.fence("cayspin::SiteField: filled");
  }

  Lattice const& lattice() const { return lattice_; }
  RowLayout const& layout() const { return layout_; }
  std::int64_t sites() const { return layout_.own.count() * layout_.nx; }  // without ghosts
  std::size_t bytes() const { return data_.size() * sizeof(Real); }
  std::string label() const { return data_.label(); }

  /// Returns the array that kernels and field terms take.
  array_type array() const { return {data_.data() + layout_.origin, layout_.component_stride}; }
  OutputArray<Real, Components> output(bool streaming) const { return {array(), streaming}; }
  /// Returns the whole memory of the field, padding included; use it for deep copies between fields
  /// on equal lattices.
  Kokkos::View<Real*, MemorySpace> const& allocation() const { return data_; }

  /// Return or set the vector of one site; only for host code on fields in host memory. `site` is
  /// not checked.
  Vec3<Real> get(std::int64_t site) const
    requires(Components == 3 && std::is_same_v<MemorySpace, Kokkos::HostSpace>)
  {
    Real const* const from = data_.data() + layout_.origin + layout_.offset(site);
    return {from[0], from[layout_.component_stride], from[2 * layout_.component_stride]};
  }
  void set(std::int64_t site, Vec3<Real> const& value) const
    requires(Components == 3 && std::is_same_v<MemorySpace, Kokkos::HostSpace>)
  {
    Real* const to = data_.data() + layout_.origin + layout_.offset(site);
    to[0] = value.x;
    to[layout_.component_stride] = value.y;
    to[2 * layout_.component_stride] = value.z;
  }

  friend void swap(SiteField& a, SiteField& b) noexcept {
    std::swap(a.lattice_, b.lattice_);
    std::swap(a.layout_, b.layout_);
    std::swap(a.data_, b.data_);
  }

 private:
  Lattice lattice_{{0, 0, 0}};  // no valid field has this lattice
  RowLayout layout_;
  Kokkos::View<Real*, MemorySpace> data_;
};

/// Throws std::invalid_argument when `who`, which was made for `lattice`, is given spins on another
/// lattice. Terms and generators call it in check_spins.
inline void require_lattice(char const* who, Lattice const& lattice, Lattice const& spins) {
  if (lattice == spins) return;
  auto const sites = [](Lattice const& lattice_of_sites) {
    auto const& shape = lattice_of_sites.shape;
    return std::to_string(shape[0]) + " x " + std::to_string(shape[1]) + " x " +
           std::to_string(shape[2]);
  };
  throw std::invalid_argument(
      std::string(who) + ": made for a lattice " +
      (lattice.shape != spins.shape
           ? "of " + sites(lattice) + " sites, and the spins are on " + sites(spins)
       : lattice.replicas != spins.replicas
           ? "of " + std::to_string(lattice.replicas) + " replicas, and the spins have " +
                 std::to_string(spins.replicas)
       : lattice.cell_sites != spins.cell_sites
           ? "with another number of sites in a cell than that of the spins"
       : lattice.part != spins.part
           ? "of another mpi::Domain than that of the spins, or of none; accepted: the lattice of "
             "the spins"
           : "of other spacings or boundaries than that of the spins"));
}

namespace detail {

/// Returns fields "name_1", "name_2", ..
template <class Field, std::size_t Count>
CAYSPIN_DETAIL_NOINLINE std::array<Field, Count> numbered_fields(std::string const& name,
                                                                 Lattice const& lattice) {
  std::array<Field, Count> fields;
  for (std::size_t i = 0; i < Count; ++i)
    fields[i] = Field(name + "_" + std::to_string(i + 1), lattice);
  return fields;
}

}  // namespace detail

/// One number per site, for example a coefficient.
template <std::floating_point Real, class MemorySpace = Kokkos::DefaultExecutionSpace::memory_space>
using ScalarField = SiteField<Real, 1, MemorySpace>;

/// A unit vector per site, initially +z. Geometric steppers preserve the lengths of the spins that
/// they are given: use require_unit_spins (observer/normalize.hpp) to check spins that you copy in.
template <std::floating_point Real, class MemorySpace = Kokkos::DefaultExecutionSpace::memory_space>
class SpinField : public SiteField<Real, 3, MemorySpace> {
 public:
  SpinField() = default;
  SpinField(std::string const& label, Lattice const& lattice)
      : SiteField<Real, 3, MemorySpace>(label, lattice, Real(1)) {}
};

namespace detail {

template <bool ToField, class Exec, class View, class Real, int Components, class MemorySpace>
void copy_sites(Exec const& exec, View const& view,
                SiteField<Real, Components, MemorySpace> const& field) {
  static_assert(View::rank() == 2, "cayspin::copy takes a View of rank 2: (sites, components).");
  check_access<Exec, MemorySpace>();
  check_access<Exec, typename View::memory_space>();
  require_extents("cayspin::copy", view, field.sites(), Components);
  Kokkos::parallel_for(
      "cayspin::copy",
      Kokkos::RangePolicy<Exec, Kokkos::IndexType<std::int64_t>>(exec, 0, field.sites()),
      CopySites<View, Real, Components, ToField>{view, field.array(), field.layout()});
}

}  // namespace detail

/// Copies a View of extents (sites, Components) into a field; the x index of the sites varies
/// fastest. Does not wait, unless the field is on a part of a lattice: then this also updates
/// ghosts, and all parts must call it. Throws std::invalid_argument when the extents differ.
template <class Exec, class View, class Real, int Components, class MemorySpace>
void copy(Exec const& exec, View const& from, SiteField<Real, Components, MemorySpace> const& to) {
  detail::copy_sites<true>(exec, from, to);
  detail::update_ghosts(exec, to.lattice(), to);
}

/// Copies a field into a View of extents (sites, Components); the x index of the sites varies
/// fastest. Does not wait. Throws std::invalid_argument when the extents differ.
template <class Exec, class View, class Real, int Components, class MemorySpace>
void copy(Exec const& exec, SiteField<Real, Components, MemorySpace> const& from, View const& to) {
  detail::copy_sites<false>(exec, to, from);
}

/// Copies numbers in host memory into a field; waits for all instances. The components of a site
/// are adjacent, and the x index of the sites varies fastest. If there are only enough numbers for
/// one replica of the lattice, all replicas get these. Throws std::invalid_argument for any other
/// count.
template <class Number, class Real, int Components, class MemorySpace>
void copy_from_host(std::vector<Number> const& from,
                    SiteField<Real, Components, MemorySpace> const& to) {
  auto const replicas = to.lattice().replicas;
  if (replicas > 1 &&
      static_cast<std::int64_t>(from.size()) * replicas == to.sites() * Components) {
    std::vector<Number> all;
    all.reserve(from.size() * static_cast<std::size_t>(replicas));
    for (std::int64_t r = 0; r < replicas; ++r) all.insert(all.end(), from.begin(), from.end());
    return copy_from_host(all, to);
  }
  detail::require_size("cayspin::copy_from_host", from.size(), to.sites() * Components);
  using Exec = typename MemorySpace::execution_space;
  constexpr std::size_t components = Components;
  Kokkos::View<Number const* [components], Kokkos::LayoutRight, Kokkos::HostSpace,
               Kokkos::MemoryUnmanaged> const host(from.data(), to.sites());
  detail::fence_all_instances<Exec>("cayspin::copy_from_host");
  Exec const exec;
  auto const there = Kokkos::create_mirror_view_and_copy(
      Kokkos::view_alloc(exec, MemorySpace(), "cayspin::copy_from_host"), host);
  copy(exec, there, to);
  exec.fence("cayspin::copy_from_host");
}

/// Returns the field's numbers in host memory, in the order of copy_from_host; waits.
template <class Real, int Components, class MemorySpace>
std::vector<Real> copy_to_host(SiteField<Real, Components, MemorySpace> const& from) {
  using Exec = typename MemorySpace::execution_space;
  std::vector<Real> numbers(static_cast<std::size_t>(from.sites() * Components));
  constexpr std::size_t components = Components;
  Kokkos::View<Real* [components], Kokkos::LayoutRight, Kokkos::HostSpace,
               Kokkos::MemoryUnmanaged> const host(numbers.data(), from.sites());
  auto const there = [&] {
    using View = Kokkos::View<Real* [components], Kokkos::LayoutRight, MemorySpace>;
    if constexpr (std::is_same_v<MemorySpace, Kokkos::HostSpace>)
      return host;
    else  // create_mirror_view takes no label
      return View(Kokkos::view_alloc(Kokkos::WithoutInitializing, "cayspin::copy_to_host"),
                  host.extent(0));
  }();
  detail::fence_all_instances<Exec>("cayspin::copy_to_host");
  Exec const exec;
  copy(exec, from, there);
  Kokkos::deep_copy(exec, host, there);
  exec.fence("cayspin::copy_to_host");
  return numbers;
}

}  // namespace cayspin::inline v0_2
