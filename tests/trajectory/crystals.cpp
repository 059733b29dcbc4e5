// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Files of crystals with several sites per cell, which are stored site by site.
#include "hdf5/real_dataset.hpp"
#include "io/checkpoint.hpp"
#include "io/run_output.hpp"
#include "trajectory_test.hpp"

#include <algorithm>

namespace cayspin::inline v0_2::io {
namespace {

constexpr std::int64_t sites = 3;

TrajectoryHeader crystal_header(std::array<std::int64_t, 3> const& shape = {4, 3, 6},
                                std::string const& precision = "double") {
  auto header = small_header(precision);
  header.shape = shape;
  header.cell_sites = sites;
  return header;
}

// Returns spins that are zero on site 0 of every cell, and on one other site.
template <class Real>
std::vector<Real> spins_of(TrajectoryHeader const& header, int frame) {
  auto spins = numbered_spins<Real>(header, frame);
  auto const of_plane = 3 * header.shape[0] * header.shape[1];
  for (std::int64_t k = 0; k < header.shape[2]; k += sites)
    std::fill_n(spins.begin() + k * of_plane, of_plane, Real(0));
  std::fill_n(spins.begin() + of_plane, 3, Real(0));
  return spins;
}

template <class Real>
void write_crystal(std::filesystem::path const& path, TrajectoryHeader const& header, int frames,
                   RunOutputOptions const& options = {}) {
  RunOutput output(path, header, options);
  for (int frame = 0; frame < frames; ++frame) {
    std::ranges::copy(spins_of<Real>(header, frame), output.template frame<Real>());
    output.write_scalars(frame, frame, numbered_scalars(frame));
    output.write_frame(frame, frame, numbered_scalars(frame));
  }
  output.finish({});
}

// Returns the spins on one site of every cell, from an array in the memory order of a run.
template <class Real>
std::vector<double> numbers_of(std::vector<Real> const& spins, TrajectoryHeader const& header,
                               std::int64_t site) {
  auto const of_plane = 3 * header.shape[0] * header.shape[1];
  std::vector<double> numbers;
  for (std::int64_t k = site; k < header.shape[2]; k += sites)
    numbers.insert(numbers.end(), spins.begin() + k * of_plane, spins.begin() + (k + 1) * of_plane);
  return numbers;
}

Extents extents_of(std::filesystem::path const& path, char const* name) {
  return RealDataset(path, name).extents();
}

template <class Real>
void expect_stored(std::filesystem::path const& path, TrajectoryHeader const& header, int frames) {
  auto const info = read_info(path);
  EXPECT_EQ(info.header.shape, header.shape);
  EXPECT_EQ(info.header.cell_sites, sites);
  ASSERT_EQ(info.frames, frames);
  std::vector<double> stored;
  for (int frame = 0; frame < frames; ++frame) {
    auto const spins = spins_of<Real>(header, frame);
    std::vector<double> const expected(spins.begin(), spins.end());
    EXPECT_EQ(read_spins(path, header.shape, frame, sites), expected);
    for (std::int64_t site = 0; site < sites; ++site) {
      auto const numbers = numbers_of(spins, header, site);
      stored.insert(stored.end(), numbers.begin(), numbers.end());
    }
    if (frame + 1 < frames) continue;
    auto const [nx, ny, nz] = header.shape;
    for (std::int64_t first = 0; first < nz; ++first)
      for (std::int64_t count = 1; first + count <= nz; ++count) {
        SiteBox const box{{1, 0, first}, {nx - 1, ny - 1, count}};
        EXPECT_EQ(read_spins(path, header.shape, box, sites),
                  numbers_in(box, header.shape, 3, expected));
      }
  }
  EXPECT_EQ(RealDataset(path, "/spins").read(), stored);
}

TEST_F(TrajectoryTest, CrystalsLieSiteBySiteAndComeBackAsTheyWere) {
  auto const path = folder_ / "a.h5";
  // Uncompressed chunks of whole planes of a single frame bypass HDF5. In double precision, a plane
  // of the larger shape fills three pages, so its chunks are among these. Other chunks do not
  // bypass HDF5.
  for (std::array<std::int64_t, 3> const shape :
       {std::array<std::int64_t, 3>{4, 3, 9}, {32, 16, 9}})
    for (int const compression : {0, 1})
      for (std::int64_t const chunk : {0, 1, 2}) {
        SCOPED_TRACE(std::to_string(shape[0]) + ", compression " + std::to_string(compression) +
                     ", chunk " + std::to_string(chunk));
        RunOutputOptions const options{.overwrite = true,
                                       .storage = {.compression = compression, .chunk = chunk},
                                       .most_planes = 1};
        write_crystal<double>(path, crystal_header(shape), 2, options);
        expect_stored<double>(path, crystal_header(shape), 2);
        write_crystal<float>(path, crystal_header(shape, "single"), 2, options);
        expect_stored<float>(path, crystal_header(shape, "single"), 2);
      }
}

TEST_F(TrajectoryTest, ChunksOfCrystalsAreOfOneSite) {
  auto const path = folder_ / "a.h5";
  write_crystal<double>(path, crystal_header({32, 16, 9}), 2, {.storage = {.chunk = 2}});
  EXPECT_EQ(extents_of(path, "/spins"), (Extents{2, 3, 3, 16, 32, 3}));
  EXPECT_EQ(RealDataset(path, "/spins").chunk(), (Extents{1, 1, 2, 16, 32, 3}));
  EXPECT_EQ(extents_of(path, "/sublattice_magnetization"), (Extents{2, 3, 3}));
}

TEST_F(TrajectoryTest, CrystalsOfOneSiteHaveNoAxisOfSites) {
  auto const path = folder_ / "a.h5";
  auto header = crystal_header();
  header.cell_sites = 1;
  write_crystal<double>(path, header, 2);
  EXPECT_EQ(extents_of(path, "/spins"), (Extents{2, 6, 3, 4, 3}));
  FileHandle const file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT));
  EXPECT_EQ(H5Lexists(file.get(), "sublattice_magnetization", H5P_DEFAULT), 0);
  EXPECT_EQ(H5Lexists(file.get(), "positions", H5P_DEFAULT), 0);
  EXPECT_TRUE(read_info(path).frame_sublattices.empty());
}

TEST_F(TrajectoryTest, SublatticesHaveTheMeanOfTheirSpins) {
  auto const path = folder_ / "a.h5";
  for (auto const* const precision : {"double", "single"}) {
    auto const header = crystal_header({4, 3, 6}, precision);
    bool const single = std::string(precision) == "single";
    single ? write_crystal<float>(path, header, 2, {.overwrite = true})
           : write_crystal<double>(path, header, 2, {.overwrite = true});
    auto const info = read_info(path);
    ASSERT_EQ(info.frame_sublattices.size(), 2u * sites);
    for (int frame = 0; frame < 2; ++frame)
      for (std::int64_t site = 0; site < sites; ++site) {
        auto const numbers = single ? numbers_of(spins_of<float>(header, frame), header, site)
                                    : numbers_of(spins_of<double>(header, frame), header, site);
        std::array<double, 3> sum{};
        int count = 0;
        for (std::size_t i = 0; i < numbers.size(); i += 3) {
          if (numbers[i] == 0) continue;
          ++count;
          for (std::size_t c = 0; c < 3; ++c) sum[c] += numbers[i + c];
        }
        EXPECT_EQ(count, site == 0 ? 0 : site == 1 ? 23 : 24);
        auto const& mean = info.frame_sublattices[static_cast<std::size_t>(frame * sites + site)];
        for (std::size_t c = 0; c < 3; ++c)
          EXPECT_NEAR(mean[c], count == 0 ? 0 : sum[c] / count, 1e-15) << site;
      }
  }
}

TEST_F(TrajectoryTest, DamagedFramesOfCrystalsAreNoticed) {
  auto const path = folder_ / "a.h5";
  auto const header = crystal_header();
  write_crystal<double>(path, header, 3);
  auto const place = read_bytes(path).rfind(bytes_of(spins_of<double>(header, 1)[5 * 36]));
  ASSERT_NE(place, std::string::npos);
  overwrite(path, place, "\1");
  EXPECT_TRUE(contains(error_line(path, [&] { read_spins(path, header.shape, 1); }),
                       "frame 1 is damaged: its checksum differs"));
  EXPECT_EQ(read_spins(path, header.shape), spins_of<double>(header, 2));
}

TEST_F(TrajectoryTest, DamagedSublatticesAreNoticed) {
  auto const path = folder_ / "a.h5";
  write_crystal<double>(path, crystal_header(), 3);
  auto const place = read_bytes(path).rfind(bytes_of(read_info(path).frame_sublattices.at(5)[2]));
  ASSERT_NE(place, std::string::npos);
  overwrite(path, place, "\1");
  EXPECT_TRUE(contains(error_line(path, [&] { read_info(path); }), "sample 1 is damaged"));
}

TEST_F(TrajectoryTest, ACrystalWithoutItsSublatticesIsRefused) {
  auto const path = folder_ / "a.h5";
  write_crystal<double>(path, crystal_header(), 1);
  {
    FileHandle const file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT));
    ASSERT_GE(H5Ldelete(file.get(), "sublattice_magnetization", H5P_DEFAULT), 0);
  }
  EXPECT_TRUE(contains(error_line(path, [&] { read_info(path); }),
                       "cannot read dataset sublattice_magnetization: it is not there"));
}

TEST_F(TrajectoryTest, OtherCrystalsAreRefused) {
  auto const path = folder_ / "a.h5";
  write_crystal<double>(path, crystal_header(), 1);
  for (std::int64_t const other : {1, 2, 6})
    EXPECT_TRUE(contains(
        error_line(path,
                   [&] {
                     read_spins(path, {4, 3, 6}, 0, other);
                   }),
        "its extents are (1, 3, 2, 3, 4, 3); accepted: (6, 3, 4, 3) or (frame, 6, 3, 4, 3)"))
        << other;
  for (std::array<std::int64_t, 3> const shape :
       {std::array<std::int64_t, 3>{4, 3, 2}, {4, 3, 5}, {4, 3, 12}, {3, 4, 6}})
    error_line(path, [&] { read_spins(path, shape); });
}

// A killed writer leaves complete frames. A frame without sublattices does not count.
TEST_F(TrajectoryTest, FramesOfCrystalsWithoutSublatticesDoNotCount) {
  auto const path = folder_ / "a.h5";
  auto const header = crystal_header();
  {
    TrajectoryFile file(path, header, false);
    for (int frame = 0; frame < 3; ++frame)
      file.write_frame(frame, frame, numbered_scalars(frame),
                       spins_of<double>(header, frame).data());
  }
  EXPECT_EQ(read_info(path).frames, 3);
  {
    FileHandle const file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT));
    DatasetHandle const means(H5Dopen2(file.get(), "sublattice_magnetization", H5P_DEFAULT));
    std::array<hsize_t, 3> const shorter{2, sites, 3};
    ASSERT_GE(H5Dset_extent(means.get(), shorter.data()), 0);
  }
  EXPECT_EQ(read_info(path).frames, 2);
  EXPECT_EQ(read_spins(path, header.shape), spins_of<double>(header, 1));
}

TEST_F(TrajectoryTest, SyncedCrystalsAreWhole) {
  auto const path = folder_ / "a.h5";
  auto const header = crystal_header();
  write_crystal<double>(path, header, 3, {.storage = {.sync = true}});
  expect_stored<double>(path, header, 3);
}

TEST_F(TrajectoryTest, CheckpointsSayHowManySitesACellHas) {
  auto const path = folder_ / "a.checkpoint.h5";
  for (std::int64_t const of_cell : {std::int64_t{1}, sites}) {
    CheckpointHeader header;
    header.shape = {4, 3, 6};
    header.cell_sites = of_cell;
    auto spins = spins_of<double>(crystal_header(), 1);
    {
      CheckpointWriter writer(path, header);
      writer.field("spins", spins);
      writer.commit();
    }
    CheckpointReader const reader(path);
    EXPECT_EQ(reader.header().shape, header.shape);
    EXPECT_EQ(reader.header().cell_sites, of_cell);
    EXPECT_EQ(reader.field("spins", {{0, 0, 0}, header.shape}), spins);
    EXPECT_EQ(read_spins(path, header.shape), spins);
    FileHandle const file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT));
    EXPECT_EQ(H5Aexists(file.get(), "cell_sites"), of_cell > 1);
  }
}

TEST_F(TrajectoryTest, CrystalsAreWrittenWholeAndOfWholeCells) {
  auto const path = folder_ / "a.h5";
  auto header = crystal_header();
  auto const pieces = frame_pieces(header.shape, 8, {.chunk = 1}, 1, sites);
  EXPECT_EQ(pieces.planes, 6);
  EXPECT_EQ(pieces.bytes, 6u * 36 * 8);
  TrajectoryFile file(path, header, false, {.chunk = 1});
  std::vector<std::byte> room(pieces.bytes);
  for (std::int64_t const planes : {0, 1, 3, 7})
    EXPECT_THROW(file.write_planes(planes, room.data()), std::logic_error) << planes;
  file.write_planes(6, room.data());
  file.end_frame(0, 0, {});
  EXPECT_EQ(file.frames(), 1);
  for (std::int64_t const other : {-1, 0, 4, 12}) {
    header.cell_sites = other;
    EXPECT_THROW(TrajectoryFile(folder_ / "b.h5", header, false), std::invalid_argument) << other;
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "b.h5"));
}

std::vector<double> numbered_positions(std::int64_t count) {
  std::vector<double> positions(static_cast<std::size_t>(3 * count));
  for (std::size_t i = 0; i < positions.size(); ++i) positions[i] = 0.25 * static_cast<double>(i);
  return positions;
}

TEST_F(TrajectoryTest, PositionsAreStoredAndNamedInTheXdmfFile) {
  auto const path = folder_ / "a.h5";
  auto const positions = numbered_positions(72);
  write_crystal<double>(path, crystal_header(), 1, {.xdmf = true, .positions = positions});
  EXPECT_EQ(extents_of(path, "/positions"), (Extents{3, 2, 3, 4, 3}));
  EXPECT_EQ(RealDataset(path, "/positions").read(), positions);
  auto const text = read_bytes(folder_ / "a.xdmf");
  EXPECT_TRUE(contains(text, R"(TopologyType="Polyvertex" NumberOfElements="72")"));
  EXPECT_TRUE(contains(text, R"(<DataItem Dimensions="3 2 3 4 3" NumberType="Float" Precision="8")"
                             R"( Format="HDF">a.h5:/positions<)"));
  EXPECT_TRUE(contains(text, R"(<DataItem Dimensions="3 6" NumberType="Int")"));
  EXPECT_TRUE(contains(text, "0 0 0 0 0 0\n"));
  EXPECT_TRUE(contains(text, R"(Dimensions="1 3 2 3 4 3")"));
  EXPECT_FALSE(contains(text, "CoRect"));

  auto header = crystal_header();
  header.cell_sites = 1;
  write_crystal<double>(path, header, 1, {.overwrite = true, .xdmf = true, .positions = positions});
  EXPECT_EQ(extents_of(path, "/positions"), (Extents{6, 3, 4, 3}));
  EXPECT_TRUE(
      contains(read_bytes(folder_ / "a.xdmf"), R"(<DataItem Dimensions="6 3 4 3" NumberType)"));
}

TEST_F(TrajectoryTest, PositionsAreThoseOfAllSites) {
  auto const path = folder_ / "a.h5";
  EXPECT_THROW(RunOutput(path, crystal_header(), {.positions = numbered_positions(71)}),
               std::invalid_argument);
  EXPECT_THROW(RunOutput(path, crystal_header(), {.xdmf = true}), std::invalid_argument);
  EXPECT_FALSE(std::filesystem::exists(path));
}

}  // namespace
}  // namespace cayspin::inline v0_2::io
