// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/ghosts.hpp>
#include <cayspin/mpi/detail/exchange_with_all.hpp>
#include <cayspin/mpi/detail/ghost_messages.hpp>
#include <cayspin/mpi/division.hpp>
#include <cayspin/part.hpp>

#include <Kokkos_Profiling_ScopedRegion.hpp>
#include <mpi.h>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>

namespace cayspin::inline v0_2::mpi {

/// A lattice divided among the ranks of a communicator, along y and z. Each rank holds its part,
/// with `depth` ghosts at each end that borders another part. Fields on local() work like any
/// others in sums over sites, and in all steppers and terms that do not refuse parts; results are
/// bitwise identical to those on a single rank. A step needs a depth of Stepper::ghosts: with most
/// methods, one layer for each stage. Parts of a crystal, and their ghosts along z, hold whole
/// cells. The Domain must outlive its fields and steppers.
class Domain final : public Part {
 public:
  /// Collective on `comm`. Throws std::invalid_argument on every rank when the lattices or depths
  /// of the ranks differ, a depth is below 1, or the lattice is invalid, is a part of another one,
  /// has replicas or cannot be divided.
  Domain(MPI_Comm comm, Lattice const& lattice, Depth const& depth)
      : Domain(comm, lattice, depth, divide(agreed(comm, lattice, depth), depth, size_of(comm))) {}

  /// Uses the given division; the product of its two numbers must be the number of ranks.
  Domain(MPI_Comm comm, Lattice const& lattice, Depth const& depth, Division const& division)
      : whole_(agreed(comm, lattice, depth, division)),
        division_(division),
        depth_(in_whole_cells(depth, lattice)) {
    cayspin::detail::require_one_replica("cayspin::mpi::Domain", lattice);
    require_division(lattice, depth, division, size_of(comm));
    MPI_Comm_dup(comm, &comm_);
    MPI_Comm_rank(comm_, &rank_);
    local_ = lattice;
    local_.part = this;
    divide_axis(1, division.y, rank_ % division.y, 1);
    divide_axis(2, division.z, rank_ / division.y, lattice.cell_sites);
  }
  Domain(Domain const&) = delete;
  Domain& operator=(Domain const&) = delete;
  ~Domain() override {
    int finalized = 0;
    MPI_Finalized(&finalized);
    if (!finalized) MPI_Comm_free(&comm_);
  }

  /// Returns this rank's part, ghosts included. Make fields, terms and steppers for it.
  Lattice const& local() const { return local_; }
  Lattice const& whole() const override { return whole_; }
  std::array<std::int64_t, 3> begin() const override { return begin_; }
  Division const& division() const { return division_; }
  Depth const& depth() const { return depth_; }
  int rank() const { return rank_; }
  std::size_t parts() const override { return static_cast<std::size_t>(size_of(comm_)); }
  std::size_t index() const override { return static_cast<std::size_t>(rank_); }
  MPI_Comm comm() const { return comm_; }

  void sum(std::span<std::int64_t> words) const override { combine(words, MPI_SUM); }
  void maximum(std::span<std::int64_t> words) const override { combine(words, MPI_MAX); }

  /// Sends one message to each neighbour or, for large contiguous faces in host memory, one for
  /// each component of each field. Planes along z are exchanged first, then rows along y, including
  /// the ghosts just received along z.
  void update_ghosts(std::span<FieldNumbers const> fields) const override {
    Kokkos::Profiling::ScopedRegion const region("cayspin::mpi::update_ghosts");
    for_each_axis([&](std::size_t axis, detail::GhostMessages& messages) {
      messages.exchange(comm_, fields, faces(axis), neighbor_[axis]);
    });
  }
  /// Updates ghosts through buffers, as for fields on a device. Works for all fields that Kokkos'
  /// default execution space can access.
  void update_ghosts_packed(std::span<FieldNumbers const> fields) const {
    for_each_axis([&](std::size_t axis, detail::GhostMessages& messages) {
      messages.exchange_packed(comm_, fields, faces(axis), neighbor_[axis]);
    });
  }
  void exchange(std::span<std::span<std::byte const> const> sent,
                std::span<std::span<std::byte> const> received) const override {
    Kokkos::Profiling::ScopedRegion const region("cayspin::mpi::exchange");
    detail::exchange_with_all(comm_, sent, received);
  }

 private:
  /// Returns `lattice` if it is valid and all ranks were given equal lattices, depths and
  /// divisions; otherwise throws std::invalid_argument.
  static Lattice const& agreed(MPI_Comm comm, Lattice const& lattice, Depth const& depth,
                               Division const& division = {}) {
    constexpr std::size_t count = 16;
    // Numbers, then their complements: the maximum of a complement is the complement of the
    // minimum.
    std::array<std::int64_t, 2 * count> given{};
    given[0] = lattice.cell_sites;
    given[1] = division.y;
    given[2] = division.z;
    given[12] = depth.y;
    given[13] = depth.z;
    given[14] = lattice.replicas;
    given[15] = lattice.part != nullptr || lattice.ghosts != decltype(lattice.ghosts){} ? 1 : 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      given[3 + axis] = lattice.shape[axis];
      given[6 + axis] = std::bit_cast<std::int64_t>(lattice.spacing[axis]);
      given[9 + axis] = static_cast<std::int64_t>(lattice.boundary[axis]);
    }
    for (std::size_t i = 0; i < count; ++i) given[count + i] = ~given[i];
    auto largest = given;
    MPI_Allreduce(given.data(), largest.data(), static_cast<int>(largest.size()), MPI_INT64_T,
                  MPI_MAX, comm);
    for (std::size_t i = 0; i < count; ++i)
      if (largest[i] != ~largest[count + i])
        throw std::invalid_argument(
            "cayspin::mpi::Domain: the ranks were given different lattices, depths or divisions");
    lattice.validate();
    if (given[15] != 0)
      throw std::invalid_argument(
          "cayspin::mpi::Domain: the lattice is a part of another one; accepted: a whole lattice");
    return lattice;
  }

  static int size_of(MPI_Comm comm) {
    int size = 0;
    MPI_Comm_size(comm, &size);
    return size;
  }

  void combine(std::span<std::int64_t> words, MPI_Op operation) const {
    std::array<MPI_Request, 1> request;
    MPI_Iallreduce(MPI_IN_PLACE, words.data(), static_cast<int>(words.size()), MPI_INT64_T,
                   operation, comm_, request.data());
    detail::wait_for(request);
  }

  /// Calls work(axis, messages) for the divided axes, z first.
  template <class Work>
  void for_each_axis(Work const& work) const {
    for (std::size_t const axis : {2UL, 1UL})
      if (neighbor_[axis][0] != MPI_PROC_NULL || neighbor_[axis][1] != MPI_PROC_NULL)
        work(axis, messages_[axis]);
  }

  int depth_along(std::size_t axis) const { return axis == 1 ? depth_.y : depth_.z; }

  /// Sets the extent, ghosts and neighbours of part number `index` of `parts` along an axis.
  /// Extents without ghosts are multiples of `unit`.
  void divide_axis(std::size_t axis, int parts, int index, std::int64_t unit) {
    neighbor_[axis] = {MPI_PROC_NULL, MPI_PROC_NULL};
    if (parts == 1) return;
    std::int64_t const extent = whole_.shape[axis];
    auto const begin_of = [&](int part) { return extent / unit * part / parts * unit; };
    std::int64_t const first = begin_of(index), last = begin_of(index + 1);
    bool const closed = whole_.boundary[axis] == Boundary::periodic;
    bool const before = closed || index > 0, after = closed || index + 1 < parts;
    int const depth = depth_along(axis);
    local_.ghosts[axis] = {before ? depth : 0, after ? depth : 0};
    local_.shape[axis] = last - first + local_.ghosts[axis].before + local_.ghosts[axis].after;
    local_.boundary[axis] = Boundary::open;
    begin_[axis] = first - local_.ghosts[axis].before;
    int const stride = axis == 1 ? 1 : division_.y;
    auto const rank_at = [&](int other) {
      return rank_ + ((other + parts) % parts - index) * stride;
    };
    if (before) neighbor_[axis][0] = rank_at(index - 1);
    if (after) neighbor_[axis][1] = rank_at(index + 1);
  }

  /// Returns the boxes to send to the neighbours along an axis, and the boxes to receive into.
  detail::Faces faces(std::size_t axis) const {
    auto const& ghosts = local_.ghosts[axis];
    std::int64_t const end = local_.shape[axis] - ghosts.after, depth = depth_along(axis);
    auto const rows = [&](std::int64_t begin, std::int64_t count) {
      detail::Box box{{0, 0, 0}, local_.shape};
      if (axis == 2) {
        box.begin[1] = local_.ghosts[1].before;
        box.end[1] = local_.shape[1] - local_.ghosts[1].after;
      }
      box.begin[axis] = begin;
      box.end[axis] = begin + count;
      return box;
    };
    return {{rows(ghosts.before, depth), rows(end - depth, depth)},
            {rows(0, ghosts.before), rows(end, ghosts.after)}};
  }

  MPI_Comm comm_ = MPI_COMM_NULL;
  Lattice whole_, local_;
  Division division_;
  Depth depth_;
  int rank_ = 0;
  std::array<std::int64_t, 3> begin_{0, 0, 0};
  std::array<std::array<int, 2>, 3> neighbor_{};
  mutable std::array<detail::GhostMessages, 3> messages_;
};

}  // namespace cayspin::inline v0_2::mpi
