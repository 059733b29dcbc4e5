// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/distant_sites.hpp>
#include <cayspin/detail/execution.hpp>
#include <cayspin/detail/row_fields.hpp>
#include <cayspin/detail/unrolled.hpp>
#include <cayspin/field/bonds_of_sites.hpp>
#include <cayspin/stencil.hpp>

#include <cstddef>
#include <cstdint>

namespace cayspin::inline v0_2::detail {

/// PairCouplings for kernels. Sums the bonds of a site in the order of their table, spin by spin or
/// along a row, with bitwise equal results.
template <class Real>
class PairField {
 public:
  PairField(DistantSites<Real> const& spins, BondTable const& table)
      : spins_(spins), table_(table) {}

  KOKKOS_FORCEINLINE_FUNCTION std::int32_t site_of_plane(std::int32_t z) const {
    return table_.site_of_plane(z);
  }

  /// Sums over the bonds of a site: H, split by its degree in the spins. energy() is half the
  /// energy of all these bonds.
  template <class Value>
  struct Parts {
    Vec3<Value> linear, cubic;

    KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> field() const { return linear + cubic; }
    KOKKOS_FORCEINLINE_FUNCTION Value energy(Vec3<Value> const& m) const {
      return Value(-0.25) * dot(m, Value(2) * linear + cubic);
    }
  };

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> field(Stencil const& stencil) const {
    return parts(stencil).field();
  }
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION ValueOf<Stencil> energy_density(Stencil const& stencil) const {
    return parts(stencil).energy(stencil.center());
  }

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Parts<ValueOf<Stencil>> parts(Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    auto const& site = stencil.site();
    auto const& of_site = table_.sites[table_.site_of_plane(site.z())];
    std::int32_t const x = site.x(), y = site.y(), z = site.z();
    std::ptrdiff_t const offset = site.offset();
    bool const holds_rows = of_site.reach.holds_rows(y, spins_.plane_of_replica(z), spins_.extent);
    if (holds_rows && of_site.reach.holds_along_row(x, lanes_of<Value>, spins_.extent)) [[likely]]
      return sum<Value>(of_site, stencil.center(), [&](std::int32_t b) {
        return spins_.template inside<Value>(offset + table_.bonds[b].template offset<Real>());
      });
    return sum_at_edge(of_site, stencil.center(), x, y, z);
  }

  /// Computes H of sites begin .. end - 1 of a row, in whole packs.
  CAYSPIN_DETAIL_NOINLINE void evaluate_row(Row const& row, std::int32_t begin, std::int32_t end,
                                            RowFields<Real> const& to) const {
    auto const& of_site = table_.sites[table_.site_of_plane(row.z)];
    Real const* const own = spins_.array.data + row.offset;
    if (of_site.last_bond - of_site.first_bond > RowsOfBonds::most ||
        Kokkos::max(of_site.reach.low[0], of_site.reach.high[0]) > lanes) {
      // There are too many bonds for RowsOfBonds, or some would read more than one pack past an end
      // of the first or the last row, which memory does not allow. So bonds are wrapped one by one.
      for (std::int32_t x = begin; x < end; x += lanes)
        store(sum_at_edge(of_site, spins_.template load_at<OnHost>(own + x), x, row.y, row.z),
              to.data + (x - begin));
    } else if (of_site.reach.holds_rows(row.y, spins_.plane_of_replica(row.z), spins_.extent)) {
      evaluate_along(of_site, RowsInPlace{own, table_.bonds}, begin, end, to.data);
    } else {
      evaluate_along(of_site, RowsOfBonds(*this, of_site, row), begin, end, to.data);
    }
  }

 private:
  using OnHost = Pack<Real>;
  static constexpr std::int32_t lanes = lanes_of<OnHost>;

  // The two types below return, for each bond, the row to which it leads, shifted along x: element
  // x of the result is the site to which the bond of site x leads.

  /// For bonds that all lead to rows inside the lattice.
  struct RowsInPlace {
    static constexpr bool all_there = true;
    Real const* own;
    Bond const* bonds;

    Real const* operator[](std::int32_t b) const { return own + bonds[b].template offset<Real>(); }
  };
  /// For bonds some of which wrap around along y or z, or lead past an open end there. Rows past an
  /// open end are null.
  class RowsOfBonds {
   public:
    static constexpr bool all_there = false;
    static constexpr std::int32_t most = 256;
    Real const* own;

    RowsOfBonds(PairField const& field, BondsOfSite const& of_site, Row const& row)
        : own(field.spins_.array.data + row.offset), first_(of_site.first_bond) {
      for (std::int32_t b = first_; b < of_site.last_bond; ++b) {
        auto const& bond = field.table_.bonds[b];
        Real const* const there = field.spins_.row(row.y, row.z, bond.dy, bond.dz);
        rows_[b - first_] = there ? there + bond.dx : nullptr;
      }
    }
    Real const* operator[](std::int32_t b) const { return rows_[b - first_]; }

   private:
    std::int32_t first_;
    Real const* rows_[most];
  };

  template <class Rows>
  CAYSPIN_DETAIL_NOINLINE void evaluate_along(BondsOfSite const& of_site, Rows const& rows,
                                              std::int32_t begin, std::int32_t end,
                                              Real* to) const {
    std::int32_t x = begin;
    bool const has_bonds = of_site.first_bond < of_site.last_bond;
    Real const* const farthest = has_bonds ? rows[of_site.farthest] : nullptr;
    auto const sum = [&](auto packs) {
      if (farthest) prefetch_packs<packs()>(farthest + x + spins_.pitch);
      sum_packs<packs()>(of_site, rows, x, to + (x - begin));
      x += packs() * lanes;
    };
    while (x + 4 * lanes <= end) sum(std::integral_constant<int, 4>());
    while (x + 2 * lanes <= end) sum(std::integral_constant<int, 2>());
    while (x < end) sum(std::integral_constant<int, 1>());
    // So far, bonds past an end of the row were read without wrapping. Sites near the ends are
    // summed again.
    std::int32_t const nx = spins_.extent[0];
    for (x = begin; x < Kokkos::min(of_site.reach.low[0], end); ++x)
      sum_near_end(of_site, rows, x, to + (x - begin));
    for (x = Kokkos::max(begin, nx - of_site.reach.high[0]); x < Kokkos::min(nx, end); ++x)
      sum_near_end(of_site, rows, x, to + (x - begin));
  }
  template <int Packs>
  void prefetch_packs(Real const* from) const {
    constexpr int line = static_cast<int>(cache_line_bytes / sizeof(Real));
    for (int component = 0; component < 3; ++component)
      for (int i = 0; i < Packs * lanes; i += line)
        prefetch(from + component * spins_.array.stride + i);
  }
  template <int Packs, class Rows>
  void sum_packs(BondsOfSite const& of_site, Rows const& rows, std::int32_t x, Real* to) const {
    std::ptrdiff_t const stride = spins_.array.stride;
    Vec3<OnHost> sums[std::size_t{Packs}];
    unrolled<Packs>([&](auto i) { sums[i()] = zero<OnHost>(); });
    for (std::int32_t g = of_site.first_shell; g < of_site.last_shell; ++g) {
      auto const& shell = table_.shells[g];
      Vec3<OnHost> all[std::size_t{Packs}];
      auto const with_each = [&](std::int32_t b, auto const& take) {
        Real const *const of_x = rows[b] + x, *const of_y = of_x + stride,
                          *const of_z = of_y + stride;
        unrolled<Packs>([&](auto i) {
          constexpr int shift = i() * lanes;
          take(all[i()], Vec3<OnHost>{load<OnHost>(of_x + shift), load<OnHost>(of_y + shift),
                                      load<OnHost>(of_z + shift)});
        });
      };
      std::int32_t b = shell.first;
      if constexpr (Rows::all_there)
        with_each(b++, [](auto& sum, auto const& there) { sum = there; });
      else
        unrolled<Packs>([&](auto i) { all[i()] = zero<OnHost>(); });
      for (; b < shell.last; ++b)
        if (Rows::all_there || rows[b])
          with_each(b, [](auto& sum, auto const& there) { sum = sum + there; });
      unrolled<Packs>([&](auto i) {
        sums[i()] = multiply_add(as_value<OnHost>(shell.exchange), all[i()], sums[i()]);
      });
    }
    unrolled<Packs>([&](auto i) { store(sums[i()], to + i() * lanes); });
    if (of_site.first_tensor == of_site.last_bond) return;
    for (std::int32_t i = 0; i < Packs; ++i)
      add_tensors(of_site, rows, x + i * lanes, to + i * lanes);
  }
  template <class Rows>
  void add_tensors(BondsOfSite const& of_site, Rows const& rows, std::int32_t x, Real* to) const {
    Parts<OnHost> sums{RowFields<Real>{to}.template load<OnHost>(0), zero<OnHost>()};
    auto const m = spins_.template load_at<OnHost>(rows.own + x);
    for (std::int32_t b = of_site.first_tensor; b < of_site.last_bond; ++b)
      if (Rows::all_there || rows[b])
        add_tensor(of_site, b, m, spins_.template load_at<OnHost>(rows[b] + x), sums);
    store(sums, to);
  }
  /// Sums the bonds of a site near an end of the row again, because the pass over packs read those
  /// that lead past the end without wrapping.
  template <class Rows>
  CAYSPIN_DETAIL_NOINLINE void sum_near_end(BondsOfSite const& of_site, Rows const& rows,
                                            std::int32_t x, Real* to) const {
    auto const m = spins_.template load_at<Real>(rows.own + x);
    std::int32_t const nx = spins_.extent[0];
    if (Rows::all_there && spins_.periodic[0]) {
      auto const& reach = of_site.reach;
      std::int32_t const number = x < reach.low[0] ? x : reach.low[0] + x - (nx - reach.high[0]);
      auto const* const ways = table_.rounds + of_site.first_round +
                               number * (of_site.last_bond - of_site.first_bond) -
                               of_site.first_bond;
      store(sum(of_site, m,
                [&](std::int32_t b) {
                  return spins_.template load_at<Real>(rows.own + x +
                                                       ways[b].template offset<Real>());
                }),
            to);
    } else {
      store(sum(of_site, m,
                [&](std::int32_t b) {
                  std::int32_t const dx = table_.bonds[b].dx;
                  return rows[b] ? spins_.template along<Real>(rows[b] - dx, x + dx) : zero<Real>();
                }),
            to);
    }
  }

  template <class Value>
  static void store(Parts<Value> const& sums, Real* to) {
    store(sums.field(), to);
  }
  template <class Value>
  static void store(Vec3<Value> const& field, Real* to) {
    RowFields<Real>{to}.store(field, 0);
  }

  template <class Value>
  CAYSPIN_DETAIL_NOINLINE KOKKOS_FUNCTION Parts<Value> sum_at_edge(BondsOfSite const& of_site,
                                                                   Vec3<Value> const& m,
                                                                   std::int32_t x, std::int32_t y,
                                                                   std::int32_t z) const {
    return sum(of_site, m, [&](std::int32_t b) {
      auto const& bond = table_.bonds[b];
      Real const* const row = spins_.row(y, z, bond.dy, bond.dz);
      return row ? spins_.template along<Value>(row, x + bond.dx) : zero<Value>();
    });
  }

  template <class Value, class Load>
  KOKKOS_FORCEINLINE_FUNCTION Parts<Value> sum(BondsOfSite const& of_site, Vec3<Value> const& m,
                                               Load const& load) const {
    Parts<Value> sums{zero<Value>(), zero<Value>()};
    for (std::int32_t g = of_site.first_shell; g < of_site.last_shell; ++g) {
      auto const& shell = table_.shells[g];
      Vec3<Value> all = zero<Value>();
      for (std::int32_t b = shell.first; b < shell.last; ++b) all = all + load(b);
      sums.linear = multiply_add(as_value<Value>(shell.exchange), all, sums.linear);
    }
    for (std::int32_t b = of_site.first_tensor; b < of_site.last_bond; ++b)
      add_tensor(of_site, b, m, load(b), sums);
    return sums;
  }

  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION void add_tensor(BondsOfSite const& of_site, std::int32_t b,
                                              Vec3<Value> const& m, Vec3<Value> const& there,
                                              Parts<Value>& sums) const {
    double const* const t = table_.tensors[b + of_site.to_tensor].of;
    auto const row = [&](int i) {
      return Vec3<Value>{as_value<Value>(t[i]), as_value<Value>(t[i + 1]),
                         as_value<Value>(t[i + 2])};
    };
    sums.linear =
        sums.linear + Vec3<Value>{dot(row(0), there), dot(row(3), there), dot(row(6), there)};
    if (t[9] != 0)
      sums.cubic =
          multiply_add(Value(as_value<Value>(2 * t[9]) * dot(m, there)), there, sums.cubic);
  }

  DistantSites<Real> spins_;
  BondTable table_;
};

/// PairCouplings for loops over rows, which call begin_row. A separate type, because g++ does not
/// keep the spins in registers if the kernel can also compute H site by site.
template <class Real>
class PairFieldAlongRows : public PairField<Real> {
 public:
  static constexpr int row_fields = 1;

  using PairField<Real>::PairField;

  void begin_row(RowOfSpins<Real> const& row, std::int32_t begin, std::int32_t end,
                 RowFields<Real> const& memory) {
    this->evaluate_row(row.row, begin, end, memory);
    fields_ = memory;
    begin_ = begin;
  }
  template <class Stencil>
  VectorOf<Stencil> field(Stencil const& stencil) const {
    return fields_.template load<ValueOf<Stencil>>(stencil.site().x() - begin_);
  }

 private:
  RowFields<Real> fields_;  // of sites begin_, begin_ + 1, .. of a row
  std::int32_t begin_ = 0;
};

}  // namespace cayspin::inline v0_2::detail
