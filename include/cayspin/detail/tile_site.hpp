// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/device_site.hpp>
#include <cayspin/vec3.hpp>

#include <cstdint>

// A site of a device thread that has a tile of planes in the scratch memory of its team, and keeps
// some vectors of the site in registers.
namespace cayspin::inline v0_2::detail {

/// Vectors in scratch memory: those of a site and of its neighbours.
template <class Real>
struct ScratchStencil {
  Real const* planes[3];   // x component at the site in the plane before, its own and the next
  std::int32_t row, part;  // strides of rows and of components
};

/// A vector in scratch memory that a kernel writes.
template <class Real>
struct ScratchOutput {
  Real* to;
  std::int32_t part;
};

/// A vector of the site in registers.
template <class Real>
struct KeptVector {
  Vec3<Real> value{Real(0), Real(0), Real(0)};
};

template <class Real>
struct KeptOutput {
  KeptVector<Real>& kept;
};

/// Writes to two arrays, to the second only if asked.
template <class First, class Second>
struct TwoOutputs {
  First first;
  Second second;
  bool both;
};

template <class Value, class Index>
class TileSite : public DeviceSite<Value, Index> {
  using Base = DeviceSite<Value, Index>;

 public:
  using Base::Base, Base::load, Base::load_row, Base::neighbor, Base::store;
  using typename Base::Place;

  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> load(KeptVector<Value> const& vector) const {
    return vector.value;
  }
  KOKKOS_FORCEINLINE_FUNCTION void load_row(ScratchStencil<Value> const& spins, Place const& place,
                                            Vec3<Value>& center, Vec3<Value> (&beside)[2]) const {
    center = read(spins, spins.planes[1]);
    beside[0] = neighbor<0, 0>(spins, place);
    beside[1] = neighbor<0, 1>(spins, place);
  }
  /// Returns the neighbour, or the spin itself at an open end.
  template <int Axis, int Direction>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> neighbor(ScratchStencil<Value> const& spins,
                                                   Place const&) const {
    if (!this->template has_neighbor<Axis, Direction>()) return read(spins, spins.planes[1]);
    if constexpr (Axis == 2) {
      return read(spins, spins.planes[2 * Direction]);
    } else {
      std::int32_t const step = Axis == 0 ? 1 : spins.row;
      return read(spins, spins.planes[1] + (Direction == 0 ? -step : step));
    }
  }

  KOKKOS_FORCEINLINE_FUNCTION void store(Vec3<Value> const& value,
                                         ScratchOutput<Value> const& output) const {
    output.to[0] = value.x;
    output.to[output.part] = value.y;
    output.to[2 * output.part] = value.z;
  }
  KOKKOS_FORCEINLINE_FUNCTION void store(Vec3<Value> const& value,
                                         KeptOutput<Value> const& output) const {
    output.kept.value = value;
  }
  template <class First, class Second>
  KOKKOS_FORCEINLINE_FUNCTION void store(Vec3<Value> const& value,
                                         TwoOutputs<First, Second> const& outputs) const {
    store(value, outputs.first);
    if (outputs.both) store(value, outputs.second);
  }

 private:
  KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> read(ScratchStencil<Value> const& spins,
                                                      Value const* at) {
    return {at[0], at[spins.part], at[2 * spins.part]};
  }
};

}  // namespace cayspin::inline v0_2::detail
