// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "hdf5/real_dataset.hpp"
#include "io/scene.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <string>
#include <vector>

namespace cayspin::inline v0_2::io::detail {

/// A dataset with `of_site` numbers per site. Its extents are (nz, ny, nx), or (site, nz, ny, nx)
/// for several sites per cell, followed by `of_site` if that is above 1.
class DatasetOfSites {
 public:
  DatasetOfSites(std::filesystem::path const& path, std::string name, Lattice const& lattice,
                 std::int64_t of_site, Accepted accepted = Accepted::reals)
      : sites_(static_cast<std::int64_t>(lattice.basis.size())),
        of_site_(of_site),
        dataset_(path, std::move(name), accepted),
        expected_(extents(
            {sites_, lattice.shape[2] / sites_, lattice.shape[1], lattice.shape[0], of_site})) {}

  bool fits() const { return dataset_.extents() == expected_; }
  std::string expected() const { return fmt::format("{}", fmt::join(expected_, ", ")); }
  [[noreturn]] void refuse_extents(std::string const& accepted) const {
    dataset_.refuse_extents(accepted);
  }

  /// Reads a box in the order of the lattice: plane k * sites + s has site s of the cells with
  /// number k along z.
  std::vector<double> in(SiteBox const& box) const {
    auto const at_once = sites_ == 1 ? box.extent[2] : 1;
    std::vector<double> numbers;
    for (auto plane = box.begin[2]; plane < box.begin[2] + box.extent[2]; plane += at_once) {
      auto const read =
          dataset_.read(extents({plane % sites_, plane / sites_, box.begin[1], box.begin[0], 0}),
                        extents({1, at_once, box.extent[1], box.extent[0], of_site_}));
      numbers.insert(numbers.end(), read.begin(), read.end());
    }
    return numbers;
  }

 private:
  /// Returns `all` without the extents that the dataset lacks: the first for one site per cell, the
  /// last for one number per site.
  Extents extents(std::array<std::int64_t, 5> const& all) const {
    return Extents(all.begin() + (sites_ == 1 ? 1 : 0), all.end() - (of_site_ == 1 ? 1 : 0));
  }

  std::int64_t sites_, of_site_;
  RealDataset dataset_;
  Extents expected_;
};

}  // namespace cayspin::inline v0_2::io::detail
