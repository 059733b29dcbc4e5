// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/lattice.hpp>

#include <cstddef>
#include <cstdint>
#include <span>

namespace cayspin::inline v0_2 {

/// Type-erased pointer and strides of a field.
struct FieldNumbers {
  void* data = nullptr;  // component 0 of site 0
  std::size_t number_bytes = 0;
  int components = 0;
  std::ptrdiff_t row = 0, plane = 0, component = 0;  // strides in elements
  std::int64_t nx = 0, ny = 0, nz = 0;
  bool on_device = false;

  friend bool operator==(FieldNumbers const&, FieldNumbers const&) = default;
};

/// Communication of a part of a larger lattice with the other parts. All parts must make the same
/// calls in the same order.
class Part {
 public:
  virtual ~Part() = default;
  /// Returns the larger lattice.
  virtual Lattice const& whole() const = 0;
  /// Returns, for each axis, the index in the larger lattice of the first row or plane of this
  /// part, ghosts included; negative where ghosts wrap around.
  virtual std::array<std::int64_t, 3> begin() const = 0;
  /// Return the number of parts, and the index of this one.
  virtual std::size_t parts() const = 0;
  virtual std::size_t index() const = 0;
  /// Replaces each word by its sum over the parts.
  virtual void sum(std::span<std::int64_t> words) const = 0;
  /// Replaces each word by its maximum over the parts.
  virtual void maximum(std::span<std::int64_t> words) const = 0;
  /// Updates the ghosts of fields; waits. Work on the fields must have finished before the call.
  virtual void update_ghosts(std::span<FieldNumbers const> fields) const = 0;
  /// Sends sent[i] to each part i, also to this one, and receives in received[i] what part i sends.
  /// Waits. Sender and receiver must give equal sizes, in multiples of 8 bytes.
  virtual void exchange(std::span<std::span<std::byte const> const> sent,
                        std::span<std::span<std::byte> const> received) const = 0;
};

/// Returns the lattice that `lattice` is a part of; if it is whole, returns `lattice` itself.
inline Lattice const& whole(Lattice const& lattice) {
  return lattice.part == nullptr ? lattice : lattice.part->whole();
}

}  // namespace cayspin::inline v0_2
