// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Tests that the cache file of a demagnetising field's tensors is read again, and that damage to
// the file is detected.
#include "simulation/interactions_file.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace cayspin::simulation {
namespace {

namespace fs = std::filesystem;

class InteractionsFiles : public ::testing::Test {
 protected:
  fs::path folder = fs::temp_directory_path() / ("cayspin_tensors" + std::to_string(::getpid()));
  fs::path path = folder / "film.demag";
  DemagnetizingTensors computed{{1, 2, 3, 4, 5, 6}, {0.1, -0.2, 0.3, 1e-300, 0, -7}};
  int computations = 0;

  void SetUp() override { fs::create_directory(folder); }
  void TearDown() override { fs::remove_all(folder); }

  DemagnetizingTensors of(std::string const& what, double least_seconds = 0) {
    return InteractionsFile(path, what)
        .read_or(
            [&] {
              ++computations;
              return computed;
            },
            least_seconds);
  }
  std::string text() const {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  void write(std::string const& text) const { std::ofstream(path, std::ios::binary) << text; }

  static void expect_equal(DemagnetizingTensors const& found,
                           DemagnetizingTensors const& expected) {
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_EQ(found[i].xx, expected[i].xx);
      EXPECT_EQ(found[i].yy, expected[i].yy);
      EXPECT_EQ(found[i].zz, expected[i].zz);
      EXPECT_EQ(found[i].xy, expected[i].xy);
      EXPECT_EQ(found[i].xz, expected[i].xz);
      EXPECT_EQ(found[i].yz, expected[i].yz);
    }
  }
};

TEST_F(InteractionsFiles, AreReadAgain) {
  expect_equal(of("cells 2"), computed);
  expect_equal(of("cells 2"), computed);
  EXPECT_EQ(computations, 1);
  for (auto const& entry : fs::directory_iterator(folder)) EXPECT_EQ(entry.path(), path);
}

TEST_F(InteractionsFiles, AreOfTheirCells) {
  of("cells 2");
  auto const before = computed;
  computed = {{9, 9, 9, 9, 9, 9}};
  expect_equal(of("cells 3"), computed);
  expect_equal(of("cells 3"), computed);
  EXPECT_EQ(computations, 2);
}

TEST_F(InteractionsFiles, AreNotWrittenWhereTheyWereSoonFound) {
  of("cells 2", 1e9);
  EXPECT_FALSE(fs::exists(path));
}

// Damages each byte in turn, and cuts the file off before each byte.
TEST_F(InteractionsFiles, AreComputedAgainWhereDamaged) {
  of("cells 2");
  auto const whole = text();
  int expected = computations;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    auto damaged = whole;
    damaged[i] ^= 0x10;
    write(damaged);
    expect_equal(of("cells 2"), computed);
    EXPECT_EQ(computations, ++expected) << "byte " << i;
    EXPECT_EQ(text(), whole);
    write(whole.substr(0, i));
    expect_equal(of("cells 2"), computed);
    EXPECT_EQ(computations, ++expected) << "first " << i;
  }
}

TEST_F(InteractionsFiles, DoWithoutAFolderToWriteTo) {
  path = folder / "nowhere" / "film.demag";
  expect_equal(of("cells 2"), computed);
  EXPECT_FALSE(fs::exists(path.parent_path()));
}

}  // namespace
}  // namespace cayspin::simulation
