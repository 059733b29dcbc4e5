// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// test_extremes --write: writes the page that the tests compare with.
#include "page.hpp"
#include "simulation/kokkos_settings.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iostream>
#include <string_view>

namespace {

int write_page() {
  using namespace cayspin::extremes;
  auto const text = page_of_tables() + table_of_longest_runs().to_markdown();
  std::ofstream file(CAYSPIN_PAGE);
  file << text << std::flush;
  std::cout << CAYSPIN_PAGE << (file ? ": written\n" : ": cannot be written\n");
  return file ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace

int main(int argc, char** argv) {
  using namespace cayspin::simulation;
  testing::InitGoogleTest(&argc, argv);
  KokkosSession const kokkos(space_name<Kokkos::DefaultHostExecutionSpace>(), 1, {});
  if (argc == 2 && std::string_view(argv[1]) == "--write") return write_page();
  return RUN_ALL_TESTS();
}
