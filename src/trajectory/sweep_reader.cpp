// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "hdf5/attribute.hpp"
#include "hdf5/error.hpp"
#include "hdf5/survives.hpp"
#include "sweep_format.hpp"

#include <cayspin/io/sweep.hpp>

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

namespace cayspin::inline v0_1::io {
namespace {

namespace fs = std::filesystem;

class Reader {
 public:
  Reader(hid_t file, fs::path const& path) : file_(file), path_(path) {}

  std::vector<std::string> texts(char const* name, Extents const& extents) const {
    auto const dataset = open(file_, name, extents);
    auto const type = text_type();
    std::vector<char*> pointers(count(extents));
    read(dataset.get(), type.get(), pointers.data(), name);
    std::vector<std::string> values;
    for (auto* const pointer : pointers) {
      values.emplace_back(pointer ? pointer : "");
      H5free_memory(pointer);
    }
    return values;
  }

  template <class Value>
  std::vector<Value> column(char const* name, std::size_t runs) const {
    return column<Value>(file_, name, runs);
  }

  template <class Value>
  std::vector<Value> column(hid_t group, char const* name, std::size_t runs) const {
    constexpr bool is_triple = sizeof(Value) == 3 * sizeof(double);
    auto const dataset = open(group, name, is_triple ? Extents{runs, 3} : Extents{runs});
    std::vector<Value> values(runs);
    read(dataset.get(), std::is_same_v<Value, std::int64_t> ? H5T_NATIVE_INT64 : H5T_NATIVE_DOUBLE,
         values.data(), name);
    return values;
  }

  Extents extents(char const* name) const {
    return dataset_extents(open_dataset(file_, name, path_).get(), path_);
  }

  GroupHandle group(char const* name) const {
    return GroupHandle(
        check(H5Gopen2(file_, name, H5P_DEFAULT), path_, std::string("cannot open group ") + name));
  }

 private:
  static std::size_t count(Extents const& extents) {
    std::size_t count = 1;
    for (auto const extent : extents) count *= extent;
    return count;
  }

  DatasetHandle open(hid_t group, char const* name, Extents const& extents) const {
    auto dataset = open_dataset(group, name, path_);
    if (dataset_extents(dataset.get(), path_) != extents)
      throw_failure(path_, std::string("cannot read dataset ") + name,
                    "it does not have a value for each run");
    return dataset;
  }

  void read(hid_t dataset, hid_t type, void* values, char const* name) const {
    check(H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), path_,
          std::string("cannot read dataset ") + name);
  }

  hid_t file_;
  fs::path const& path_;
};

// The values of each key, in the order in which they come.
std::vector<SweptKey> read_keys(Reader const& reader, fs::path const& path) {
  auto const extents = reader.extents("values");
  if (extents.size() != 2) throw_failure(path, "cannot read dataset values", "its rank is not 2");
  std::size_t const runs = extents[0], count = extents[1];
  auto const names = reader.texts("keys", {count});
  auto const values = reader.texts("values", extents);
  auto const parameters = reader.group("parameters");
  std::vector<SweptKey> keys;
  for (std::size_t k = 0; k < count; ++k) {
    std::optional<std::vector<double>> numbers;
    if (H5Lexists(parameters.get(), names[k].c_str(), H5P_DEFAULT) > 0)
      numbers = reader.column<double>(parameters.get(), names[k].c_str(), runs);
    auto& key = keys.emplace_back(SweptKey{names[k], {}, {}});
    for (std::size_t run = 0; run < runs; ++run) {
      auto const& value = values[run * count + k];
      if (std::ranges::find(key.values, value) != key.values.end()) continue;
      key.values.push_back(value);
      if (numbers) key.numbers.push_back((*numbers)[run]);
    }
  }
  return keys;
}

std::vector<SweptRun> read_results(Reader const& reader, std::size_t count) {
  auto const status = reader.column<std::int64_t>("status", count);
  auto const message = reader.texts("message", {count});
  auto const step = reader.column<std::int64_t>("step", count);
  auto const time = reader.column<double>("time", count);
  std::vector<Scalars> scalars(count);
  for_each_scalar([&]<class Value>(char const* name, Value Scalars::*member) {
    auto const column = reader.column<Value>(name, count);
    for (std::size_t i = 0; i < count; ++i) scalars[i].*member = column[i];
  });
  auto const evaluations = reader.column<std::int64_t>("evaluations", count);
  auto const wall = reader.column<double>("wall_seconds", count);
  auto const stepping = reader.column<double>("step_seconds", count);
  auto const files = reader.group("runs");
  std::vector<SweptRun> runs(count);
  for (std::size_t i = 0; i < count; ++i) {
    auto const name = swept_run_name(static_cast<std::int64_t>(i));
    runs[i] = {status[i],
               message[i],
               step[i],
               time[i],
               scalars[i],
               {evaluations[i], wall[i], stepping[i]},
               H5Lexists(files.get(), name.c_str(), H5P_DEFAULT) > 0};
  }
  return runs;
}

// Links to other files are those of runs that are not in the file itself.
bool has_external_link(hid_t runs) {
  bool found = false;
  auto const look = [](hid_t, char const*, H5L_info_t const* info, void* data) -> herr_t {
    *static_cast<bool*>(data) = info->type == H5L_TYPE_EXTERNAL;
    return 1;  // the first one tells
  };
  H5Literate(runs, H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, look, &found);
  return found;
}

bool has_sweep_format(fs::path const& path) {
  auto const file = open_file(path);
  return RootAttributes(file.get(), path).has(sweep_format);
}

SweepInfo read_whole_sweep(fs::path const& path) {
  auto const file = open_file(path);
  RootAttributes const attributes(file.get(), path);
  if (!attributes.has(sweep_format)) throw_failure(path, "cannot read the sweep", "it holds none");
  if (auto const format = attributes.read_integer(sweep_format); format != sweep_format_version)
    throw_failure(path, "cannot read the sweep",
                  "its format is " + std::to_string(format) + "; accepted is " +
                      std::to_string(sweep_format_version));
  Reader const reader(file.get(), path);
  SweepInfo sweep;
  sweep.header.scene_text = attributes.read_text("scene");
  sweep.header.keys = read_keys(reader, path);
  sweep.header.precision = attributes.read_text("precision");
  sweep.header.space = attributes.read_text("space");
  sweep.header.cayspin_version = attributes.read_text("cayspin_version");
  sweep.header.git_commit = attributes.read_text("git_commit");
  sweep.complete = attributes.read_integer("complete") == 1;
  sweep.runs = read_results(reader, static_cast<std::size_t>(sweep.header.runs()));
  sweep.one_file = sweep.complete && !has_external_link(reader.group("runs").get());
  return sweep;
}

}  // namespace

bool is_sweep(fs::path const& path) {
  QuietErrors const quiet;
  return read_guarded(path, [&] { return has_sweep_format(path); });
}

SweepInfo read_sweep(fs::path const& path) {
  QuietErrors const quiet;
  return read_guarded(path, [&] { return read_whole_sweep(path); });
}

}  // namespace cayspin::inline v0_1::io
