// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/execution.hpp>
#include <cayspin/lattice.hpp>
#include <cayspin/part.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace cayspin::inline v0_2::detail {

/// The parts of a lattice; a whole lattice is a single part.
class Parts {
 public:
  explicit Parts(Lattice const& lattice) : part_(lattice.part) {}

  std::size_t count() const { return part_ == nullptr ? 1 : part_->parts(); }
  std::size_t index() const { return part_ == nullptr ? 0 : part_->index(); }

  /// Returns where the share of part `of` begins when `total` is divided among the parts as evenly
  /// as possible.
  std::int64_t begin_of_share(std::int64_t total, std::size_t of) const {
    return total * static_cast<std::int64_t>(of) / static_cast<std::int64_t>(count());
  }
  std::int64_t share(std::int64_t total, std::size_t of) const {
    return begin_of_share(total, of + 1) - begin_of_share(total, of);
  }

  /// Blocks of numbers, one for each part: block i is begins[i] .. begins[i + 1] - 1.
  template <class Number>
  struct Blocks {
    Number* data;
    std::vector<std::size_t> begins;
  };
  template <class Number>
  void exchange(Blocks<Number> const& sent, Blocks<Number> const& received) const {
    std::vector<std::span<std::byte const>> to;
    std::vector<std::span<std::byte>> from;
    for (std::size_t part = 0; part < count(); ++part) {
      to.push_back(bytes_of(sent, part));
      from.push_back(bytes_of(received, part));
    }
    part_->exchange(to, from);
  }

 private:
  template <class Number>
  static std::span<std::byte> bytes_of(Blocks<Number> const& blocks, std::size_t part) {
    std::size_t const begin = blocks.begins[part], end = blocks.begins[part + 1];
    return std::as_writable_bytes(std::span(blocks.data + begin, end - begin));
  }

  Part const* part_;
};

/// A part's rows along x: where the first one is in the whole lattice, and how many there are along
/// y and z.
struct RowsOfPart {
  std::int64_t y, z, ny, nz;

  std::int64_t count() const { return ny * nz; }
};

/// Returns the rows of this part, without ghosts.
inline RowsOfPart own_rows(Lattice const& lattice) {
  RowsOfPart rows{0, 0, lattice.own(1), lattice.own(2)};
  if (lattice.part == nullptr) return rows;
  auto const begin = lattice.part->begin();
  rows.y = begin[1] + lattice.ghosts[1].before;
  rows.z = begin[2] + lattice.ghosts[2].before;
  return rows;
}

/// Returns the rows of each part. Collective.
inline std::vector<RowsOfPart> rows_of_parts(Lattice const& lattice) {
  Parts const parts(lattice);
  std::vector<RowsOfPart> own(parts.count(), own_rows(lattice)), all = own;
  std::vector<std::size_t> one_each(parts.count() + 1);
  std::iota(one_each.begin(), one_each.end(), std::size_t{0});
  if (parts.count() > 1) parts.exchange<RowsOfPart>({own.data(), one_each}, {all.data(), one_each});
  return all;
}

/// A spectrum of lines, distributed over the parts of a lattice. A part holds all wave numbers of
/// its own lines, and a share of the wave numbers of all lines. If there is only one part, both
/// share the same memory.
template <class Number>
class SpectrumOfParts {
 public:
  /// `lines`: the number of lines of each part.
  SpectrumOfParts(std::string const& label, Parts const& parts, std::int64_t waves,
                  std::vector<std::int64_t> const& lines)
      : parts_(parts),
        own_lines_(std::size_t(lines[parts.index()])),
        own_waves_(std::size_t(parts.share(waves, parts.index()))) {
    for (std::size_t part = 0; part < parts.count(); ++part) {
      lines_.push_back(std::size_t(lines[part]));
      for_lines_.push_back(std::size_t(parts.begin_of_share(waves, part)) * own_lines_);
      for_waves_.push_back(part == 0 ? 0 : for_waves_.back() + own_waves_ * lines_[part - 1]);
    }
    for_lines_.push_back(std::size_t(waves) * own_lines_);
    for_waves_.push_back(for_waves_.back() + own_waves_ * lines_.back());
    of_lines_ = Memory(label, for_lines_.back());
    of_waves_ = parts.count() == 1 ? of_lines_ : Memory(label, for_waves_.back());
  }

  static std::int64_t numbers(Parts const& parts, std::int64_t waves, std::int64_t own_lines,
                              std::int64_t all_lines) {
    if (parts.count() == 1) return waves * all_lines;
    return waves * own_lines + parts.share(waves, parts.index()) * all_lines;
  }

  /// Returns the number of wave numbers in this part's share.
  std::int64_t own_waves() const { return static_cast<std::int64_t>(own_waves_); }

  /// Returns the values of this part's lines at wave number `wave`.
  Number* of_own_lines(std::int64_t wave) const {
    return of_lines_.data() + static_cast<std::size_t>(wave) * own_lines_;
  }
  /// Returns the values of the lines of `part` at wave number `wave`, counted from the first wave
  /// number of this part's share.
  Number* of_own_wave(std::int64_t wave, std::size_t part) const {
    return of_waves_.data() + for_waves_[part] + static_cast<std::size_t>(wave) * lines_[part];
  }

  /// Sends the values of this part's lines to the parts whose shares contain the wave numbers.
  /// Before the call, write the values that of_own_lines() points to, for every wave number.
  void lines_to_waves() const {
    if (parts_.count() > 1) parts_.exchange<Number>(of_lines(), of_waves());
  }
  /// Sends the values at this part's wave numbers back to the parts that hold the lines. Before the
  /// call, write the values that of_own_wave() points to, for every wave number and part.
  void waves_to_lines() const {
    if (parts_.count() > 1) parts_.exchange<Number>(of_waves(), of_lines());
  }

 private:
  using Memory = Kokkos::View<Number*, Kokkos::HostSpace>;

  Parts::Blocks<Number> of_lines() const { return {of_lines_.data(), for_lines_}; }
  Parts::Blocks<Number> of_waves() const { return {of_waves_.data(), for_waves_}; }

  Parts parts_;
  std::size_t own_lines_, own_waves_;
  std::vector<std::size_t> lines_;                  // number on each part
  std::vector<std::size_t> for_lines_, for_waves_;  // where each part's block begins
  Memory of_lines_, of_waves_;                      // orders: (wave, line) and (part, wave, line)
};

}  // namespace cayspin::inline v0_2::detail
