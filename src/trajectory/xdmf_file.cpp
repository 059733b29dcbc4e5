// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "xdmf_file.hpp"

#include "files/file_beside.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <utility>

namespace cayspin::inline v0_2::io {
namespace {

constexpr std::int64_t always_written = 1000;
constexpr auto rest_between_writes = std::chrono::seconds(1);

std::string escaped(std::string const& text) {
  std::string result;
  for (char const c : text) {
    if (c == '&')
      result += "&amp;";
    else if (c == '<')
      result += "&lt;";
    else if (c == '>')
      result += "&gt;";
    else
      result += c;
  }
  return result;
}

// XDMF lists the axes as HDF5 does, z first.
std::string grid_text(std::array<std::int64_t, 3> const& shape,
                      std::array<double, 3> const& spacing) {
  return fmt::format(
      R"(        <Topology TopologyType="3DCoRectMesh" Dimensions="{} {} {}"/>
        <Geometry GeometryType="ORIGIN_DXDYDZ">
          <DataItem Dimensions="3" NumberType="Float" Precision="8" Format="XML">{} {} {}</DataItem>
          <DataItem Dimensions="3" NumberType="Float" Precision="8" Format="XML">{} {} {}</DataItem>
        </Geometry>
)",
      shape[2], shape[1], shape[0], spacing[2] / 2, spacing[1] / 2, spacing[0] / 2, spacing[2],
      spacing[1], spacing[0]);
}

std::string points_text(std::array<std::int64_t, 3> const& shape, std::string const& extents,
                        std::string const& file) {
  return fmt::format(
      R"(        <Topology TopologyType="Polyvertex" NumberOfElements="{}" NodesPerElement="1"/>
        <Geometry GeometryType="XYZ">
          <DataItem Dimensions="{}" NumberType="Float" Precision="8" Format="HDF">{}:/positions</DataItem>
        </Geometry>
)",
      shape[0] * shape[1] * shape[2], extents, file);
}

}  // namespace

XdmfFile::XdmfFile(std::filesystem::path path, std::filesystem::path const& trajectory,
                   XdmfGrid const& grid, bool single, bool overwrite)
    : path_(std::move(path)) {
  auto const file = escaped(trajectory.filename().string());
  auto const& [nx, ny, nz] = grid.shape;
  if (grid.cell_sites > 1) extents_ = fmt::format("{} ", grid.cell_sites);
  extents_ += fmt::format("{} {} {} 3", nz / grid.cell_sites, ny, nx);
  grid_ = grid.has_positions ? points_text(grid.shape, extents_, file)
                             : grid_text(grid.shape, grid.spacing);
  spins_ = fmt::format(R"(NumberType="Float" Precision="{}" Format="HDF">{}:/spins)",
                       single ? 4 : 8, file);
  write(overwrite);
}

void XdmfFile::add_frame(double time) {
  auto const rank = 1 + std::ranges::count(extents_, ' ') + 1;
  std::string zeros, ones;
  for (std::ptrdiff_t axis = 1; axis < rank; ++axis) {
    zeros += " 0";
    ones += " 1";
  }
  frames_ += fmt::format(
      R"(      <Grid Name="frame {0}" GridType="Uniform">
        <Time Value="{1}"/>
{2}        <Attribute Name="m" AttributeType="Vector" Center="Node">
          <DataItem ItemType="HyperSlab" Dimensions="{3}">
            <DataItem Dimensions="3 {6}" NumberType="Int" Format="XML">
              {0}{7}
              1{8}
              1 {3}
            </DataItem>
            <DataItem Dimensions="{4} {3}" {5}</DataItem>
          </DataItem>
        </Attribute>
      </Grid>
)",
      count_, time, grid_, extents_, count_ + 1, spins_, rank, zeros, ones);
  ++count_;
  if (count_ <= always_written || Clock::now() - last_write_ > rest_between_writes) write(true);
}

void XdmfFile::finish() {
  if (written_ < count_) write(true);
}

void XdmfFile::write(bool overwrite) {
  FileBeside file(path_, overwrite);
  file.stream() << R"(<?xml version="1.0"?>
<Xdmf Version="2.0">
  <Domain>
    <Grid Name="cayspin" GridType="Collection" CollectionType="Temporal">
)" << frames_ << R"(    </Grid>
  </Domain>
</Xdmf>
)";
  file.commit();
  written_ = count_;
  last_write_ = Clock::now();
}

}  // namespace cayspin::inline v0_2::io
