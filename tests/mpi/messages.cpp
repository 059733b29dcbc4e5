// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Ghosts equal the neighbours' sites, both if messages are sent in place, as on hosts, and if they
// are packed, as on devices.
#include <cayspin/detail/ghosts.hpp>
#include <cayspin/mpi/domain.hpp>
#include <cayspin/spin_field.hpp>

#include <gtest/gtest.h>

namespace cayspin::inline v0_2::mpi {
namespace {

/// Returns a value for component c of the site at this place in the whole lattice; all values
/// differ.
template <class Real>
Real number_of(Lattice const& whole, std::array<std::int64_t, 3> site, int c) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    site[axis] = (site[axis] + whole.shape[axis]) % whole.shape[axis];
  return static_cast<Real>(((site[2] * whole.shape[1] + site[1]) * whole.shape[0] + site[0]) * 4 +
                           c);
}

template <class Real, int Components>
using HostField = SiteField<Real, Components, Kokkos::HostSpace>;

/// Calls work(site, component, number) for all sites of this rank, including ghosts.
template <class Real, int Components, class Work>
void for_all(HostField<Real, Components> const& field, Work const& work) {
  auto const& layout = field.layout();
  auto const array = field.array();
  for (std::int64_t z = 0; z < layout.nz; ++z)
    for (std::int64_t y = 0; y < layout.ny; ++y)
      for (std::int64_t x = 0; x < layout.nx; ++x)
        for (int c = 0; c < Components; ++c)
          work({x, y, z}, c, array.data[c * array.stride + layout.row_offset(y, z) + x]);
}

/// Fills the part's own sites with number_of() of their place and component, and ghosts with -1.
template <class Real, int Components>
void fill(Domain const& domain, HostField<Real, Components> const& field) {
  auto const& local = domain.local();
  for_all(field, [&](std::array<std::int64_t, 3> const& site, int c, Real& number) {
    bool own = true;
    std::array<std::int64_t, 3> place;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      own = own && site[axis] >= local.ghosts[axis].before &&
            site[axis] < local.shape[axis] - local.ghosts[axis].after;
      place[axis] = domain.begin()[axis] + site[axis];
    }
    number = own ? number_of<Real>(domain.whole(), place, c) : Real(-1);
  });
}

template <class Real, int Components>
void expect_all(Domain const& domain, HostField<Real, Components> const& field) {
  std::int64_t wrong = 0;
  for_all(field, [&](std::array<std::int64_t, 3> const& site, int c, Real const& number) {
    std::array<std::int64_t, 3> place;
    for (std::size_t axis = 0; axis < 3; ++axis) place[axis] = domain.begin()[axis] + site[axis];
    wrong += number != number_of<Real>(domain.whole(), place, c);
  });
  EXPECT_EQ(wrong, 0);
}

TEST(Ghosts, HoldWhatTheNeighboursHold) {
  int ranks = 0;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  for (auto const boundary : {Boundary::open, Boundary::periodic})
    for (Division const& division :
         {Division{1, ranks}, Division{ranks, 1}, Division{2, ranks / 2}})
      for (std::int64_t const nx : {1, 5, 19, 700}) {  // at 700, components are sent one by one
        if (division.y * division.z != ranks) continue;
        SCOPED_TRACE(testing::Message() << division.y << " x " << division.z << ", " << nx);
        Domain const domain(MPI_COMM_WORLD, Lattice::cubic(nx, 13, 15, 1, boundary), 3, division);
        HostField<double, 3> const spins("spins", domain.local());
        HostField<float, 1> const number("number", domain.local());
        std::array const fields{cayspin::detail::field_numbers(spins),
                                cayspin::detail::field_numbers(number)};
        for (bool const packed : {false, true}) {
          fill(domain, spins);
          fill(domain, number);
          packed ? domain.update_ghosts_packed(fields) : domain.update_ghosts(fields);
          expect_all(domain, spins);
          expect_all(domain, number);
        }
      }
}

}  // namespace
}  // namespace cayspin::inline v0_2::mpi
