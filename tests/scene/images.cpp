// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Site-dependent values from the pixels of images.
#include "scene_file.hpp"

#include <cstdint>

#if defined(CAYSPIN_HAS_PNG)
#include <png.h>
#endif

namespace cayspin::inline v0_2::io::test {
namespace {

constexpr std::string_view lattice_line = "shape = [4, 3, 2]";

std::string lattice_with(std::string const& keys, std::string_view shape = lattice_line) {
  return replaced(plain_scene, lattice_line, std::string(shape) + "\n" + keys);
}

std::string exchange_of(std::string const& typed) {
  return std::string(plain_scene) + "[field]\nexchange = " + typed + "\n";
}

std::string refusal_of_image(Folder const& folder, std::string const& text) {
  return refusal([&] {
    auto const scene = read_text(folder, text);
    check_files(scene);
    if (scene.lattice.occupied.there()) occupied(scene, whole(scene));
  });
}

TEST(Images, WrongKeysAreRefusedInOneLine) {
  Folder const folder;
  for (auto const& [typed, what] :
       {std::pair{"{ image = 3 }", ".image: 3 is an integer; accepted: the name of a PNG file"},
        {"{ image = '' }", ".image: the file name is empty"},
        {"{ image = 'a.png', level = [1] }",
         ".level: unknown key, did you mean \"levels\"?; accepted: image, levels"},
        {"{ image = 'a.png', file = 'a.h5' }",
         ".file: stands beside image; accepted: one of the two"},
        {"{ image = 'a.png', regions = [0, 1] }", ".regions: stands beside image"},
        {"{ file = 'a.h5', levels = [1] }", ".levels: unknown key"},
        {"{ image = 'a.png', levels = 128 }",
         ".levels: 128 is an integer; accepted: 1 to 255 grey"},
        {"{ image = 'a.png', levels = [] }", ".levels: has 0 entries"},
        {"{ image = 'a.png', levels = [0] }",
         ".levels[0]: 0 is too small; accepted: a whole number from 1 to 255"},
        {"{ image = 'a.png', levels = [1, 256] }", ".levels[1]: 256 is too large"},
        {"{ image = 'a.png', levels = [1.5] }", ".levels[0]: 1.5 is a number"},
        {"{ image = 'a.png', levels = [9, 9] }",
         ".levels[1]: 9 is not above 9; accepted: levels that increase"}}) {
    SCOPED_TRACE(typed);
    expect_holds(refusal_of_image(folder, lattice_with("occupied = " + std::string(typed))),
                 ":6: lattice.occupied" + std::string(what));
  }
  for (auto const& text :
       {exchange_of("{ image = 'a.png' }"), lattice_with("frozen = { image = 'a.png' }")})
    expect_holds(refusal_of_image(folder, text),
                 ": an image needs levels; accepted: levels = [128], or several grey values: ");
}

#if defined(CAYSPIN_HAS_PNG)
/// Writes pixels of this format into a PNG file, with the top row first.
void write_png(std::filesystem::path const& path, std::uint32_t width,
               std::vector<std::uint8_t> const& pixels, std::uint32_t format = PNG_FORMAT_GRAY) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.format = format;
  image.width = width;
  image.height =
      static_cast<std::uint32_t>(pixels.size() / PNG_IMAGE_PIXEL_CHANNELS(format) / width);
  if (png_image_write_to_file(&image, path.c_str(), 0, pixels.data(), 0, nullptr) == 0)
    throw std::runtime_error(image.message);
}

std::vector<int> occupied_by(Folder const& folder, std::string const& keys,
                             std::string_view shape = lattice_line) {
  auto const scene = read_text(folder, lattice_with("occupied = " + keys, shape));
  check_files(scene);
  auto const there = occupied(scene, whole(scene));
  return {there.begin(), there.end()};
}

TEST(Images, HaveTheirTopRowAtTheLargestY) {
  Folder const folder;
  // The letter L, in an image of 4 x 3 pixels.
  write_png(folder / "l.png", 4, {0, 255, 255, 255, 0, 255, 255, 255, 127, 10, 0, 128});
  std::vector<int> const plane{1, 1, 1, 0, 1, 0, 0, 0, 1, 0, 0, 0};
  auto both = plane;
  both.insert(both.end(), plane.begin(), plane.end());
  EXPECT_EQ(occupied_by(folder, "{ image = 'l.png' }"), both);
  auto const scene = read_text(folder, lattice_with("occupied = { image = 'l.png' }"));
  SiteBox const part{{1, 0, 1}, {2, 2, 1}};
  EXPECT_EQ(occupied(scene, part),
            numbers_in(part, {4, 3, 2}, 1, std::vector<unsigned char>(both.begin(), both.end())));
  EXPECT_TRUE(needs_pass(scene));
}

TEST(Images, OfAnySizeCoverTheLattice) {
  Folder const folder;
  // The upper left corner is dark; the pixels are larger than cells in one image and smaller in the
  // other.
  write_png(folder / "coarse.png", 2, {0, 255, 255, 255});
  std::vector<std::uint8_t> fine(64 * 32, 255);
  for (std::size_t row = 0; row < 16; ++row)
    std::fill_n(fine.begin() + static_cast<std::ptrdiff_t>(64 * row), 32, std::uint8_t{0});
  write_png(folder / "fine.png", 64, fine);
  std::vector<int> const expected{0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0};
  for (std::string const name : {"coarse.png", "fine.png"})
    EXPECT_EQ(occupied_by(folder, "{ image = '" + name + "' }", "shape = [4, 4]"), expected)
        << name;
  // Each cell uses the pixel at its centre.
  write_png(folder / "dot.png", 5, {255, 255, 0, 255, 255});
  EXPECT_EQ(occupied_by(folder, "{ image = 'dot.png' }", "shape = [3]"),
            (std::vector<int>{0, 1, 0}));
}

TEST(Images, ColoursAreGreyOnWhite) {
  Folder const folder;
  write_png(folder / "colours.png", 4, {0, 0, 0, 0, 0, 0, 0, 255, 255, 255, 0, 255, 0, 0, 160, 255},
            PNG_FORMAT_RGBA);
  EXPECT_EQ(occupied_by(folder, "{ image = 'colours.png' }", "shape = [4]"),
            (std::vector<int>{0, 1, 0, 1}));
}

TEST(Images, GiveTheNumberOfLevelsThatAreReached) {
  Folder const folder;
  write_png(folder / "mask.png", 4, {0, 99, 100, 255, 199, 200, 201, 0, 0, 0, 0, 128});
  auto const scene = read_text(folder, exchange_of("{ image = 'mask.png', levels = [100, 200] }"));
  check_files(scene);
  auto const numbers =
      numbers_of_sites(scene, scene.field.exchange_factors, "field.exchange", whole(scene));
  std::vector<double> const plane{0, 0, 0, 1, 1, 2, 2, 0, 0, 0, 1, 2};
  EXPECT_EQ(std::vector<double>(numbers.begin(), numbers.begin() + 12), plane);
  EXPECT_EQ(std::vector<double>(numbers.begin() + 12, numbers.end()), plane);
  // With `levels`, bright pixels have a spin, and dark ones have none.
  EXPECT_EQ(occupied_by(folder, "{ image = 'mask.png', levels = [100] }", "shape = [4, 3]"),
            (std::vector<int>{0, 0, 0, 1, 1, 1, 1, 0, 0, 0, 1, 1}));
}

TEST(Images, InCrystalsAllSitesOfACellAreAlike) {
  Folder const folder;
  write_png(folder / "half.png", 2, {0, 255});
  EXPECT_EQ(occupied_by(folder, "{ image = 'half.png' }\ncrystal = 'bcc'", "shape = [2, 1, 1]"),
            (std::vector<int>{1, 0, 1, 0}));
}

TEST(Images, ConstantsOfAtomsMayBeImages) {
  Folder const folder;
  write_png(folder / "mask.png", 4, std::vector<std::uint8_t>(12, 255));
  auto const scene = read_text(folder, R"toml(units = "SI"
[material]
mu_s = { bohr_magnetons = 2 }
J = 1e-21
K = { image = "mask.png", levels = [128] }
axis = [0, 0, 1]
alpha = 0.1
damping_form = "gilbert"
[system]
kind = "llg"
[lattice]
shape = [4, 3]
spacing = 3e-10
[initial]
uniform = [0, 0, 1]
[integrator]
method = "rkmk4"
dt = 1e-15
steps = 1
)toml");
  EXPECT_FALSE(scene.field.anisotropies.at(0).factors.image.empty());
}

TEST(Images, FilesThatAreWrongAreRefusedInOneLine) {
  Folder const folder;
  write_png(folder / "white.png", 4, std::vector<std::uint8_t>(12, 255));
  std::vector<std::uint8_t> noise(100 * 100);
  for (std::size_t n = 0; n < noise.size(); ++n)
    noise[n] = static_cast<std::uint8_t>(n * n * 2654435761U >> 13U);
  write_png(folder / "short.png", 100, noise);
  std::filesystem::resize_file(folder / "short.png", 2000);
  write_png(folder / "damaged.png", 100, noise);
  {
    std::fstream file(folder / "damaged.png", std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(1000);
    file << "????";
  }
  folder.write("no picture at all", "text.png");
  // The header promises 1000000 x 1000000 pixels, but the file has none.
  folder.write(std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\x0f\x42\x40\0\x0f\x42\x40"
                           "\x08\0\0\0\0\x79\x06\x67\xa1\0\0\0\x0aIDAT",
                           41),
               "large.png");
  std::filesystem::create_directory(folder / "folder.png");
  for (auto const& [file, what] : {std::pair{"none.png", "No such file or directory"},
                                   {"text.png", "Not a PNG file"},
                                   {"folder.png", "it is not a regular file"},
                                   {"short.png", "cannot read the image: "},
                                   {"damaged.png", "cannot read the image: "},
                                   {"large.png", "it is truncated"}}) {
    SCOPED_TRACE(file);
    auto const message = refusal_of_image(
        folder, lattice_with("occupied = { image = '" + std::string(file) + "' }"));
    expect_holds(message, ":6: lattice.occupied: ");
    expect_holds(message, std::string(file) + ": cannot read the image: ");
    expect_holds(message, what);
  }
  expect_holds(refusal_of_image(folder, lattice_with("occupied = { image = 'white.png' }")),
               ": lattice.occupied: leaves no spin");
}
#else
TEST(Images, ABuildWithoutPngSaysSo) {
  Folder const folder;
  expect_holds(refusal_of_image(folder, lattice_with("occupied = { image = 'a.png' }")),
               "a.png: cannot read the image: this cayspin was built without PNG");
}
#endif

}  // namespace
}  // namespace cayspin::inline v0_2::io::test
