// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The library's wrappers around many of its terms, in double precision.
#include "compositions.hpp"

namespace cayspin::test {
namespace {

TEST(WrappersInDouble, SayWhatTheFieldAndTheEnergySay) {
  for (unsigned const seed : {1U, 2U, 3U}) expect_all_members(random_setting<double>(seed));
}
TEST(WrappersInDouble, DISABLED_OfManySettings) {
  for (unsigned seed = 4; seed < 300; ++seed) expect_all_members(random_setting<double>(seed));
}

}  // namespace
}  // namespace cayspin::test
