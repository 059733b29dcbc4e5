// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Site-dependent values from expressions and files.
#include "hdf5_file.hpp"
#include "scene_file.hpp"

#include <cstdint>
#include <limits>
#include <memory>

namespace cayspin::inline v0_2::io::test {
namespace {

std::string const plain_film = std::string(plain_scene) + "[field]\nexchange = 1\n";

// Returns the error in reading a scene, its files or its site-dependent values.
std::string refusal_in(Folder const& folder, std::string const& text) {
  return refusal([&] {
    auto const scene = read_text(folder, text);
    check_files(scene);
    if (auto const& numbers = scene.field.exchange_factors; numbers.there())
      numbers_of_sites(scene, numbers, "field.exchange", whole(scene));
  });
}

TEST(SiteNumbers, ComeFromExpressionsAndFiles) {
  Folder const folder;
  std::vector<double> stored;
  for (int n = 0; n < 24; ++n) stored.push_back(1 + n * n % 17);
  write_dataset(folder / "film.h5", "/values", {2, 3, 4}, stored);
  write_dataset(folder / "crystal.h5", "/values", {2, 2, 3, 4}, [&] {
    auto both = stored;
    for (double const value : stored) both.push_back(-value);
    return both;
  }());
  auto const expression =
      read_text(folder, replaced(plain_film, "exchange = 1", "exchange = '1+i+10*k'"));
  auto const by_expression = numbers_of_sites(expression, expression.field.exchange_factors,
                                              "field.exchange", whole(expression));
  for (std::size_t site = 0; site < 24; ++site)
    EXPECT_EQ(by_expression[site], 1. + static_cast<double>(site % 4 + 10 * (site / 12)));
  auto const file =
      read_text(folder, replaced(plain_film, "exchange = 1", "exchange = { file = 'film.h5' }"));
  check_files(file);
  EXPECT_TRUE(needs_pass(file));
  EXPECT_EQ(file.field.exchange->constant, 1);
  EXPECT_EQ(numbers_of_sites(file, file.field.exchange_factors, "field.exchange", whole(file)),
            stored);
  // In a crystal of two sites, plane 2 k + s has the sites s of the cells at k.
  auto const crystal = read_text(
      folder,
      replaced(replaced(plain_film, "shape = [4, 3, 2]", "shape = [4, 3, 2]\ncrystal = 'bcc'"),
               "exchange = 1",
               "anisotropy = { constant = { file = 'crystal.h5' }, axis = [0, 0, 1] }"));
  check_files(crystal);
  auto const& numbers = crystal.field.anisotropies.at(0).factors;
  auto const all = numbers_of_sites(crystal, numbers, "field.anisotropy", whole(crystal));
  for (std::size_t site = 0; site < 48; ++site) {
    auto const plane = site / 12;
    double const value = stored[plane / 2 * 12 + site % 12];
    EXPECT_EQ(all[site], plane % 2 == 0 ? value : -value) << site;
  }
  SiteBox const part{{1, 1, 1}, {2, 2, 3}};
  EXPECT_EQ(numbers_of_sites(crystal, numbers, "field.anisotropy", part),
            numbers_in(part, crystal.lattice.shape, 1, all));
}

TEST(SiteNumbers, SayWhereSpinsAre) {
  Folder const folder;
  std::vector<double> mask;
  for (int n = 0; n < 24; ++n) mask.push_back(n % 5 == 0 ? 0 : n % 3 - 0.5);
  write_dataset(folder / "mask.h5", "/values", {2, 3, 4}, mask);
  auto const with = [&](std::string_view keys) {
    return read_text(folder, replaced(plain_film, "shape = [4, 3, 2]",
                                      "shape = [4, 3, 2]\n" + std::string(keys)));
  };
  auto const file = with("occupied = { file = 'mask.h5' }\nfrozen = { file = 'mask.h5' }");
  check_files(file);
  EXPECT_TRUE(needs_pass(file));
  auto const there = occupied(file, whole(file));
  for (std::size_t site = 0; site < 24; ++site) EXPECT_EQ(there[site], site % 5 != 0) << site;
  EXPECT_EQ(frozen(file, whole(file)), there);

  Given given;
  given.numbers["lattice.occupied"] = std::make_shared<std::vector<double> const>(mask);
  auto const text =
      replaced(plain_film, "shape = [4, 3, 2]", "shape = [4, 3, 2]\noccupied = { given = true }");
  auto const by_program = parse_scene(text, "scene.toml", {}, given);
  SiteBox const part{{1, 0, 1}, {3, 2, 1}};
  EXPECT_EQ(occupied(by_program, whole(by_program)), there);
  EXPECT_EQ(occupied(by_program, part), numbers_in(part, {4, 3, 2}, 1, there));
  EXPECT_EQ(occupied(with_overrides(by_program, {"integrator.dt=0.02"}), part),
            occupied(by_program, part));
  auto const larger = parse_scene(text, "scene.toml", {"lattice.shape=[4, 3, 3]"}, given);
  EXPECT_THROW(occupied(larger, whole(larger)), SceneError);
  mask[23] = std::numeric_limits<double>::quiet_NaN();
  given.numbers["lattice.occupied"] = std::make_shared<std::vector<double> const>(mask);
  auto const not_a_number = parse_scene(text, "scene.toml", {}, given);
  expect_holds(refusal([&] { occupied(not_a_number, part); }),
               "lattice.occupied: a number that was given is not finite; accepted: finite numbers");
}

TEST(SiteNumbers, OfFilesMayBeIntegersOrBooleans) {
  Folder const folder;
  std::vector<double> regions;
  for (int n = 0; n < 24; ++n) regions.push_back(n % 3);
  auto const text = replaced(plain_film, "shape = [4, 3, 2]",
                             "shape = [4, 3, 2]\nregions = { file = 'numbers.h5' }");
  std::vector<std::int64_t> const expected(regions.begin(), regions.end());
  for (hid_t const type : {H5T_STD_I8LE, H5T_STD_U8LE, H5T_STD_I16BE, H5T_STD_U16LE, H5T_STD_I32LE,
                           H5T_STD_U32BE, H5T_STD_I64LE, H5T_STD_U64LE, H5T_IEEE_F32LE}) {
    write_dataset(folder / "numbers.h5", "/values", {2, 3, 4}, regions, type);
    auto const scene = read_text(folder, text);
    check_files(scene);
    EXPECT_EQ(io::regions(scene, whole(scene)), expected) << type;
  }

  hid_t const boolean = H5Tenum_create(H5T_STD_I8LE);
  std::int8_t const no = 0, yes = 1;
  H5Tenum_insert(boolean, "FALSE", &no);
  H5Tenum_insert(boolean, "TRUE", &yes);
  std::vector<std::int8_t> mask;
  for (int n = 0; n < 24; ++n) mask.push_back(n % 5 == 0 ? 0 : 1);
  write_dataset_as(folder / "mask.h5", "/values", {2, 3, 4}, mask, boolean, boolean);
  H5Tclose(boolean);
  auto const masked = read_text(folder, replaced(plain_film, "shape = [4, 3, 2]",
                                                 "shape = [4, 3, 2]\n"
                                                 "occupied = { file = 'mask.h5' }"));
  check_files(masked);
  auto const there = occupied(masked, whole(masked));
  for (std::size_t site = 0; site < 24; ++site) EXPECT_EQ(there[site], mask[site] != 0) << site;
}

TEST(SiteNumbers, IntegersOfFilesMustBeExactInDouble) {
  Folder const folder;
  auto const text = replaced(plain_film, "exchange = 1", "exchange = { file = 'long.h5' }");
  auto const numbers = [&] {
    auto const scene = read_text(folder, text);
    return numbers_of_sites(scene, scene.field.exchange_factors, "field.exchange", whole(scene));
  };
  std::vector<std::int64_t> integers(24, 0);
  integers[0] = std::numeric_limits<std::int64_t>::min();
  integers[1] = -(std::int64_t{1} << 53) - 2;
  write_dataset_as(folder / "long.h5", "/values", {2, 3, 4}, integers, H5T_NATIVE_INT64,
                   H5T_STD_I64LE);
  EXPECT_EQ(numbers()[0], -0x1p63);
  EXPECT_EQ(numbers()[1], -0x1p53 - 2);
  EXPECT_EQ(numbers()[2], 0);
  ++integers[1];
  write_dataset_as(folder / "long.h5", "/values", {2, 3, 4}, integers, H5T_NATIVE_INT64,
                   H5T_STD_I64LE);
  expect_holds(refusal_in(folder, text),
               "long.h5: cannot read dataset /values: it contains -9007199254740993; accepted: "
               "integers that double represents exactly, such as those up to 2^53");

  std::vector<std::uint64_t> positive(24, std::uint64_t{0x1fffffffffffff} << 11);
  write_dataset_as(folder / "long.h5", "/values", {2, 3, 4}, positive, H5T_NATIVE_UINT64,
                   H5T_STD_U64BE);
  EXPECT_EQ(numbers()[23], 0x1.fffffffffffffp63);
  ++positive[23];
  write_dataset_as(folder / "long.h5", "/values", {2, 3, 4}, positive, H5T_NATIVE_UINT64,
                   H5T_STD_U64BE);
  expect_holds(refusal_in(folder, text), "it contains 18446744073709549569; accepted: ");
}

TEST(SiteNumbers, ThatAreWrongAreRefusedInOneLine) {
  Folder const folder;
  write_dataset(folder / "short.h5", "/values", {3, 4}, std::vector<double>(12, 1));
  write_dataset(folder / "other.h5", "/exchange", {2, 3, 4}, std::vector<double>(24, 1));
  write_dataset(folder / "nan.h5", "/values", {2, 3, 4},
                std::vector<double>(24, std::numeric_limits<double>::quiet_NaN()));
  write_dataset_as(folder / "bits.h5", "/values", {2, 3, 4}, std::vector<std::uint8_t>(24),
                   H5T_STD_B8LE, H5T_STD_B8LE);
  for (auto const& [typed, what] :
       {std::pair{"exchange = '1 +'", ": field.exchange: "},
        {"exchange = 'q'", ": field.exchange: "},
        {"exchange = '1/i'", ": field.exchange: expression \"1/i\" is not finite at x = "},
        {"exchange = true",
         ": field.exchange: true is a boolean; accepted: a finite number, an expression in x"},
        {"exchange = { fil = 'a.h5' }", ": field.exchange.fil: unknown key"},
        {"exchange = {}", ": field.exchange: has 0 keys; accepted: an expression in x, y, z, i"},
        {"exchange = { given = true }",
         ":13: field.exchange.given: stands for numbers that a program gives, and none did"},
        {"exchange = { given = false }",
         ": field.exchange.given: false has no meaning; accepted: file"},
        {"exchange = { file = 3 }", ": field.exchange.file: 3 is an integer"},
        {"exchange = { file = 'none.h5' }", "none.h5"},
        {"exchange = { file = 'short.h5' }", "its extents are (3, 4); accepted: (2, 3, 4)"},
        {"exchange = { file = 'other.h5' }", "/values"},
        {"exchange = { file = 'bits.h5' }",
         "its type is not one of numbers; accepted: float, double, integers of up to 64 bits, "
         "booleans of h5py"},
        {"exchange = { file = 'nan.h5' }", "a value is not finite; accepted: finite numbers"},
        {"dmi = { bulk = 'z+' }", ": field.dmi.bulk: "},
        {"dmi = { interfacial = 'x' }", ": field.dmi.normal: is missing"},
        {"anisotropy = { constant = 'y*', axis = [0, 0, 1] }", ": field.anisotropy.constant: "}}) {
    SCOPED_TRACE(typed);
    expect_holds(refusal_in(folder, replaced(plain_film, "exchange = 1", typed)), what);
  }
  for (auto const& [typed, what] :
       {std::pair{"{ file = 'short.h5' }", "its extents are (3, 4); accepted: (2, 3, 4)"},
        {"1",
         ":6: lattice.occupied: 1 is an integer; accepted: an expression in x, y, z, i, j, k, "
         "{ file = \"NAME.h5\" }, { image = \"NAME.png\" } or { regions = [v0, v1, ..] }"}}) {
    expect_holds(
        refusal_in(folder, replaced(plain_film, "shape = [4, 3, 2]",
                                    "shape = [4, 3, 2]\noccupied = " + std::string(typed))),
        what);
  }
  expect_holds(refusal_in(folder, replaced(plain_film, "damping = 0.1", "damping = 'x/'")),
               ": system.damping: ");
}

// Noise turns the smallest moment most.
TEST(SiteNumbers, ATemperatureIsHeldAgainstTheLeastMoment) {
  Folder const folder;
  auto const hot = [&](std::string const& moments) {
    return refusal_in(folder,
                      replaced(plain_film, "shape = [4, 3, 2]", "shape = [4, 3, 2]\n" + moments) +
                          "[thermal]\ntemperature = 1\n");
  };
  EXPECT_EQ(hot("moments = 0.01").find(": integrator.dt:"), std::string::npos);
  EXPECT_NE(hot("moments = 0.0001").find("times gyromagnetic ratio over moment, is 10"),
            std::string::npos);
}

TEST(SiteNumbers, SitesWithoutASpinHaveNoNoise) {
  Folder const folder;
  auto const scene =
      read_text(folder, replaced(plain_scene, "shape = [4, 3, 2]",
                                 "shape = [4, 3, 2]\ncrystal = 'kagome'\nmoments = [4, 0, 5]\n"
                                 "gyromagnetic = [2, 3, 1]"));
  EXPECT_EQ(noise_of_cell_sites(scene), (std::vector{0.5, 0.0, 0.2}));
  EXPECT_EQ(largest_noise(scene), 0.5);
}

}  // namespace
}  // namespace cayspin::inline v0_2::io::test
