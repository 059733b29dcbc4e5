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

namespace cayspin::simulation {

/// Of a divided lattice. `local` points to `part`, which is null where the lattice is whole.
struct PartOfRank {
  cayspin::Lattice local;
  std::shared_ptr<Part const> part = {};
  bool none = false;  // more ranks than parts: this one has nothing to do
};

/// The processes that run a scene together. All call the same members in the same order.
class Ranks {
 public:
  virtual ~Ranks() = default;

  virtual int count() const = 0;
  /// The first has number 0: it speaks to the user and writes the files.
  virtual int rank() const = 0;
  bool many() const { return count() > 1; }
  bool is_first() const { return rank() == 0; }
  /// How many ranks are on this machine, this one included.
  virtual int on_this_machine() const = 0;

  /// Numbers of parts along y and z, of at least `depth` rows or planes each: those asked for as
  /// "y,z", or else as many as there are, up to one for each rank. Throws UsageError for what
  /// cannot be.
  virtual std::array<int, 2> division(cayspin::Lattice const& lattice, mpi::Depth const& depth,
                                      std::optional<std::string> const& asked) const = 0;
  /// Divides a lattice, and counts only those that have a part from now on.
  virtual PartOfRank divide(cayspin::Lattice const& lattice, mpi::Depth const& depth,
                            std::array<int, 2> const& parts) = 0;

  /// How many planes along z of a lattice with a part for each rank the first takes at once: those
  /// of a part.
  std::int64_t planes_at_once(cayspin::Lattice const& lattice) const {
    return std::max<std::int64_t>(1, whole(lattice).shape[2] / count());
  }

  /// Which of two things one of the ranks wants?
  virtual std::array<bool, 2> any(std::array<bool, 2> wanted) const = 0;
  /// Replaces the text by that of the first rank.
  virtual void tell(std::string& text) const = 0;
  /// Puts those of the numbers of a part's own sites, x fastest, that are in so many planes along z
  /// from number `first` on into `gathered`: planes of the whole lattice, which only the first rank
  /// has.
  virtual void gather(cayspin::Lattice const& local, std::size_t bytes_of_site, std::int64_t first,
                      std::int64_t planes, void const* own, void* gathered) const = 0;

  /// Are all given the same text?
  bool same(std::string const& text) const {
    std::string of_first = text;
    tell(of_first);
    return !any({of_first != text, false})[0];
  }

  /// What work() returns. Throws on all ranks when it throws on one: there what it threw, elsewhere
  /// OtherRankFailed.
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

  /// Ends all ranks when one leaves by an exception of which the others do not know, after it has
  /// been reported.
  virtual void leave_by(int status) = 0;
  /// Did the last exception come from together()?
  bool agreed() const { return agreed_; }

 protected:
  /// The lowest of the numbers that the ranks give.
  virtual int lowest(int number) const = 0;

 private:
  void agree(std::exception_ptr const& error) {
    constexpr int none = 1 << 30, statuses = 256;
    int const failed = lowest(error ? rank() * statuses + status_of(error) : none);
    if (failed == none) return;
    agreed_ = true;
    if (error && failed / statuses == rank()) std::rethrow_exception(error);
    throw OtherRankFailed(failed % statuses);
  }

  bool agreed_ = false;
};

/// The own sites of a part in the whole lattice.
inline io::SiteBox own_sites(cayspin::Lattice const& local) {
  io::SiteBox box{{0, 0, 0}, {local.own(0), local.own(1), local.own(2)}};
  if (local.part != nullptr)
    for (std::size_t axis = 0; axis < 3; ++axis)
      box.begin[axis] = local.part->begin()[axis] + local.ghosts[axis].before;
  return box;
}

}  // namespace cayspin::simulation
