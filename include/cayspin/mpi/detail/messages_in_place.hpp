// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/execution.hpp>
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

/// The sites from `begin` to `end`, which is excluded.
struct Box {
  std::array<std::int64_t, 3> begin, end;

  KOKKOS_FUNCTION std::int64_t extent(std::size_t axis) const { return end[axis] - begin[axis]; }
  std::int64_t rows() const { return extent(1) * extent(2); }
};

/// Boxes to send to the previous and the next neighbour, and the boxes to receive into.
struct Faces {
  std::array<Box, 2> sent, received;
};

/// A box of a field in host memory as equal blocks of bytes at constant strides. Throws
/// std::length_error for a block of 2 GiB or more.
struct BytesInPlace {
  std::byte* first;
  int bytes;  // of a block
  int planes, components;
  MPI_Aint plane, component;  // strides in bytes

  // The rows of a plane are sent with their padding, so that they are one block. If the box
  // consists of whole planes, these are one block together.
  BytesInPlace(FieldNumbers const& field, Box const& box)
      : first(static_cast<std::byte*>(field.data) +
              count(field, box.begin[2] * field.plane + box.begin[1] * field.row + box.begin[0])),
        planes(box.extent(1) == field.ny ? 1 : static_cast<int>(box.extent(2))),
        components(field.components),
        plane(count(field, field.plane)),
        component(count(field, field.component)) {
    std::int64_t const more_planes = planes == 1 ? box.extent(2) - 1 : 0;
    MPI_Aint const size =
        count(field, more_planes * field.plane + (box.extent(1) - 1) * field.row + box.extent(0));
    if (size > std::numeric_limits<int>::max())
      throw std::length_error("cayspin::mpi: a face of the part is 2 GiB or more; use more ranks");
    bytes = static_cast<int>(size);
  }

  MPI_Datatype type() const {
    MPI_Datatype block = MPI_DATATYPE_NULL, one = block, all = block;
    MPI_Type_contiguous(bytes, MPI_BYTE, &block);
    MPI_Type_create_hvector(planes, 1, plane, block, &one);
    MPI_Type_create_hvector(components, 1, component, one, &all);
    MPI_Type_free(&block);
    MPI_Type_free(&one);
    return all;
  }

 private:
  static MPI_Aint count(FieldNumbers const& field, std::int64_t numbers) {
    return static_cast<MPI_Aint>(numbers) * static_cast<MPI_Aint>(field.number_bytes);
  }
};

/// Persistent MPI messages to and from the two neighbours along an axis, for given fields in host
/// memory: made once, and started for each exchange.
class MessagesInPlace {
 public:
  MessagesInPlace(MPI_Comm comm, std::span<FieldNumbers const> fields, Faces const& faces,
                  std::array<int, 2> const& neighbor)
      : fields_(fields.begin(), fields.end()) {
    for (std::size_t side = 0; side < 2; ++side) {
      if (neighbor[side] == MPI_PROC_NULL) continue;
      int const tag = static_cast<int>(side);
      add(faces.received[side], [&](void* first, int count, MPI_Datatype type) {
        MPI_Recv_init(first, count, type, neighbor[side], 1 - tag, comm, next());
      });
      add(faces.sent[side], [&](void* first, int count, MPI_Datatype type) {
        MPI_Send_init(first, count, type, neighbor[side], tag, comm, next());
      });
    }
  }
  MessagesInPlace(MessagesInPlace&&) = default;
  MessagesInPlace& operator=(MessagesInPlace&&) = default;
  ~MessagesInPlace() {
    int finalized = 0;
    MPI_Finalized(&finalized);
    if (finalized) return;
    for (MPI_Request& request : requests_) MPI_Request_free(&request);
  }

  bool are_of(std::span<FieldNumbers const> fields) const {
    return std::ranges::equal(fields_, fields);
  }
  void exchange() {
    MPI_Startall(static_cast<int>(requests_.size()), requests_.data());
    wait_for(requests_);
  }

 private:
  MPI_Request* next() { return &requests_.emplace_back(MPI_REQUEST_NULL); }

  // Makes one message for all fields. If each component of every field has one long block of bytes
  // in the box, makes one for each component of each field instead, because MPICH copies these
  // faster.
  template <class Make>
  void add(Box const& box, Make const& make) const {
    constexpr int long_bytes = 32 * 1024;
    std::vector<BytesInPlace> boxes;
    for (auto const& field : fields_) boxes.emplace_back(field, box);
    bool const apart = std::ranges::all_of(
        boxes, [](BytesInPlace const& one) { return one.planes == 1 && one.bytes >= long_bytes; });
    if (!apart) return add_together(boxes, make);
    for (auto const& one : boxes)
      for (int c = 0; c < one.components; ++c)
        make(one.first + c * one.component, one.bytes, MPI_BYTE);
  }
  template <class Make>
  static void add_together(std::vector<BytesInPlace> const& boxes, Make const& make) {
    std::vector<MPI_Datatype> types;
    std::vector<MPI_Aint> places;
    std::vector<int> const counts(boxes.size(), 1);
    for (auto const& one : boxes) {
      types.push_back(one.type());
      places.push_back(0);
      MPI_Get_address(one.first, &places.back());
    }
    MPI_Datatype type = MPI_DATATYPE_NULL;
    MPI_Type_create_struct(static_cast<int>(boxes.size()), counts.data(), places.data(),
                           types.data(), &type);
    MPI_Type_commit(&type);
    for (MPI_Datatype& part : types) MPI_Type_free(&part);
    make(MPI_BOTTOM, 1, type);
    MPI_Type_free(&type);
  }

  std::vector<FieldNumbers> fields_;
  std::vector<MPI_Request> requests_;
};

}  // namespace cayspin::inline v0_2::mpi::detail
