// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Neighbours in a stencil against an index calculation, for every row length up to 40 sites.
#include "../support/evaluate.hpp"

#include <cayspin/detail/unrolled.hpp>

namespace cayspin::test {

/// A generator that returns one neighbour.
template <int Axis, bool Next>
struct Neighbor {
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION auto operator()(Stencil const& stencil) const {
    if constexpr (Next)
      return stencil.template next<Axis>();
    else
      return stencil.template previous<Axis>();
  }
};

constexpr double missing = -7;

/// A generator that returns one neighbour, or `missing` in all components if there is none.
template <int Axis, bool Next>
struct NeighborOrMissing {
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION auto operator()(Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    auto const none = as_value<Value>(Vec3<double>{missing, missing, missing});
    if constexpr (Next)
      return next<Axis>(stencil, none);
    else
      return previous<Axis>(stencil, none);
  }
};

/// A generator that returns the values of a field at the previous site, the site and the next one.
template <int Axis, class Real>
struct Numbers {
  SiteArray<Real, 1> numbers;

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION auto operator()(Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    auto const& site = stencil.site();
    Value const own = site.load(numbers);
    return Vec3<Value>{site.template neighbor<Axis, 0>(numbers, own), own,
                       site.template neighbor<Axis, 1>(numbers, own)};
  }
};

/// A generator that returns the site's own index.
struct Index {
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION auto operator()(Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    using Scalar = detail::scalar_t<Value>;
    auto const& site = stencil.site();
    return Vec3<Value>{Value(static_cast<Scalar>(site.x())) + detail::lane_numbers<Value>(),
                       Value(static_cast<Scalar>(site.y())), Value(static_cast<Scalar>(site.z()))};
  }
};

namespace {

/// Returns distinct numbers that float holds exactly: x + 1, -(y + 1), 1000 + z.
std::vector<double> numbered(Lattice const& lattice) {
  std::vector<double> numbers;
  for (std::int64_t z = 0; z < lattice.shape[2]; ++z)
    for (std::int64_t y = 0; y < lattice.shape[1]; ++y)
      for (std::int64_t x = 0; x < lattice.shape[0]; ++x)
        for (std::int64_t const n : {x + 1, -(y + 1), 1000 + z})
          numbers.push_back(static_cast<double>(n));
  return numbers;
}

/// Returns the site one step along an axis, or the site itself if there is none.
std::int64_t neighbor(Lattice const& lattice, std::int64_t site, int axis, int step) {
  auto const& n = lattice.shape;
  std::array<std::int64_t, 3> index{site % n[0], site / n[0] % n[1], site / (n[0] * n[1])};
  index[axis] += step;
  bool const outside = index[axis] < 0 || index[axis] >= n[axis];
  if (outside && lattice.boundary[axis] == Boundary::open) return site;
  index[axis] = (index[axis] + n[axis]) % n[axis];
  return index[0] + n[0] * (index[1] + n[1] * index[2]);
}

/// Returns true if the site one step along an axis exists, and is another one.
bool has_neighbor(Lattice const& lattice, std::int64_t site, int axis, int step) {
  return lattice.shape[axis] > 1 && neighbor(lattice, site, axis, step) != site;
}

template <class Backend>
class Neighbors : public ::testing::Test {
 protected:
  template <int Axis, bool Next, class Spins>
  static int wrong(Spins const& spins, std::vector<double> const& numbers) {
    typename Backend::Exec const exec;
    auto const found = evaluated(exec, Neighbor<Axis, Next>{}, spins);
    auto const or_missing = evaluated(exec, NeighborOrMissing<Axis, Next>{}, spins);
    auto const& lattice = spins.lattice();
    constexpr int step = Next ? 1 : -1;
    int count = 0;
    for (std::int64_t site = 0; site < spins.sites(); ++site) {
      std::int64_t const from = neighbor(lattice, site, Axis, step);
      bool const there = has_neighbor(lattice, site, Axis, step);
      for (int c = 0; c < 3; ++c) {
        double const expected = numbers[3 * from + c];
        count += found[3 * site + c] != expected;
        count += or_missing[3 * site + c] != (there ? expected : missing);
      }
    }
    return count;
  }

  static void expect_neighbors(Lattice const& lattice) {
    auto const numbers = numbered(lattice);
    auto const spins = spins_of<typename Backend::Spins>(lattice, numbers);
    std::string const what = "shape " + std::to_string(lattice.shape[0]) + " " +
                             std::to_string(lattice.shape[1]) + " " +
                             std::to_string(lattice.shape[2]);
    detail::unrolled<3>([&](auto axis) {
      EXPECT_EQ((wrong<axis(), false>(spins, numbers)), 0) << what << ", previous along " << axis();
      EXPECT_EQ((wrong<axis(), true>(spins, numbers)), 0) << what << ", next along " << axis();
    });
  }

  template <int Axis>
  static void expect_numbers(Lattice const& lattice) {
    typename Backend::Exec const exec;
    std::vector<double> numbers;
    for (std::int64_t site = 0; site < lattice.sites(); ++site)
      numbers.push_back(static_cast<double>(site + 1));
    ScalarField<typename Backend::Real, typename Backend::MemorySpace> const field("numbers",
                                                                                   lattice);
    copy_from_host(numbers, field);
    typename Backend::Spins const spins("spins", lattice);
    auto const found = evaluated(exec, Numbers<Axis, typename Backend::Real>{field.array()}, spins);
    int wrong = 0;
    for (std::int64_t site = 0; site < lattice.sites(); ++site)
      for (int step = -1; step <= 1; ++step)
        wrong += found[3 * site + 1 + step] != numbers[neighbor(lattice, site, Axis, step)];
    EXPECT_EQ(wrong, 0) << "shape " << lattice.shape[0] << " " << lattice.shape[1] << " "
                        << lattice.shape[2] << ", axis " << Axis;
  }

  static std::array<Boundary, 3> boundaries(int bits) {
    auto const which = [&](int axis) {
      return (bits >> axis & 1) != 0 ? Boundary::periodic : Boundary::open;
    };
    return {which(0), which(1), which(2)};
  }
};
TYPED_TEST_SUITE(Neighbors, Backends, BackendName);

TYPED_TEST(Neighbors, EveryRowLength) {
  for (std::int64_t nx = 1; nx <= 40; ++nx)
    for (int bits = 0; bits < 8; ++bits)
      this->expect_neighbors({{nx, 3, 2}, {1, 1, 1}, this->boundaries(bits)});
}

TYPED_TEST(Neighbors, EveryExtentAlongYAndZ) {
  for (std::int64_t n = 1; n <= 5; ++n)
    for (int bits = 0; bits < 8; ++bits) {
      this->expect_neighbors({{3, n, 1}, {1, 1, 1}, this->boundaries(bits)});
      this->expect_neighbors({{1, 2, n}, {1, 1, 1}, this->boundaries(bits)});
      this->expect_neighbors({{17, n, n}, {1, 1, 1}, this->boundaries(bits)});
    }
}

TYPED_TEST(Neighbors, OfFieldsOfNumbers) {
  for (std::int64_t nx = 1; nx <= 34; ++nx)
    for (int const bits : {0, 7}) {
      Lattice const lattice{{nx, 3, 2}, {1, 1, 1}, this->boundaries(bits)};
      detail::unrolled<3>([&](auto axis) { this->template expect_numbers<axis()>(lattice); });
    }
}

// Rows that are divided among several tasks, and end with a whole pack or within one.
TYPED_TEST(Neighbors, LongRows) {
  std::int64_t const task = detail::sites_per_task;
  for (std::int64_t const nx : {2 * task, 2 * task + 1, 3 * task - 1, 3 * task + 13})
    for (int const bits : {0, 7})
      this->expect_neighbors({{nx, 2, 1}, {1, 1, 1}, this->boundaries(bits)});
  EXPECT_EQ(detail::tasks_per_row(RowLayout::of<float>(Lattice::chain(3 * task + 13))), 3);
}

// Each site is visited with its own index, also with streaming stores.
TYPED_TEST(Neighbors, SitesKnowTheirPlace) {
  typename TypeParam::Exec const exec;
  for (std::int64_t const nx : {1, 7, 8, 9, 16, 17, 40, 9000}) {
    Lattice const lattice = Lattice::cubic(nx, 3, 2);
    typename TypeParam::Spins const spins("spins", lattice);
    for (bool const streaming : {false, true}) {
      auto const found = evaluated(exec, Index{}, spins, 0, streaming);
      int wrong = 0;
      for (std::int64_t site = 0; site < lattice.sites(); ++site) {
        auto const index = at(found, site);
        wrong += index.x != static_cast<double>(site % nx) ||
                 index.y != static_cast<double>(site / nx % 3) ||
                 index.z != static_cast<double>(site / nx / 3);
      }
      EXPECT_EQ(wrong, 0) << nx;
    }
  }
}

}  // namespace
}  // namespace cayspin::test
