// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "ovf_header.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <charconv>
#include <clocale>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <stdexcept>

namespace cayspin::inline v0_2::io {
namespace {

static_assert(std::endian::native == std::endian::little);

namespace fs = std::filesystem;

std::ifstream open(fs::path const& path) {
  std::error_code ignored;
  auto const status = fs::status(path, ignored);
  auto const fail = [&](std::string const& reason) {
    throw std::runtime_error(fmt::format("{}: cannot open the file: {}", path.string(), reason));
  };
  if (fs::exists(status) && !fs::is_regular_file(status)) fail("it is not a regular file");
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  if (!stream) fail(errno == 0 ? "it cannot be read" : std::strerror(errno));
  return stream;
}

std::uint64_t bytes_left(std::istream& stream) {
  auto const here = stream.tellg();
  stream.seekg(0, std::ios::end);
  auto const end = stream.tellg();
  stream.seekg(here);
  return static_cast<std::uint64_t>(end - here);
}

void require_components(OvfHeader const& header, fs::path const& path, std::int64_t components) {
  if (header.components == components) return;
  if (header.version == 1)
    refuse_ovf(path, "OVF 1.0 has three values in a node; accepted: OVF 2.0 with valuedim 1");
  refuse_ovf(path, fmt::format("valuedim is \"{}\"; accepted: {}", header.components, components));
}

/// Reader of the values that follow the header.
class OvfValues {
 public:
  OvfValues(std::istream& stream, fs::path const& path, OvfHeader const& header)
      : stream_(stream), path_(path), header_(header) {}

  std::vector<double> read() {
    require_room();
    switch (header_.format) {
      case OvfFormat::text:
        read_text();
        break;
      case OvfFormat::binary4:
        read_binary(check_value_4);
        break;
      default:
        read_binary(check_value_8);
    }
    require_one_segment();
    if (header_.multiplier != 1)
      for (double& value : values_) value *= header_.multiplier;
    return std::move(values_);
  }

 private:
  /// Checks that the file is large enough before memory for its nodes is allocated.
  void require_room() {
    auto const left = bytes_left(stream_);
    auto const components = static_cast<std::uint64_t>(header_.components);
    auto const least = header_.format == OvfFormat::binary8   ? sizeof(double)
                       : header_.format == OvfFormat::binary4 ? sizeof(float)
                                                              : sizeof "0";
    auto room = (left + 1) / (components * least);
    for (auto const count : header_.field.mesh.nodes) {
      auto const nodes = static_cast<std::uint64_t>(count);
      if (nodes > room) truncated();
      room /= nodes;
    }
    auto const& [nx, ny, nz] = header_.field.mesh.nodes;
    count_ = components * static_cast<std::size_t>(nx * ny * nz);
    values_.reserve(count_);
  }

  template <class Real>
  void read_binary(Real check) {
    Real first{};
    read_block(&first, 1);
    if (first != check)
      refuse_ovf(path_, fmt::format("its check value is {:.9g}; accepted: {:.15g}, {} endian",
                                    static_cast<double>(first), static_cast<double>(check),
                                    header_.version == 1 ? "big" : "little"));
    std::vector<Real> block(std::min<std::size_t>(count_, 65536));
    while (values_.size() < count_) {
      auto const size = std::min(block.size(), count_ - values_.size());
      read_block(block.data(), size);
      values_.insert(values_.end(), block.begin(),
                     block.begin() + static_cast<std::ptrdiff_t>(size));
    }
    std::string line;
    while (std::getline(stream_, line) && squeezed(line).empty()) continue;
    if (!is_end(line))
      refuse_ovf(path_, fmt::format("its values do not end with # End: Data {}",
                                    representation(header_.format)));
  }

  template <class Real>
  void read_block(Real* values, std::size_t count) {
    auto const bytes = static_cast<std::streamsize>(count * sizeof(Real));
    stream_.read(reinterpret_cast<char*>(values), bytes);
    if (stream_.gcount() != bytes) truncated();
    if (header_.version == 1) std::for_each_n(values, count, reverse_bytes<Real>);
  }

  template <class Real>
  static void reverse_bytes(Real& value) {
    auto bytes = std::bit_cast<std::array<char, sizeof(Real)>>(value);
    std::ranges::reverse(bytes);
    value = std::bit_cast<Real>(bytes);
  }

  void read_text() {
    for (std::string line; std::getline(stream_, line);) {
      if (is_end(line)) {
        if (values_.size() < count_) truncated();
        return;
      }
      read_numbers(without_comment(line));
    }
    truncated();
  }

  static bool is_blank(char c) {
    return std::string_view(" \t\r\v\f").find(c) != std::string::npos;
  }

  /// A comment starts with ##, or with # at the start of the line or after a blank: 1.#QNAN is not
  /// a comment.
  static std::string_view without_comment(std::string_view line) {
    for (auto at = line.find('#'); at != line.npos; at = line.find('#', at + 1))
      if (at == 0 || is_blank(line[at - 1]) || line.substr(at).starts_with("##"))
        return line.substr(0, at);
    return line;
  }

  /// Returns 0 or an infinity for a number that a double cannot hold. Expects a decimal point in
  /// any locale.
  static double limit(char const* number) {
    static auto const classic = ::newlocale(LC_ALL_MASK, "C", nullptr);
    return ::strtod_l(number, nullptr, classic);
  }

  void read_numbers(std::string_view line) {
    auto const* begin = line.data();
    auto const* const end = begin + line.size();
    while (true) {
      while (begin != end && is_blank(*begin)) ++begin;
      if (begin == end) return;
      if (values_.size() == count_)
        refuse_ovf(path_, fmt::format("it has more values than its {} nodes",
                                      count_ / static_cast<std::size_t>(header_.components)));
      double value = 0;
      auto const [stop, error] = std::from_chars(begin + (*begin == '+' ? 1 : 0), end, value);
      bool const whole = stop == end || is_blank(*stop);
      if (error == std::errc::invalid_argument || !whole)
        refuse_ovf(path_, fmt::format("value {} is \"{}\"; accepted: a number", values_.size(),
                                      std::string_view(begin, end).substr(0, 40)));
      values_.push_back(error == std::errc() ? value : limit(begin));
      begin = stop;
    }
  }

  /// Throws unless only comments and the end of the segment follow the values.
  void require_one_segment() {
    for (std::string text; std::getline(stream_, text);) {
      auto const line = split_line(text);
      if (line.label == "begin")
        refuse_ovf(path_,
                   fmt::format("it goes on with \"{}\" after its values; accepted: one segment",
                               text.substr(0, 40)));
      if (!squeezed(without_comment(text)).empty())
        refuse_ovf(path_, fmt::format("it goes on with \"{}\" after its values; accepted: "
                                      "# End: Segment",
                                      text.substr(0, 40)));
    }
  }

  bool is_end(std::string const& text) const {
    auto const line = split_line(text);
    return line.label == "end" &&
           squeezed(line.value) == "data" + squeezed(representation(header_.format));
  }

  [[noreturn]] void truncated() const {
    auto const& [nx, ny, nz] = header_.field.mesh.nodes;
    refuse_ovf(path_, fmt::format("it is truncated: its header says {} x {} x {} nodes of {}", nx,
                                  ny, nz, header_.components == 1 ? "one value" : "three values"));
  }

  std::istream& stream_;
  fs::path const& path_;
  OvfHeader const& header_;
  std::size_t count_ = 0;
  std::vector<double> values_;
};

}  // namespace

bool is_ovf(fs::path const& path) {
  auto const extension = squeezed(path.extension().string());
  for (auto const* const known : {".ovf", ".omf", ".ohf", ".oef"})
    if (extension == known) return true;
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) return false;
  std::ifstream stream(path, std::ios::binary);
  std::string begin(16, '\0');
  stream.read(begin.data(), static_cast<std::streamsize>(begin.size()));
  return squeezed(begin).starts_with("#oommf");
}

OvfMesh read_ovf_mesh(fs::path const& path, std::int64_t components) {
  auto stream = open(path);
  auto const header = read_header(stream, path);
  require_components(header, path, components);
  return header.field.mesh;
}

std::int64_t ovf_components(fs::path const& path) {
  auto stream = open(path);
  return read_header(stream, path).components;
}

OvfField read_ovf(fs::path const& path, std::int64_t components) {
  auto stream = open(path);
  auto header = read_header(stream, path);
  require_components(header, path, components);
  header.field.values = OvfValues(stream, path, header).read();
  return std::move(header.field);
}

}  // namespace cayspin::inline v0_2::io
