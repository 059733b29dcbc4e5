// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "ranks.hpp"

#include <fmt/format.h>

namespace cayspin::simulation {

class OneRank final : public Ranks {
 public:
  int count() const override { return 1; }
  int rank() const override { return 0; }
  int on_this_machine() const override { return 1; }
  int on_these_cores() const override { return 1; }
  std::array<int, 2> division(cayspin::Lattice const&, mpi::Depth const&,
                              std::optional<std::string> const& asked) const override {
    if (asked && *asked != "1,1")
      throw UsageError(
          fmt::format("--ranks {}: the run has one rank; accepted: mpiexec -n N, and a "
                      "program built with MPI",
                      *asked));
    return {1, 1};
  }
  PartOfRank divide(cayspin::Lattice const& lattice, mpi::Depth const&,
                    std::array<int, 2> const&) override {
    return {lattice};
  }
  bool keep_first(std::int64_t, std::string const&) override { return true; }
  std::array<bool, 2> any(std::array<bool, 2> wanted) const override { return wanted; }
  std::int64_t lowest(std::int64_t number) const override { return number; }
  void tell(std::string&) const override {}
  void gather(cayspin::Lattice const&, std::size_t, std::int64_t, std::int64_t, void const*,
              void*) const override {}
  std::vector<std::byte> gather(std::vector<std::byte> own) const override { return own; }
  void leave_by(int) override {}
};

}  // namespace cayspin::simulation
