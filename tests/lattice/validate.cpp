// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "../support/wrong_call.hpp"

#include <cayspin/crystal.hpp>
#include <cayspin/lattice.hpp>
#include <cayspin/part.hpp>
#include <cayspin/spin_field.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>

namespace cayspin::test {
namespace {

std::string refusal_of(Lattice const& lattice) {
  return refusal([&] { lattice.validate(); });
}

TEST(LatticeValidate, NamesWhatIsWrong) {
  std::string const head = "cayspin::Lattice: the ";
  EXPECT_EQ(refusal_of(Lattice::cubic(0, 1, 1)),
            head + "extent along x is 0; it must be 1 .. 536870911");
  EXPECT_EQ(refusal_of(Lattice::cubic(1, -3, 1)),
            head + "extent along y is -3; it must be 1 .. 536870911");
  EXPECT_EQ(refusal_of(Lattice::cubic(1, 1, 536870912)),
            head + "extent along z is 536870912; it must be 1 .. 536870911");
  EXPECT_EQ(refusal_of(Lattice::cubic(536870911, 1, 1)), "taken");
  EXPECT_EQ(refusal_of(Lattice::cubic(200000, 200000, 200000)),
            "cayspin::Lattice: more than 1e15 sites");
  for (int axis = 0; axis < 3; ++axis)
    for (double const spacing : {0.0, -1.0, std::numeric_limits<double>::infinity(),
                                 std::numeric_limits<double>::quiet_NaN()}) {
      Lattice lattice = Lattice::cubic(2, 2, 2);
      lattice.spacing[axis] = spacing;
      EXPECT_EQ(refusal_of(lattice),
                head + "spacing along " + "xyz"[axis] + " must be positive and finite")
          << spacing;
    }
}

// Planes along z belong to the sites of a cell in turn.
TEST(LatticeValidate, CellsAreWhole) {
  auto const of_cell = [](std::int64_t planes, std::int64_t cell_sites) {
    Lattice lattice = Lattice::cubic(2, 2, planes);
    lattice.cell_sites = cell_sites;
    return refusal_of(lattice);
  };
  EXPECT_EQ(of_cell(6, 3), "taken");
  EXPECT_EQ(of_cell(6, 4),
            "cayspin::Lattice: the extent along z is 6; it must be a multiple of the 4 sites of a "
            "cell");
  for (std::int64_t const sites : {0, -1, -3})
    EXPECT_EQ(of_cell(6, sites), "cayspin::Lattice: a cell has " + std::to_string(sites) +
                                     " sites; it must have at least 1");
}

TEST(LatticeValidate, EqualWhenEveryAxisIs) {
  EXPECT_EQ(Lattice::chain(3, 0.5), Lattice::chain(3, 0.5));
  EXPECT_NE(Lattice::chain(3, 0.5), Lattice::chain(3, 0.25));
  EXPECT_NE(Lattice::chain(3), Lattice::chain(3, 1, Boundary::periodic));
  EXPECT_NE(Lattice::chain(3), Lattice::square(3, 2));
}

TEST(RequireLattice, SaysWhatDiffers) {
  auto const difference = [](Lattice const& lattice) {
    return refusal([&] { require_lattice("x", Lattice::cubic(2, 3, 4), lattice); });
  };
  EXPECT_EQ(difference(Lattice::cubic(2, 3, 4)), "taken");
  EXPECT_EQ(difference(Lattice::cubic(2, 4, 3)),
            "x: made for a lattice of 2 x 3 x 4 sites, and the spins are on 2 x 4 x 3");
  EXPECT_EQ(difference(Lattice::cubic(2, 3, 4, 0.5)),
            "x: made for a lattice of other spacings or boundaries than that of the spins");
  EXPECT_EQ(difference(Crystal::bcc().lattice({2, 3, 2})),
            "x: made for a lattice with another number of sites in a cell than that of the spins");
}

// A part on a single rank has the extents, spacings and boundaries of the whole lattice.
TEST(RequireLattice, TellsAPartFromTheWhole) {
  class Alone final : public Part {
   public:
    Lattice const& whole() const override { return whole_; }
    std::array<std::int64_t, 3> begin() const override { return {0, 0, 0}; }
    std::size_t parts() const override { return 1; }
    std::size_t index() const override { return 0; }
    void sum(std::span<std::int64_t>) const override {}
    void maximum(std::span<std::int64_t>) const override {}
    void update_ghosts(std::span<FieldNumbers const>) const override {}
    void exchange(std::span<std::span<std::byte const> const>,
                  std::span<std::span<std::byte> const>) const override {}

   private:
    Lattice whole_ = Lattice::cubic(2, 3, 4);
  };
  Alone const alone;
  Lattice part = alone.whole();
  part.part = &alone;
  std::string const sentence =
      "x: made for a lattice of another mpi::Domain than that of the spins, or of none; accepted: "
      "the lattice of the spins";
  EXPECT_EQ(refusal([&] { require_lattice("x", alone.whole(), part); }), sentence);
  EXPECT_EQ(refusal([&] { require_lattice("x", part, part); }), "taken");
}

}  // namespace
}  // namespace cayspin::test
