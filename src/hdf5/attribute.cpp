// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "attribute.hpp"

#include "error.hpp"

#include <algorithm>

namespace cayspin::inline v0_2::io {
namespace {

std::string action(char const* verb, char const* name) {
  return std::string("cannot ") + verb + " attribute " + name;
}

}  // namespace

DatatypeHandle text_type() {
  DatatypeHandle type(H5Tcopy(H5T_C_S1));
  H5Tset_size(type.get(), H5T_VARIABLE);
  H5Tset_cset(type.get(), H5T_CSET_UTF8);
  return type;
}

void write_names(hid_t object, char const* name, std::vector<std::string> const& names,
                 std::filesystem::path const& path) {
  std::size_t length = 1;
  for (auto const& text : names) length = std::max(length, text.size());
  std::string texts;
  for (auto text : names) {
    text.resize(length, '\0');
    texts += text;
  }
  DatatypeHandle const type(H5Tcopy(H5T_C_S1));
  H5Tset_size(type.get(), length);
  H5Tset_strpad(type.get(), H5T_STR_NULLPAD);
  hsize_t const count = names.size();
  DataspaceHandle const space(H5Screate_simple(1, &count, nullptr));
  AttributeHandle const attribute(
      check(H5Acreate2(object, name, type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT), path,
            action("create", name)));
  check(H5Awrite(attribute.get(), type.get(), texts.data()), path, action("write", name));
}

std::vector<std::string> read_names(hid_t object, char const* name,
                                    std::filesystem::path const& path) {
  AttributeHandle const attribute(
      check(H5Aopen(object, name, H5P_DEFAULT), path, action("open", name)));
  DatatypeHandle const type(check(H5Aget_type(attribute.get()), path, action("read", name)));
  DataspaceHandle const space(check(H5Aget_space(attribute.get()), path, action("read", name)));
  auto const count = H5Sget_simple_extent_npoints(space.get());
  auto const length = H5Tget_size(type.get());
  constexpr hssize_t most = 65536;  // bytes; HDF5's limit on an attribute
  if (H5Tget_class(type.get()) != H5T_STRING || H5Tis_variable_str(type.get()) != 0 || count < 1 ||
      count > most || length < 1 || length > most)
    throw_failure(path, action("read", name), "it is not a list of names");
  std::string texts(static_cast<std::size_t>(count) * length, '\0');
  check(H5Aread(attribute.get(), type.get(), texts.data()), path, action("read", name));
  std::vector<std::string> names;
  for (std::size_t begin = 0; begin < texts.size(); begin += length) {
    auto text = texts.substr(begin, length);
    text.erase(std::min(text.find('\0'), text.size()));
    names.push_back(text);
  }
  return names;
}

void RootAttributes::create(char const* name, hid_t stored, hid_t given, void const* value) const {
  DataspaceHandle const scalar(H5Screate(H5S_SCALAR));
  AttributeHandle const attribute(
      check(H5Acreate2(file_, name, stored, scalar.get(), H5P_DEFAULT, H5P_DEFAULT), path_,
            action("create", name)));
  check(H5Awrite(attribute.get(), given, value), path_, action("write", name));
}

void RootAttributes::create(char const* name, std::string const& value) const {
  auto const type = text_type();
  auto const* text = value.c_str();
  create(name, type.get(), type.get(), &text);
}

void RootAttributes::create(char const* name, std::int64_t value) const {
  create(name, H5T_STD_I64LE, H5T_NATIVE_INT64, &value);
}

void RootAttributes::create(char const* name, double value) const {
  create(name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, &value);
}

bool RootAttributes::has(char const* name) const { return H5Aexists(file_, name) > 0; }

AttributeHandle RootAttributes::open(char const* name) const {
  if (!has(name)) throw_failure(path_, action("read", name), "it is not there");
  return AttributeHandle(check(H5Aopen(file_, name, H5P_DEFAULT), path_, action("open", name)));
}

void RootAttributes::replace(char const* name, hid_t given, void const* value) const {
  auto const attribute = open(name);
  check(H5Awrite(attribute.get(), given, value), path_, action("write", name));
}

void RootAttributes::replace(char const* name, std::int64_t value) const {
  replace(name, H5T_NATIVE_INT64, &value);
}

void RootAttributes::replace(char const* name, double value) const {
  replace(name, H5T_NATIVE_DOUBLE, &value);
}

void RootAttributes::read(char const* name, hid_t wanted, void* value) const {
  auto const attribute = open(name);
  DataspaceHandle const space(check(H5Aget_space(attribute.get()), path_, action("read", name)));
  if (H5Sget_simple_extent_npoints(space.get()) != 1)
    throw_failure(path_, action("read", name), "it is not one value");
  check(H5Aread(attribute.get(), wanted, value), path_, action("read", name));
}

std::string RootAttributes::read_text(char const* name) const {
  char* text = nullptr;
  read(name, text_type().get(), &text);
  std::string const value = text ? text : "";
  H5free_memory(text);
  return value;
}

bool RootAttributes::read_word(char const* name, char const* yes, char const* no) const {
  auto const text = read_text(name);
  if (text != yes && text != no)
    throw_failure(path_, std::string("cannot read attribute ") + name,
                  std::string("it is neither ") + yes + " nor " + no);
  return text == yes;
}

std::int64_t RootAttributes::read_integer(char const* name) const {
  std::int64_t value = 0;
  read(name, H5T_NATIVE_INT64, &value);
  return value;
}

double RootAttributes::read_real(char const* name) const {
  double value = 0;
  read(name, H5T_NATIVE_DOUBLE, &value);
  return value;
}

void RootAttributes::require_version(char const* name, std::int64_t accepted,
                                     char const* action) const {
  auto const version = read_integer(name);
  if (version != accepted)
    throw_failure(
        path_, action,
        "its format is " + std::to_string(version) + "; accepted: " + std::to_string(accepted));
}

}  // namespace cayspin::inline v0_2::io
