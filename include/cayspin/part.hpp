// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/lattice.hpp>

#include <cstddef>
#include <cstdint>
#include <span>

namespace cayspin::inline v0_1 {

/// The numbers of a field, without its types.
struct FieldNumbers {
  void* data = nullptr;  // component 0 of site 0
  std::size_t number_bytes = 0;
  int components = 0;
  std::ptrdiff_t row = 0, plane = 0, component = 0;  // from one to the next
  std::int64_t nx = 0, ny = 0, nz = 0;
  bool on_device = false;

  friend bool operator==(FieldNumbers const&, FieldNumbers const&) = default;
};

/// What a part of a larger lattice asks of the others. All parts ask in the same order.
class Part {
 public:
  virtual ~Part() = default;
  /// The larger lattice.
  virtual Lattice const& whole() const = 0;
  /// The larger lattice's row or plane that is number 0 of this part, ghosts included.
  virtual std::array<std::int64_t, 3> begin() const = 0;
  /// How many parts there are, and the number of this one among them.
  virtual std::size_t parts() const = 0;
  virtual std::size_t index() const = 0;
  /// Replaces words by their sums over the parts.
  virtual void sum(std::span<std::int64_t> words) const = 0;
  /// Replaces words by the largest of the parts.
  virtual void maximum(std::span<std::int64_t> words) const = 0;
  /// Brings the ghosts of fields up to date; waits. Work on the fields has finished.
  virtual void update_ghosts(std::span<FieldNumbers const> fields) const = 0;
  /// Sends bytes to each part, itself included, and takes as many as each sends; waits. In the
  /// order of the parts' numbers, in multiples of 8 bytes.
  virtual void exchange(std::span<std::span<std::byte const> const> sent,
                        std::span<std::span<std::byte> const> received) const = 0;
};

/// The lattice that this one is a part of, or itself.
inline Lattice const& whole(Lattice const& lattice) {
  return lattice.part == nullptr ? lattice : lattice.part->whole();
}

}  // namespace cayspin::inline v0_1
