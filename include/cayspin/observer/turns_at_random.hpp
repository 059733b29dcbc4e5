// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/execution.hpp>
#include <cayspin/detail/memory.hpp>
#include <cayspin/detail/random_bits.hpp>
#include <cayspin/rotation/random_turn.hpp>
#include <cayspin/spin_field.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

// Kernels of ThermalNoise.
namespace cayspin::inline v0_2 {

namespace detail {

/// One RandomTurn for all sites; random bits choose each spin's rotation from it.
template <class Real, bool OnHost>
struct OneTurn {
  RandomTurn<Real, OnHost> turn;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION RandomTurn<Real, OnHost> const& at(Site const&) const {
    return turn;
  }
  template <class Site, class Vector>
  KOKKOS_FORCEINLINE_FUNCTION Vector kept(Site const&, Vector const&, Vector const& after) const {
    return after;
  }
};

/// One RandomTurn for each column (sites with equal x). Spins in columns whose temperature is 0 do
/// not turn.
template <class Real>
struct TurnOfColumn {
  Real const* numbers;  // number i of column x's RandomTurn is at i * stride + x
  std::int64_t stride;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION auto at(Site const& site) const {
    using Value = typename Site::value_type;
    return RandomTurnOfNumbers<Real, Value>{number<Value>(site, 0), number<Value>(site, 1),
                                            number<Value>(site, 2), number<Value>(site, 3)};
  }
  template <class Site, class Vector>
  KOKKOS_FORCEINLINE_FUNCTION Vector kept(Site const& site, Vector const& before,
                                          Vector const& after) const {
    using Value = typename Site::value_type;
    return select<Value>(number<Value>(site, 0) == Value(0), before, after);
  }

 private:
  template <class Value, class Site>
  KOKKOS_FORCEINLINE_FUNCTION Value number(Site const& site, std::int64_t which) const {
    return load<Value>(numbers + which * stride + site.x());
  }
};

template <class Real, bool OnHost>
struct TurnOrNone {
  RandomTurn<Real, OnHost> turn;
  bool is_none;
};

/// One RandomTurn for each site of a crystal's cell; replicas may have different ones. Spins that
/// do not move keep their direction.
template <class Real, bool OnHost>
struct TurnOfCellSite {
  TurnOrNone<Real, OnHost> const* turns;
  std::int32_t cell_sites;
  std::int32_t replica_planes;  // 0: all replicas have the same turns
  SiteArray<Real, 1> moves;     // without data: all move

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION RandomTurn<Real, OnHost> const& at(Site const& site) const {
    return turns[number(site)].turn;
  }
  template <class Site, class Vector>
  KOKKOS_FORCEINLINE_FUNCTION Vector kept(Site const& site, Vector const& before,
                                          Vector const& after) const {
    using Value = typename Site::value_type;
    if (turns[number(site)].is_none) return before;
    if (!moves.data) return after;
    return select<Value>(site.load(moves) == Value(0), before, after);
  }

 private:
  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION std::int32_t number(Site const& site) const {
    std::int32_t const replica = replica_planes == 0 ? 0 : site.z() / replica_planes;
    return replica * cell_sites + site.z() % cell_sites;
  }
};

/// One random rotation for each site of a lattice, of a variance that depends on the site.
template <class Real>
struct TurnOfSite {
  Real u;
  SiteArray<Real, 1> factors;  // factors of u; 0 where a spin does not move

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION auto at(Site const& site) const {
    using Value = typename Site::value_type;
    Value const own = Value(u) * site.load(factors);
    return RandomTurnOfSites<Real, Value>(own - own * own * Value(Real(1.0 / 12)));
  }
  template <class Site, class Vector>
  KOKKOS_FORCEINLINE_FUNCTION Vector kept(Site const& site, Vector const& before,
                                          Vector const& after) const {
    using Value = typename Site::value_type;
    return select<Value>(site.load(factors) == Value(0), before, after);
  }
};

template <class Real>
struct LargestNumber {
  SiteArray<Real, 1> numbers;

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Value* largest) const {
    largest[0] = site.load(numbers);
  }
};

/// A table of random rotations for the value of u = damping * temperature * dt that was requested
/// last. A copy has its own table.
template <class Entry, class MemorySpace>
class TableOfTurns {
 public:
  TableOfTurns() = default;
  explicit TableOfTurns(std::size_t size) : table_("cayspin::ThermalNoise::turns", size) {}
  TableOfTurns(TableOfTurns const& other) : TableOfTurns(other.table_.size()) {}
  TableOfTurns(TableOfTurns&&) noexcept = default;
  TableOfTurns& operator=(TableOfTurns other) noexcept {
    std::swap(table_, other.table_);
    std::swap(made_for_, other.made_for_);
    return *this;
  }
  ~TableOfTurns() = default;

  std::size_t size() const { return table_.size(); }

  /// Returns the table for `u`. Unless `u` was requested last, calls fill(table in host memory) and
  /// waits.
  template <class Exec, class Fill>
  Entry const* get(Exec const& exec, double u, Fill const& fill) {
    if (u != made_for_) {
      // Kernels of any instance may still read the table, and the mirror of memory that the host
      // can reach is this memory itself.
      constexpr char const* label = "cayspin::ThermalNoise: the turns before are done";
      fence_all_instances<Exec>(label);
      exec.fence(label);
      auto const table = Kokkos::create_mirror_view(table_);
      fill(table);
      Kokkos::deep_copy(exec, table_, table);
      exec.fence("cayspin::ThermalNoise: turns of the next steps");
      made_for_ = u;
    }
    return table_.data();
  }

 private:
  Kokkos::View<Entry*, MemorySpace> table_;
  double made_for_ = -1;
};

/// Random numbers for the sites of a lattice, which may have replicas or be part of a larger one.
template <bool OnHost>
struct NumbersOfSites {
  RandomBitsOfReplica<OnHost> random;
  // The part's place in the whole lattice, and the extents of the whole lattice.
  std::int64_t first_y, first_z, ny, nz;
  std::uint64_t places;         // sites in a row, rounded up to whole registers of RandomBits
  std::int32_t replica_planes;  // 0: there is one replica

  template <class Bits, class Site>
  KOKKOS_FORCEINLINE_FUNCTION auto get(Site const& site) const {
    std::int32_t const replica = replica_planes == 0 ? 0 : site.z() / replica_planes;
    std::int64_t const y = wrapped(first_y + site.y(), ny),
                       z = wrapped(first_z + site.z() - replica * replica_planes, nz);
    auto const row = static_cast<std::uint64_t>(z * ny + y) * places;
    return random.template get<Bits, lanes_of<typename Site::value_type>>(
        replica, row + static_cast<std::uint64_t>(site.x()));
  }

  static std::uint64_t places_of_row(std::int64_t nx) {
    constexpr auto lanes = RandomBits<OnHost>::most_lanes;
    return (static_cast<std::uint64_t>(nx) + lanes - 1) / lanes * lanes;
  }

 private:
  // Adding or subtracting the extent once is enough, because ghosts are less than a lattice away.
  KOKKOS_FORCEINLINE_FUNCTION static std::int64_t wrapped(std::int64_t at, std::int64_t extent) {
    return at < 0 ? at + extent : at < extent ? at : at - extent;
  }
};

/// Random numbers for columns; each column is a lattice whose rows are along y.
template <bool Keeps>
struct NumbersOfColumns {
  RandomBitsOfColumns<Keeps> random;
  std::uint64_t places;  // in a row of such a lattice

  template <class Bits, class Site>
  KOKKOS_FORCEINLINE_FUNCTION auto get(Site const& site) const {
    return random.template get<Bits, lanes_of<typename Site::value_type>>(
        static_cast<std::uint64_t>(site.x()),
        static_cast<std::uint64_t>(site.z()) * places + static_cast<std::uint64_t>(site.y()));
  }
};

/// Functor that applies one or both halves of the noise between two steps.
template <class Real, class Turns, class Numbers>
struct TurnAtRandom {
  SiteArray<Real, 3> spins;
  OutputArray<Real, 3> output;
  Numbers numbers;
  Turns turns;
  bool after, before;  // which halves

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    using Value = typename Site::value_type;
    auto const bits = numbers.template get<typename ChoiceOfTurn<Real>::Bits>(site);
    auto const& turn = turns.at(site);
    Vec3<Value> const found = site.load(spins);
    Vec3<Value> m = found;
    if (after) {
      // Rounding errors of the turn repeat in each step: without normalising, lengths would drift.
      m = turn.template turned<0>(bits, m);
      m = multiply_add(Value(Real(-0.5)), dot(m, m), Value(Real(1.5))) * m;
    }
    if (before) m = turn.template turned<5>(bits, m);
    site.store(turns.kept(site, found, m), output);
  }
};

}  // namespace detail

}  // namespace cayspin::inline v0_2
