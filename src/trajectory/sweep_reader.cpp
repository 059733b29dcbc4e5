// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "column.hpp"
#include "hdf5/attribute.hpp"
#include "hdf5/error.hpp"
#include "hdf5/guarded_reading.hpp"
#include "io/sweep.hpp"
#include "sweep_format.hpp"

#include <array>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace cayspin::inline v0_2::io {
namespace {

namespace fs = std::filesystem;

DatasetHandle open_of_extents(hid_t group, char const* name, Extents const& extents,
                              fs::path const& path) {
  auto dataset = open_dataset(group, name, path);
  if (dataset_extents(dataset.get(), path) != extents)
    throw_failure(path, std::string("cannot read dataset ") + name,
                  "it does not have a value for each run");
  return dataset;
}

void read_whole(hid_t dataset, hid_t type, char const* name, void* values, fs::path const& path) {
  check(H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), path,
        std::string("cannot read dataset ") + name);
}

std::vector<std::string> read_texts(hid_t file, char const* name, Extents const& extents,
                                    fs::path const& path) {
  auto const dataset = open_of_extents(file, name, extents, path);
  auto const type = text_type();
  std::vector<char*> pointers(elements(extents));
  read_whole(dataset.get(), type.get(), name, pointers.data(), path);
  std::vector<std::string> values;
  for (auto* const pointer : pointers) {
    values.emplace_back(pointer ? pointer : "");
    H5free_memory(pointer);
  }
  return values;
}

/// Reads a dataset with one or three numbers per run.
template <class Value>
std::vector<Value> read_column(hid_t group, char const* name, std::size_t runs,
                               fs::path const& path) {
  auto const dataset = open_of_extents(group, name, Column<Value>::extents(runs), path);
  std::vector<Value> values(runs);
  read_whole(dataset.get(), Column<Value>::memory_type(), name, values.data(), path);
  return values;
}

// Returns the keys with their values, both in the order of the file.
std::vector<SweptKey> read_keys(hid_t file, fs::path const& path) {
  auto const extents = dataset_extents(open_dataset(file, "values", path).get(), path);
  if (extents.size() != 2) throw_failure(path, "cannot read dataset values", "its rank is not 2");
  std::size_t const runs = extents[0], count = extents[1];
  auto const names = read_texts(file, "keys", {count}, path);
  auto const values = read_texts(file, "values", extents, path);
  auto const parameters = open_group(file, "parameters", path);
  std::vector<SweptKey> keys;
  for (std::size_t k = 0; k < count; ++k) {
    std::optional<std::vector<double>> numbers;
    if (H5Lexists(parameters.get(), names[k].c_str(), H5P_DEFAULT) > 0)
      numbers = read_column<double>(parameters.get(), names[k].c_str(), runs, path);
    auto& key = keys.emplace_back(SweptKey{names[k], {}, {}});
    std::set<std::string_view> seen;
    for (std::size_t run = 0; run < runs; ++run) {
      auto const& value = values[run * count + k];
      if (!seen.insert(value).second) continue;
      key.values.push_back(value);
      if (numbers) key.numbers.push_back((*numbers)[run]);
    }
  }
  return keys;
}

std::vector<SweptRun> read_results(hid_t file, std::size_t count, fs::path const& path) {
  std::vector<SweptRun> runs(count);
  auto const messages = read_texts(file, "message", {count}, path);
  for_each_result([&](char const* name, auto const& member) {
    using Value = MemberValue<SweptRun, decltype(member)>;
    auto const values = read_column<Value>(file, name, count, path);
    for (std::size_t i = 0; i < count; ++i) member(runs[i]) = values[i];
  });
  auto const files = open_group(file, "runs", path);
  for (std::size_t i = 0; i < count; ++i) {
    auto const name = swept_run_name(static_cast<std::int64_t>(i));
    runs[i].message = messages[i];
    runs[i].has_file = H5Lexists(files.get(), name.c_str(), H5P_DEFAULT) > 0;
  }
  return runs;
}

// Returns true if the runs are in separate files, to which this one links. All runs are alike, so
// only the first is examined.
bool has_external_link(hid_t runs) {
  bool found = false;
  auto const look = [](hid_t, char const*, H5L_info_t const* info, void* data) -> herr_t {
    *static_cast<bool*>(data) = info->type == H5L_TYPE_EXTERNAL;
    return 1;  // stops at the first one
  };
  H5Literate(runs, H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, look, &found);
  return found;
}

SweepInfo read_whole_sweep(fs::path const& path) {
  auto const file = open_file(path);
  RootAttributes const attributes(file.get(), path);
  if (!attributes.has(sweep_format)) throw_failure(path, "cannot read the sweep", "it holds none");
  attributes.require_version(sweep_format, sweep_format_version, "cannot read the sweep");
  SweepInfo sweep;
  sweep.header.scene_text = attributes.read_text("scene");
  sweep.header.keys = read_keys(file.get(), path);
  sweep.header.precision = attributes.read_text("precision");
  sweep.header.space = attributes.read_text("space");
  sweep.header.cayspin_version = attributes.read_text("cayspin_version");
  sweep.header.git_commit = attributes.read_text("git_commit");
  sweep.complete = attributes.read_integer("complete") == 1;
  sweep.runs = read_results(file.get(), static_cast<std::size_t>(sweep.header.runs()), path);
  sweep.one_file = sweep.complete && !has_external_link(open_group(file.get(), "runs", path).get());
  return sweep;
}

}  // namespace

bool is_sweep(fs::path const& path) {
  QuietErrors const quiet;
  return read_guarded(path, [&] {
    auto const file = open_file(path);
    return RootAttributes(file.get(), path).has(sweep_format);
  });
}

SweepInfo read_sweep(fs::path const& path) {
  QuietErrors const quiet;
  return read_guarded(path, [&] { return read_whole_sweep(path); });
}

}  // namespace cayspin::inline v0_2::io
