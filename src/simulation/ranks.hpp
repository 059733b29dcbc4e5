// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "failure.hpp"
#include "io/site_box.hpp"

#include <cayspin/lattice.hpp>
#include <cayspin/mpi/division.hpp>
#include <cayspin/part.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace cayspin::simulation {

/// A rank's part of a divided lattice. `local` points to `part`, which is null for a whole lattice.
struct PartOfRank {
  cayspin::Lattice local;
  std::shared_ptr<Part const> part = {};
  bool none = false;  // more ranks than parts: this rank is idle
};

/// The processes that run a scene together. All must call the same members in the same order.
class Ranks {
 public:
  virtual ~Ranks() = default;

  virtual int count() const = 0;
  /// Returns this rank's number. Rank 0 prints messages and writes the files.
  virtual int rank() const = 0;
  bool many() const { return count() > 1; }
  bool is_first() const { return rank() == 0; }
  /// Returns how many ranks are on this machine, including this one.
  virtual int on_this_machine() const = 0;
  /// Returns how many ranks may run on a core of this one, including this one.
  virtual int on_these_cores() const = 0;

  /// Returns the numbers of parts along y and z, with at least `depth` rows or planes each: those
  /// requested as "y,z", otherwise as many as possible, up to one for each rank. Throws UsageError
  /// for an invalid division.
  virtual std::array<int, 2> division(cayspin::Lattice const& lattice, mpi::Depth const& depth,
                                      std::optional<std::string> const& asked) const = 0;
  /// Divides a lattice. From then on, all members ignore ranks without a part.
  virtual PartOfRank divide(cayspin::Lattice const& lattice, mpi::Depth const& depth,
                            std::array<int, 2> const& parts) = 0;
  /// Leaves out the ranks beyond the first `most`; the warning says `why`. Returns false on a rank
  /// that is left out. From then on, all members ignore those ranks.
  virtual bool keep_first(std::int64_t most, std::string const& why) = 0;

  /// Returns how many planes along z of the whole lattice the first rank holds at a time: nz /
  /// count(), at least 1.
  std::int64_t planes_at_once(cayspin::Lattice const& lattice) const {
    return std::max<std::int64_t>(1, whole(lattice).shape[2] / count());
  }

  /// Returns for each of two flags whether any rank has set it.
  virtual std::array<bool, 2> any(std::array<bool, 2> wanted) const = 0;
  /// Returns the lowest `number` of any rank.
  virtual std::int64_t lowest(std::int64_t number) const = 0;
  /// Replaces the text by that of the first rank.
  virtual void tell(std::string& text) const = 0;
  /// Gathers `planes` planes along z of the whole lattice, from plane `first` on, into `gathered`,
  /// which is used only on the first rank. `own`: the values of this part's own sites, with x
  /// varying fastest.
  virtual void gather(cayspin::Lattice const& local, std::size_t bytes_of_site, std::int64_t first,
                      std::int64_t planes, void const* own, void* gathered) const = 0;
  /// Returns the bytes of all ranks, in the order of the ranks; nothing on ranks but the first.
  virtual std::vector<std::byte> gather(std::vector<std::byte> own) const = 0;

  /// Returns true if all ranks were given the same text.
  bool same(std::string const& text) const {
    std::string of_first = text;
    tell(of_first);
    return !any({of_first != text, false})[0];
  }

  /// Calls work() on all ranks, and returns its result. If it throws on a rank, throws on all
  /// ranks: that exception on the first rank that failed, OtherRankFailed on the others.
  template <class Work>
  auto together(Work const& work) {
    using Result = std::invoke_result_t<Work>;
    std::exception_ptr error;
    std::optional<std::conditional_t<std::is_void_v<Result>, int, Result>> result;
    try {
      if constexpr (std::is_void_v<Result>)
        work();
      else
        result.emplace(work());
    } catch (...) {
      if (!many()) throw;
      error = std::current_exception();
    }
    if (many()) agree(error);
    if constexpr (!std::is_void_v<Result>) return std::move(*result);
  }

  /// Ends all ranks with `status`. Call it on a rank that has an exception of which the other ranks
  /// do not know, after reporting that exception.
  virtual void leave_by(int status) = 0;
  /// Returns true if together() has thrown on all of several ranks, so that each knows of the
  /// failure.
  bool agreed() const { return agreed_; }

 private:
  void agree(std::exception_ptr const& error) {
    constexpr int none = 1 << 30, statuses = 256;
    auto const failed =
        static_cast<int>(lowest(error ? rank() * statuses + status_of(error) : none));
    if (failed == none) return;
    agreed_ = true;
    if (error && failed / statuses == rank()) std::rethrow_exception(error);
    throw OtherRankFailed(failed % statuses);
  }

  bool agreed_ = false;
};

/// Returns the box that a part's own sites fill in the whole lattice.
inline io::SiteBox own_sites(cayspin::Lattice const& local) {
  io::SiteBox box{{0, 0, 0}, {local.own(0), local.own(1), local.own(2)}};
  if (local.part != nullptr)
    for (std::size_t axis = 0; axis < 3; ++axis)
      box.begin[axis] = local.part->begin()[axis] + local.ghosts[axis].before;
  return box;
}

}  // namespace cayspin::simulation
