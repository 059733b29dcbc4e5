// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "start_file.hpp"

#include "dataset_of_sites.hpp"
#include "hdf5/error.hpp"
#include "hdf5/guarded_reading.hpp"
#include "io/ensemble_file.hpp"
#include "io/ovf.hpp"
#include "io/trajectory.hpp"
#include "ovf_of_sites.hpp"
#include "trajectory/stored_spins.hpp"

#include <fmt/format.h>

namespace cayspin::inline v0_2::io::detail {
namespace {

std::int64_t sites_of(Lattice const& lattice) {
  return static_cast<std::int64_t>(lattice.basis.size());
}

/// Opens /spins (site, nz, ny, nx, 3) of a crystal: a state, without frames.
DatasetOfSites open_state(std::filesystem::path const& path, Lattice const& lattice) {
  DatasetOfSites state(path, "/spins", lattice, 3);
  if (!state.fits()) state.refuse_extents(fmt::format("({0}) or (frame, {0})", state.expected()));
  return state;
}

bool is_state_of_crystal(std::filesystem::path const& path, Lattice const& lattice) {
  return lattice.basis.size() > 1 && RealDataset(path, "/spins").extents().size() != 6;
}

}  // namespace

void check_start_file(std::filesystem::path const& path, Lattice const& lattice) {
  if (is_ovf(path)) {
    check_ovf_of_sites(path, lattice, 3);
  } else {
    try_reading(path, [&] {
      // Otherwise, the replicas would be mistaken for the sites of a cell.
      if (is_ensemble(path))
        throw_failure(path, "cannot read the spins",
                      "it is the file of an ensemble; accepted: a file of one lattice");
      if (is_state_of_crystal(path, lattice))
        open_state(path, lattice);
      else
        StoredSpins(path, lattice.shape, sites_of(lattice));
    });
  }
}

std::vector<double> read_start_file(std::filesystem::path const& path, Lattice const& lattice,
                                    SiteBox const& box) {
  if (is_ovf(path)) return read_ovf_of_sites(path, lattice, 3, box);
  if (read_guarded(path, [&] { return is_state_of_crystal(path, lattice); }))
    return read_guarded(path, [&] { return open_state(path, lattice).in(box); });
  return read_spins(path, lattice.shape, box, sites_of(lattice));
}

std::vector<double> sites_with_spins(std::filesystem::path const& path, Lattice const& lattice,
                                     SiteBox const& box) {
  auto const spins = read_start_file(path, lattice, box);
  std::vector<double> there(spins.size() / 3);
  for (std::size_t site = 0; site < there.size(); ++site) {
    auto const* const m = &spins[3 * site];
    there[site] = m[0] == 0 && m[1] == 0 && m[2] == 0 ? 0 : 1;
  }
  return there;
}

bool holds_spins(std::filesystem::path const& path) {
  if (is_ovf(path)) return ovf_components(path) != 1;
  return read_guarded(path, [&] {
    QuietErrors const quiet;
    auto const file = open_file(path);
    auto const has = [&](char const* name) { return H5Lexists(file.get(), name, H5P_DEFAULT) > 0; };
    return has("/spins") && !has("/values");
  });
}

}  // namespace cayspin::inline v0_2::io::detail
