// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/execution.hpp>
#include <cayspin/mpi/detail/messages_in_place.hpp>
#include <cayspin/mpi/detail/wait_for.hpp>
#include <cayspin/part.hpp>

#include <mpi.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <stdexcept>
#include <vector>

namespace cayspin::inline v0_2::mpi::detail {

/// Functor that copies a box of a field to consecutive numbers, or back. A task is one row of one
/// component.
template <class Word, bool Packs>
struct CopyRows {
  Word* field;
  Word* buffer;
  std::ptrdiff_t row, plane, component;
  Box box;

  KOKKOS_FUNCTION void operator()(std::int64_t task) const {
    std::int64_t const rows = box.extent(1) * box.extent(2), in_component = task % rows;
    std::int64_t const y = box.begin[1] + in_component % box.extent(1);
    std::int64_t const z = box.begin[2] + in_component / box.extent(1);
    std::int64_t const nx = box.extent(0);
    Word* const here = field + task / rows * component + z * plane + y * row + box.begin[0];
    Word* const there = buffer + task * nx;
    for (std::int64_t x = 0; x < nx; ++x) {
      if constexpr (Packs)
        there[x] = here[x];
      else
        here[x] = there[x];
    }
  }
};

/// Messages to and from the two neighbours along an axis, with one box of every field in each
/// direction. If a periodic axis has only two ranks, they are neighbours on both sides, so the tag
/// tells the direction.
class GhostMessages {
 public:
  void exchange(MPI_Comm comm, std::span<FieldNumbers const> fields, Faces const& faces,
                std::array<int, 2> const& neighbor) {
    bool on_device = false;
    for (auto const& field : fields) on_device = on_device || field.on_device;
    on_device ? exchange_packed(comm, fields, faces, neighbor)
              : exchange_in_place(comm, fields, faces, neighbor);
  }

  /// Exchanges fields in host memory. Steppers pass the same few fields again and again, so the
  /// messages for up to eight lists of fields are kept.
  void exchange_in_place(MPI_Comm comm, std::span<FieldNumbers const> fields, Faces const& faces,
                         std::array<int, 2> const& neighbor) {
    constexpr std::size_t most = 8;
    auto found = std::ranges::find_if(
        in_place_, [&](MessagesInPlace const& messages) { return messages.are_of(fields); });
    if (found == in_place_.end()) {
      if (in_place_.size() == most) in_place_.clear();
      found = in_place_.emplace(in_place_.end(), comm, fields, faces, neighbor);
    }
    found->exchange();
  }

  /// Exchanges through buffers, for fields that Kokkos' default execution space can access.
  void exchange_packed(MPI_Comm comm, std::span<FieldNumbers const> fields, Faces const& faces,
                       std::array<int, 2> const& neighbor) {
    std::array<MPI_Request, 4> requests;
    requests.fill(MPI_REQUEST_NULL);
    std::array<int, 2> received_words{}, sent_words{};
    // All that can fail comes before the first message: after an error, no message may be under
    // way.
    for (std::size_t side = 0; side < 2; ++side) {
      if (neighbor[side] == MPI_PROC_NULL) continue;
      auto const in = bytes(fields, faces.received[side]), out = bytes(fields, faces.sent[side]);
      received_words[side] = words_of(in);
      sent_words[side] = words_of(out);
      reserve(received_[side], in);
      reserve(sent_[side], out);
    }
    for (std::size_t side = 0; side < 2; ++side) {
      if (neighbor[side] == MPI_PROC_NULL) continue;
      MPI_Irecv(received_[side].data(), received_words[side], MPI_INT32_T, neighbor[side],
                static_cast<int>(1 - side), comm, &requests[side]);
    }
    for (std::size_t side = 0; side < 2; ++side) {
      if (neighbor[side] == MPI_PROC_NULL) continue;
      copy<true>(fields, faces.sent[side], sent_[side]);
      MPI_Isend(sent_[side].data(), sent_words[side], MPI_INT32_T, neighbor[side],
                static_cast<int>(side), comm, &requests[2 + side]);
    }
    wait_for(requests);
    for (std::size_t side = 0; side < 2; ++side)
      if (neighbor[side] != MPI_PROC_NULL)
        copy<false>(fields, faces.received[side], received_[side]);
  }

 private:
#ifdef CAYSPIN_MPI_DEVICE_MEMORY
  using Memory = Kokkos::DefaultExecutionSpace::memory_space;
#else
  using Memory = Kokkos::SharedHostPinnedSpace;
#endif
  using Buffer = Kokkos::View<std::byte*, Memory>;

  static std::size_t bytes(std::span<FieldNumbers const> fields, Box const& box) {
    std::size_t sum = 0;
    for (auto const& field : fields)
      sum += field.number_bytes * static_cast<std::size_t>(field.components);
    return sum * static_cast<std::size_t>(box.rows() * box.extent(0));
  }

  /// Returns the number of 4-byte words in a message. Throws std::length_error for a message of 8
  /// GiB or more, whose length MPI's int cannot hold.
  static int words_of(std::size_t size) {
    auto const words = size / sizeof(std::int32_t);
    if (words > static_cast<std::size_t>(std::numeric_limits<int>::max()))
      throw std::length_error("cayspin::mpi: a face of the part is 8 GiB or more; use more ranks");
    return static_cast<int>(words);
  }

  static void reserve(Buffer& buffer, std::size_t size) {
    if (buffer.size() != size)
      buffer = Buffer(
          Kokkos::view_alloc(Kokkos::WithoutInitializing, "cayspin::mpi::ghost_message"), size);
  }

  template <bool Packs>
  static void copy(std::span<FieldNumbers const> fields, Box const& box, Buffer const& buffer) {
    std::byte* at = buffer.data();
    for (auto const& field : fields) {
      if (field.number_bytes == sizeof(double))
        copy_field<double, Packs>(field, box, at);
      else
        copy_field<float, Packs>(field, box, at);
      at += field.number_bytes *
            static_cast<std::size_t>(field.components * box.rows() * box.extent(0));
    }
    Kokkos::DefaultExecutionSpace().fence("cayspin::mpi::ghost_message");
  }

  template <class Number, bool Packs>
  static void copy_field(FieldNumbers const& field, Box const& box, std::byte* buffer) {
    CopyRows<Number, Packs> const rows{static_cast<Number*>(field.data),
                                       reinterpret_cast<Number*>(buffer),
                                       field.row,
                                       field.plane,
                                       field.component,
                                       box};
    Kokkos::DefaultExecutionSpace const exec;
    using Policy =
        Kokkos::RangePolicy<Kokkos::DefaultExecutionSpace, Kokkos::IndexType<std::int64_t>>;
    Kokkos::parallel_for(Packs ? "cayspin::mpi::pack" : "cayspin::mpi::unpack",
                         Policy(exec, 0, field.components * box.rows()), rows);
  }

  std::vector<MessagesInPlace> in_place_;
  std::array<Buffer, 2> sent_, received_;
};

}  // namespace cayspin::inline v0_2::mpi::detail
