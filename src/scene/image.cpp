// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "image.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <system_error>

#if defined(CAYSPIN_HAS_PNG)
#include <png.h>
#endif

namespace cayspin::inline v0_2::io::detail {
namespace {

[[noreturn]] void refuse_image(std::filesystem::path const& path, std::string_view reason) {
  throw std::runtime_error(fmt::format("{}: cannot read the image: {}", path.string(), reason));
}

#if defined(CAYSPIN_HAS_PNG)
/// State of libpng. PngFile has it as a member, so that it is freed even if PngFile's constructor
/// throws.
struct PngImage : png_image {
  PngImage() : png_image{} { version = PNG_IMAGE_VERSION; }
  PngImage(PngImage const&) = delete;
  PngImage& operator=(PngImage const&) = delete;
  ~PngImage() { png_image_free(this); }
};

/// A PNG file after its header has been read.
class PngFile {
 public:
  explicit PngFile(std::filesystem::path const& path) : path_(path) {
    std::error_code error;
    auto const status = std::filesystem::status(path, error);
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
      refuse_image(path, "it is not a regular file");
    if (png_image_begin_read_from_file(&image_, path.c_str()) == 0) refuse();
    // Deflate compresses by at most 1032 : 1, and a byte holds at most 8 pixels.
    auto const size = std::filesystem::file_size(path, error);
    if (error || pixels() / 8256 > size) refuse_image(path, "it is truncated");
  }

  Image read() {
    Image image{image_.width, image_.height, std::vector<unsigned char>(pixels())};
    image_.format = PNG_FORMAT_GRAY;
    image_.flags |= PNG_IMAGE_FLAG_16BIT_sRGB;  // reads 16 bits as sRGB, like 8 bits
    png_color const white{255, 255, 255};
    if (png_image_finish_read(&image_, &white, image.grey.data(), 0, nullptr) == 0) refuse();
    return image;
  }

 private:
  std::size_t pixels() const { return std::size_t{image_.width} * image_.height; }
  [[noreturn]] void refuse() { refuse_image(path_, std::string(image_.message)); }

  std::filesystem::path const& path_;
  PngImage image_;
};
#else
/// Build without PNG support: refuses every file.
class PngFile {
 public:
  explicit PngFile(std::filesystem::path const& path) {
    refuse_image(path, "this cayspin was built without PNG");
  }
  Image read() { return {}; }
};
#endif

std::vector<int> levels_of(Item const& item) {
  auto const each = entries(item, 1, 255, "1 to 255 grey values that increase, as in [128]");
  std::vector<int> levels;
  for (auto const& entry : each) {
    auto const level = static_cast<int>(integer(entry, {"a whole number from 1 to 255", 1, 255}));
    if (!levels.empty() && level <= levels.back())
      entry.fail(fmt::format("{} is not above {}", level, levels.back()), "levels that increase");
    levels.push_back(level);
  }
  return levels;
}

}  // namespace

void check_image(std::filesystem::path const& path) { PngFile const file(path); }

Image read_image(std::filesystem::path const& path) { return PngFile(path).read(); }

void read_image_keys(Table const& table, SiteNumbers& numbers) {
  for (auto const* const other : {"file", "regions"})
    if (auto const item = table.find(other)) item->fail("stands beside image", "one of the two");
  table.accept_only({"image", "levels"});
  numbers.image = input_file(table, "image", "the name of a PNG file");
  if (auto const levels = table.find("levels"))
    numbers.levels = levels_of(*levels);
  else if (table.item().key != "lattice.occupied")
    table.item().fail("an image needs levels",
                      "levels = [128], or several grey values: a pixel's number is how many of "
                      "them its grey value reaches");
}

std::vector<double> numbers_of_image(SiteNumbers const& numbers, Lattice const& lattice,
                                     SiteBox const& box) {
  auto const image = read_image(numbers.image);
  auto const number_of = [&](int grey) -> double {
    if (numbers.levels.empty()) return grey < 128 ? 1 : 0;
    return static_cast<double>(std::ranges::upper_bound(numbers.levels, grey) -
                               numbers.levels.begin());
  };
  auto const& [nx, ny, nz] = box.extent;
  std::vector<double> plane;
  for (auto j = box.begin[1]; j < box.begin[1] + ny; ++j)
    for (auto i = box.begin[0]; i < box.begin[0] + nx; ++i)
      plane.push_back(number_of(image.at_cell(lattice.shape, i, j)));
  std::vector<double> values;
  values.reserve(plane.size() * static_cast<std::size_t>(nz));
  for (std::int64_t k = 0; k < nz; ++k) values.insert(values.end(), plane.begin(), plane.end());
  return values;
}

}  // namespace cayspin::inline v0_2::io::detail
