// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Sums over sites on a device carry twice the digits of a double.
#include "../support/backends.hpp"

#include <cayspin/detail/exact_sum.hpp>
#include <cayspin/detail/reduce_sites.hpp>

using namespace cayspin;
using namespace cayspin::test;

namespace {

using Numbers = ScalarField<double, HostDeviceMemory>;
constexpr double infinity = std::numeric_limits<double>::infinity();

struct SumAndLargest {
  SiteArray<double, 1> numbers;
  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Value* values) const {
    values[0] = values[1] = site.load(numbers);
  }
};

std::array<double, 2> sum_and_largest(std::vector<double> const& numbers) {
  Numbers const field("numbers", Lattice::chain(static_cast<std::int64_t>(numbers.size())));
  copy_from_host(numbers, field);
  return detail::reduce_sites<detail::SumsThenMaxima<1>, 2>(
      HostDevice(), "cayspin::test::sums", field.layout(), SumAndLargest{field.array()});
}

TEST(SumsOnADevice, CancelWithoutRoundOff) {
  std::mt19937_64 engine(7);
  std::vector<double> numbers;
  double size = 0;
  detail::ExactSum exact;
  for (int i = 0; i < 20000; ++i) {
    double const large = std::ldexp(static_cast<double>(engine() >> 11), -13);
    double const small = std::ldexp(static_cast<double>(engine() >> 11), -60);
    for (double const number : {large, small, -large}) numbers.push_back(number);
  }
  std::shuffle(numbers.begin(), numbers.end(), engine);
  for (double const number : numbers) {
    exact.add(number);
    size += std::abs(number);
  }
  double const expected = exact.rounded(), n = static_cast<double>(numbers.size());
  // The result is about 80; a plain sum would be off by about 10.
  double const bound = n * n * epsilon<double> * epsilon<double> * size;
  ASSERT_LT(bound, 1e-3 * expected);
  EXPECT_NEAR(sum_and_largest(numbers)[0], expected, bound + epsilon<double> * expected);
  EXPECT_EQ(sum_and_largest(numbers)[1], *std::max_element(numbers.begin(), numbers.end()));
}

TEST(SumsOnADevice, AreTheSameInEachCall) {
  auto const numbers = random_directions(10000, 3);
  auto const once = sum_and_largest(numbers);
  for (int i = 0; i < 20; ++i) EXPECT_EQ(sum_and_largest(numbers), once);
}

TEST(SumsOnADevice, PassOnWhatIsNotFinite) {
  std::vector<double> numbers(5000, 0.5);
  numbers[17] = infinity;
  EXPECT_EQ(sum_and_largest(numbers), (std::array{infinity, infinity}));
  numbers[3000] = -infinity;
  EXPECT_TRUE(std::isnan(sum_and_largest(numbers)[0]));
  EXPECT_EQ(sum_and_largest(numbers)[1], infinity);
  numbers[4000] = std::numeric_limits<double>::quiet_NaN();
  for (double const value : sum_and_largest(numbers)) EXPECT_TRUE(std::isnan(value));
}

}  // namespace
