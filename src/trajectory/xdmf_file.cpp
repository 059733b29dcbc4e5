// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "xdmf_file.hpp"

#include "files/file_beside.hpp"

#include <fmt/format.h>

#include <utility>

namespace cayspin::inline v0_1::io {
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

}  // namespace

// XDMF lists the axes as HDF5 does, z first.
XdmfFile::XdmfFile(std::filesystem::path path, std::filesystem::path const& trajectory,
                   std::array<std::int64_t, 3> const& shape, std::array<double, 3> const& spacing,
                   bool single, bool overwrite)
    : path_(std::move(path)), shape_(shape) {
  grid_ = fmt::format(
      R"(        <Topology TopologyType="3DCoRectMesh" Dimensions="{} {} {}"/>
        <Geometry GeometryType="ORIGIN_DXDYDZ">
          <DataItem Dimensions="3" NumberType="Float" Precision="8" Format="XML">{} {} {}</DataItem>
          <DataItem Dimensions="3" NumberType="Float" Precision="8" Format="XML">{} {} {}</DataItem>
        </Geometry>
)",
      shape[2], shape[1], shape[0], spacing[2] / 2, spacing[1] / 2, spacing[0] / 2, spacing[2],
      spacing[1], spacing[0]);
  spins_ = fmt::format(R"(NumberType="Float" Precision="{}" Format="HDF">{}:/spins)",
                       single ? 4 : 8, escaped(trajectory.filename().string()));
  write(overwrite);
}

void XdmfFile::add_frame(double time) {
  auto const extents = fmt::format("{} {} {} 3", shape_[2], shape_[1], shape_[0]);
  frames_ += fmt::format(
      R"(      <Grid Name="frame {0}" GridType="Uniform">
        <Time Value="{1}"/>
{2}        <Attribute Name="m" AttributeType="Vector" Center="Node">
          <DataItem ItemType="HyperSlab" Dimensions="{3}">
            <DataItem Dimensions="3 5" NumberType="Int" Format="XML">
              {0} 0 0 0 0
              1 1 1 1 1
              1 {3}
            </DataItem>
            <DataItem Dimensions="{4} {3}" {5}</DataItem>
          </DataItem>
        </Attribute>
      </Grid>
)",
      count_, time, grid_, extents, count_ + 1, spins_);
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

}  // namespace cayspin::inline v0_1::io
