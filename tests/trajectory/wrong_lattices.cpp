// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The extents of /spins are not those of a lattice. Readers divide by them.
#include "hdf5/dataset.hpp"
#include "hdf5/error.hpp"
#include "hdf5/handle.hpp"
#include "io/ensemble_file.hpp"
#include "io/modes.hpp"
#include "io/path.hpp"
#include "trajectory_test.hpp"

namespace cayspin::inline v0_2::io {
namespace {

namespace fs = std::filesystem;

class WrongLattices : public TrajectoryTest {
 protected:
  /// Expects `read` to refuse the file for each of these extents of /spins.
  template <class Read>
  void expect_refused(std::vector<Extents> const& all, Read const& read) const {
    for (auto const& extents : all) {
      {
        QuietErrors const quiet;
        FileHandle const file(H5Fopen(path_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT));
        ASSERT_GE(H5Ldelete(file.get(), "spins", H5P_DEFAULT), 0);
        create_dataset(file.get(), "spins", H5T_IEEE_F64LE, extents, path_);
      }
      EXPECT_TRUE(contains(error_line(path_, read), "its extents are not those of a lattice"));
    }
  }

  fs::path path_ = folder_ / "a.h5";
};

TEST_F(WrongLattices, OfATrajectory) {
  write_frames(path_, 1).finish({});
  expect_refused({{1, 0, 2, 3, 4, 3}, {1, 2, 3, 0, 3}, {1, 0, 0, 0, 3}}, [&] { read_info(path_); });
}

TEST_F(WrongLattices, OfAnEnsemble) {
  Ensemble ensemble;
  ensemble.replicas = 2;
  EnsembleFile(path_, small_header(), ensemble, {}).finish({});
  EXPECT_EQ(read_ensemble_info(path_).ensemble.replicas, 2);
  expect_refused({{0, 2, 0, 2, 3, 4, 3}, {0, 2, 2, 3, 0, 3}}, [&] { read_ensemble_info(path_); });
}

TEST_F(WrongLattices, OfAPath) {
  Path found;
  found.header = small_header();
  found.energy = found.distance = {0, 1};
  found.spins.resize(2 * 3 * 24);
  write_path(path_, found, false);
  EXPECT_EQ(read_path(path_).header.shape, small_header().shape);
  expect_refused({{2, 0, 2, 3, 4, 3}, {2, 2, 3, 0, 3}}, [&] { read_path(path_); });
}

TEST_F(WrongLattices, OfModes) {
  ModesContents found;
  found.shape = {4, 3, 2};
  found.spins.resize(3 * 24);
  found.frequencies = found.decays = found.residuals = {1};
  found.shapes.emplace_back(6 * 24);
  write_modes(path_, found, false);
  EXPECT_EQ(read_modes(path_).shape, found.shape);
  expect_refused({{0, 2, 3, 4, 3}, {2, 3, 0, 3}}, [&] { read_modes(path_); });
}

}  // namespace
}  // namespace cayspin::inline v0_2::io
