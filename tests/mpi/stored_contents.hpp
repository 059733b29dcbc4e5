// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "hdf5/handle.hpp"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace cayspin::program::test {

/// The bytes of each dataset and attribute of an HDF5 file, behind their extents; by name, that of
/// an attribute being OBJECT@NAME.
using Contents = std::map<std::string, std::string>;

inline std::string extents_text(hid_t space) {
  std::vector<hsize_t> extents(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space)));
  H5Sget_simple_extent_dims(space, extents.data(), nullptr);
  std::string text = "(";
  for (auto const extent : extents) text += std::to_string(extent) + ",";
  return text + ") ";
}

inline void add_attributes(hid_t object, std::string const& name, Contents& contents) {
  for (int number = 0; number < H5Aget_num_attrs(object); ++number) {
    io::AttributeHandle const attribute(H5Aopen_by_idx(object, ".", H5_INDEX_NAME, H5_ITER_INC,
                                                       static_cast<hsize_t>(number), H5P_DEFAULT,
                                                       H5P_DEFAULT));
    io::DataspaceHandle const space(H5Aget_space(attribute.get()));
    io::DatatypeHandle const type(H5Aget_type(attribute.get()));
    std::string key(200, ' '), bytes;
    key.resize(static_cast<std::size_t>(H5Aget_name(attribute.get(), key.size(), key.data())));
    if (H5Tis_variable_str(type.get()) > 0) {
      char* text = nullptr;
      H5Aread(attribute.get(), type.get(), &text);
      bytes = text;
      H5free_memory(text);
    } else {
      bytes.resize(H5Tget_size(type.get()) *
                   static_cast<std::size_t>(H5Sget_simple_extent_npoints(space.get())));
      H5Aread(attribute.get(), type.get(), bytes.data());
    }
    contents[name + "@" + key] = extents_text(space.get()) + bytes;
  }
}

inline void add_object(hid_t object, std::string const& name, Contents& contents) {
  add_attributes(object, name, contents);
  if (H5Iget_type(object) == H5I_DATASET) {
    io::DataspaceHandle const space(H5Dget_space(object));
    io::DatatypeHandle const type(H5Dget_type(object));
    std::string bytes(H5Tget_size(type.get()) *
                          static_cast<std::size_t>(H5Sget_simple_extent_npoints(space.get())),
                      ' ');
    H5Dread(object, type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data());
    contents[name] = extents_text(space.get()) + bytes;
    return;
  }
  H5G_info_t info{};
  H5Gget_info(object, &info);
  for (hsize_t number = 0; number < info.nlinks; ++number) {
    std::string key(200, ' ');
    key.resize(static_cast<std::size_t>(H5Lget_name_by_idx(
        object, ".", H5_INDEX_NAME, H5_ITER_INC, number, key.data(), key.size(), H5P_DEFAULT)));
    io::Handle<H5Oclose> const member(H5Oopen(object, key.c_str(), H5P_DEFAULT));
    add_object(member.get(), name + "/" + key, contents);
  }
}

inline Contents contents_of(std::filesystem::path const& path) {
  Contents contents;
  io::FileHandle const file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT));
  io::GroupHandle const root(H5Gopen2(file.get(), "/", H5P_DEFAULT));
  add_object(root.get(), "", contents);
  return contents;
}

}  // namespace cayspin::program::test
