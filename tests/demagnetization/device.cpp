// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Compares the demagnetising field as devices compute it with that of the host. This runs on host
// spaces, too, where FFTW replaces the device's transforms.
#include "films.hpp"

#include <gtest/gtest.h>

namespace cayspin::test {
namespace {

DemagnetizationOptions options_of(Film const& film) {
  return {.strength = 2, .periodic_images = film.images};
}

std::vector<double> on_host(Film const& film, std::vector<double> const& directions) {
  return numbers_of(field_on_host<double>(film.lattice(), directions, options_of(film)));
}

template <class Real>
void expect_near(std::vector<double> const& found, std::vector<double> const& expected,
                 Film const& film) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i)
    ASSERT_NEAR(found[i], expected[i], 80 * epsilon<Real>)
        << i << " of " << film.shape[0] << " " << film.shape[1] << " " << film.shape[2];
}

template <class Backend>
class DemagnetizingFieldOnDevices : public ::testing::Test {};
TYPED_TEST_SUITE(DemagnetizingFieldOnDevices, Backends, BackendName);

// The memory suffices for all wave numbers along x at once, for two at a time, or for one at a
// time.
TYPED_TEST(DemagnetizingFieldOnDevices, IsThatOfTheHost) {
  using Real = typename TypeParam::Real;
  using Exec = typename TypeParam::Exec;
  auto all = films;
  all.push_back({{33, 30, 1}, {}, {1, 1.3, 0.4}});
  for (auto const& film : all) {
    auto const lattice = film.lattice();
    auto const directions = random_directions(lattice.sites(), 3);
    auto const expected = on_host(film, directions);
    auto const spins = spins_of<typename TypeParam::Spins>(lattice, directions);
    typename TypeParam::Spins const field("field", lattice);
    detail::InteractionsOfCells const interactions(lattice, options_of(film));
    std::int64_t const plane = 6 * interactions.period()[1] * interactions.period()[2] *
                               static_cast<std::int64_t>(sizeof(Real));
    for (std::int64_t const bytes : {std::int64_t(32) << 20, 2 * plane, std::int64_t(0)}) {
      detail::DeviceConvolution<Real, Exec> const convolution(lattice, interactions, bytes);
      // The second call uses work memory left by the first one.
      for (int again = 0; again < 2; ++again) convolution(Exec(), spins, field);
      expect_near<Real>(numbers_of(field), expected, film);
    }
  }
}

// This code works for hosts and for devices; on a device, no spins are copied to the host.
TYPED_TEST(DemagnetizingFieldOnDevices, IsATerm) {
  Film const& film = films.front();
  auto const directions = random_directions(film.lattice().sites(), 3);
  auto const expected = on_host(film, directions);
  auto const spins = spins_of<typename TypeParam::Spins>(film.lattice(), directions);
  HostField const term(spins, DemagnetizingField(spins, options_of(film)));
  typename TypeParam::Spins const field("field", film.lattice());
  evaluate_field(typename TypeParam::Exec(), term, spins, 0, field);
  expect_near<typename TypeParam::Real>(numbers_of(field), expected, film);
}

}  // namespace
}  // namespace cayspin::test
