// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Checksums and sublattices in the file of an ensemble, which are those of the replicas' own files.
#include "hdf5/dataset.hpp"
#include "hdf5/error.hpp"
#include "hdf5/handle.hpp"
#include "hdf5/real_dataset.hpp"
#include "io/ensemble_file.hpp"
#include "trajectory_test.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <span>

namespace cayspin::inline v0_2::io {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t replicas_here = 3, frames_here = 2;

TrajectoryHeader header_of(std::int64_t cell_sites, std::string const& precision) {
  auto header = small_header(precision);
  header.shape = {4, 3, 6};
  header.cell_sites = cell_sites;
  return header;
}

// Returns the spins of a replica in a frame. Site 0 of every cell of a crystal has no spin.
template <class Real>
std::vector<Real> replica_spins(TrajectoryHeader const& header, std::int64_t frame,
                                std::int64_t replica) {
  auto spins = numbered_spins<Real>(header, static_cast<int>(10 * frame + replica));
  auto const of_plane = 3 * header.shape[0] * header.shape[1];
  for (std::int64_t k = 0; header.cell_sites > 1 && k < header.shape[2]; k += header.cell_sites)
    std::fill_n(spins.begin() + k * of_plane, of_plane, Real(0));
  return spins;
}

Scalars replica_scalars(std::int64_t frame, std::int64_t replica) {
  return numbered_scalars(static_cast<int>(100 * frame + replica));
}

template <class Real>
void write_replicas(fs::path const& path, TrajectoryHeader const& header, bool complete = true) {
  Ensemble ensemble;
  ensemble.replicas = replicas_here;
  EnsembleFile file(path, header, ensemble, {.overwrite = true});
  for (std::int64_t frame = 0; frame < frames_here; ++frame) {
    std::vector<std::byte> all;
    std::vector<Scalars> scalars;
    for (std::int64_t replica = 0; replica < replicas_here; ++replica) {
      auto const spins = replica_spins<Real>(header, frame, replica);
      std::ranges::copy(std::as_bytes(std::span(spins)), std::back_inserter(all));
      scalars.push_back(replica_scalars(frame, replica));
    }
    file.write_scalars(frame, 0.1 * static_cast<double>(frame), scalars);
    file.write_frame(frame, 0.1 * static_cast<double>(frame), scalars, all);
  }
  complete ? file.finish({}) : file.close({});
}

template <class Real>
void write_own_file(fs::path const& path, TrajectoryHeader const& header, std::int64_t replica) {
  TrajectoryFile file(path, header, true);
  for (std::int64_t frame = 0; frame < frames_here; ++frame)
    file.write_frame(frame, 0.1 * static_cast<double>(frame), replica_scalars(frame, replica),
                     replica_spins<Real>(header, frame, replica).data());
  file.finish({});
}

std::vector<std::uint64_t> stored_checksums(fs::path const& path) {
  FileHandle const file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT));
  auto const dataset = open_dataset(file.get(), "checksum", path);
  auto const extents = dataset_extents(dataset.get(), path);
  std::vector<std::uint64_t> sums(elements(extents));
  read_block(dataset.get(), H5T_NATIVE_UINT64, Extents(extents.size(), 0), extents, sums.data(),
             path);
  return sums;
}

template <class Real>
void expect_sums_of_own_files(fs::path const& folder, TrajectoryHeader const& header) {
  auto const path = folder / "all.h5", own = folder / "own.h5";
  write_replicas<Real>(path, header);
  auto const info = read_ensemble_info(path);
  auto const sites = static_cast<std::size_t>(header.cell_sites);
  auto const sums = stored_checksums(path);
  ASSERT_EQ(std::ssize(sums), frames_here * replicas_here);
  for (std::int64_t replica = 0; replica < replicas_here; ++replica) {
    SCOPED_TRACE(replica);
    write_own_file<Real>(own, header, replica);
    auto const of_own = stored_checksums(own);
    for (std::int64_t frame = 0; frame < frames_here; ++frame)
      EXPECT_EQ(sums[static_cast<std::size_t>(frame * replicas_here + replica)],
                of_own[static_cast<std::size_t>(frame)]);
    auto const spins = replica_spins<Real>(header, frames_here - 1, replica);
    EXPECT_EQ(read_ensemble_spins(path, info, {replica, 1}),
              (std::vector<double>(spins.begin(), spins.end())));
    if (sites == 1) continue;
    auto const all = read_info(own).frame_sublattices;
    auto const last = info.last_sublattices.begin() + replica * header.cell_sites;
    EXPECT_EQ(std::vector(last, last + header.cell_sites),
              std::vector(all.end() - header.cell_sites, all.end()));
  }
}

TEST_F(TrajectoryTest, ReplicasHaveTheChecksumsAndSublatticesOfTheirOwnFiles) {
  for (std::int64_t const sites : {1, 3}) {
    SCOPED_TRACE(sites);
    expect_sums_of_own_files<double>(folder_, header_of(sites, "double"));
    expect_sums_of_own_files<float>(folder_, header_of(sites, "single"));
  }
}

TEST_F(TrajectoryTest, EnsemblesOfOneSiteInACellHaveNoSublattices) {
  auto const path = folder_ / "all.h5";
  write_replicas<double>(path, header_of(3, "double"));
  EXPECT_EQ(RealDataset(path, "/sublattice_magnetization").extents(), (Extents{2, 3, 3, 3}));
  write_replicas<double>(path, header_of(1, "double"));
  FileHandle const file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT));
  EXPECT_EQ(H5Lexists(file.get(), "sublattice_magnetization", H5P_DEFAULT), 0);
  EXPECT_TRUE(read_ensemble_info(path).last_sublattices.empty());
}

TEST_F(TrajectoryTest, DamagedSpinsOfAReplicaAreNoticed) {
  auto const path = folder_ / "all.h5";
  auto const header = header_of(3, "double");
  write_replicas<double>(path, header);
  auto const place = read_bytes(path).rfind(bytes_of(replica_spins<double>(header, 1, 1)[50]));
  ASSERT_NE(place, std::string::npos);
  overwrite(path, place, "\1");
  auto const info = read_ensemble_info(path);
  for (ReplicaRange const& whole : {ReplicaRange{0, 1}, {2, 1}})
    EXPECT_NO_THROW(read_ensemble_spins(path, info, whole));
  for (ReplicaRange const& damaged : {ReplicaRange{1, 1}, {0, 3}})
    EXPECT_TRUE(contains(
        error_line(path, [&] { read_ensemble_spins(path, info, damaged); }),
        "cannot read dataset spins: replica 1 of frame 1 is damaged: its checksum differs"));
}

// The energy is in the frame and in a sample of /scalars. Both are changed.
void damage_energy(fs::path const& path, std::int64_t frame, std::int64_t replica) {
  auto const all = read_bytes(path), energy = bytes_of(replica_scalars(frame, replica).energy);
  ASSERT_NE(all.find(energy), all.rfind(energy));
  for (auto place = all.find(energy); place != std::string::npos;
       place = all.find(energy, place + 1))
    overwrite(path, place, "\1");
}

TEST_F(TrajectoryTest, DamagedScalarsOfAReplicaAreNoticed) {
  auto const path = folder_ / "all.h5";
  write_replicas<double>(path, header_of(1, "double"));
  damage_energy(path, 1, 2);
  EXPECT_TRUE(contains(error_line(path, [&] { read_ensemble_info(path); }),
                       "replica 2 of frame 1 is damaged: its checksum differs"));
}

TEST_F(TrajectoryTest, ALastFrameOfReplicasThatIsHalfWrittenIsLeftOut) {
  auto const path = folder_ / "all.h5";
  write_replicas<double>(path, header_of(1, "double"), false);
  EXPECT_EQ(read_ensemble_info(path).frames, 2);
  damage_energy(path, 1, 2);
  auto const info = read_ensemble_info(path);
  EXPECT_EQ(info.frames, 1);
  EXPECT_EQ(info.step, 0);
  EXPECT_EQ(info.last.at(2).energy, replica_scalars(0, 2).energy);
  EXPECT_EQ(read_ensemble_spins(path, info, {2, 1}),
            replica_spins<double>(header_of(1, "double"), 0, 2));
}

TEST_F(TrajectoryTest, EnsemblesOfEarlierVersionsHaveNoChecksums) {
  auto const path = folder_ / "all.h5";
  auto const header = header_of(3, "double");
  write_replicas<double>(path, header);
  {
    FileHandle const file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT));
    for (char const* const name : {"checksum", "sublattice_magnetization"})
      ASSERT_GE(H5Ldelete(file.get(), name, H5P_DEFAULT), 0);
  }
  auto const info = read_ensemble_info(path);
  EXPECT_EQ(info.frames, frames_here);
  EXPECT_TRUE(info.last_sublattices.empty());
  EXPECT_EQ(read_ensemble_spins(path, info, {2, 1}), replica_spins<double>(header, 1, 2));
}

}  // namespace
}  // namespace cayspin::inline v0_2::io
