// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "column.hpp"
#include "files/durable.hpp"
#include "hdf5/attribute.hpp"
#include "hdf5/error.hpp"
#include "hdf5/guarded_reading.hpp"
#include "io/sweep.hpp"
#include "new_file.hpp"
#include "open_file_space.hpp"
#include "stored_spins.hpp"
#include "sweep_format.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <exception>
#include <filesystem>
#include <functional>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace cayspin::inline v0_2::io {
namespace {

namespace fs = std::filesystem;

constexpr char const *ending_of_sweep = ".partial", *ending_of_copies = ".runs.partial";

void write_texts(hid_t file, char const* name, Extents const& extents,
                 std::vector<std::string> const& values, fs::path const& path) {
  std::vector<char const*> pointers;
  for (auto const& value : values) pointers.push_back(value.c_str());
  auto const type = text_type();
  write_dataset(file, name, type.get(), type.get(), extents, pointers.data(), path);
}

void write_attributes(hid_t file, SweepInfo const& sweep, fs::path const& path) {
  RootAttributes const attributes(file, path);
  attributes.create(sweep_format, std::int64_t{sweep_format_version});
  attributes.create("scene", sweep.header.scene_text);
  attributes.create("cayspin_version", sweep.header.cayspin_version);
  attributes.create("git_commit", sweep.header.git_commit);
  attributes.create("precision", sweep.header.precision);
  attributes.create("space", sweep.header.space);
  attributes.create("complete", std::int64_t{sweep.complete ? 1 : 0});
}

void write_grid(hid_t file, SweepHeader const& header, fs::path const& path) {
  std::vector<std::string> names, values;
  for (auto const& key : header.keys) names.push_back(key.key);
  for (std::int64_t run = 0; run < header.runs(); ++run) {
    auto const chosen = header.indices(run);
    for (std::size_t key = 0; key < header.keys.size(); ++key)
      values.push_back(header.keys[key].values[chosen[key]]);
  }
  write_texts(file, "keys", {names.size()}, names, path);
  write_texts(file, "values", {static_cast<hsize_t>(header.runs()), names.size()}, values, path);
  auto const parameters = create_group(file, "parameters", path);
  for (std::size_t key = 0; key < header.keys.size(); ++key) {
    auto const& numbers = header.keys[key].numbers;
    if (numbers.empty()) continue;
    std::vector<double> of_runs;
    for (std::int64_t run = 0; run < header.runs(); ++run)
      of_runs.push_back(numbers[header.indices(run)[key]]);
    write_dataset(parameters.get(), names[key].c_str(), H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE,
                  {of_runs.size()}, of_runs.data(), path);
  }
}

void write_results(hid_t file, std::vector<SweptRun> const& runs, fs::path const& path) {
  auto const messages = values_of(runs, [](auto& run) -> auto& { return run.message; });
  write_texts(file, "message", {messages.size()}, messages, path);
  for_each_result([&](char const* name, auto const& member) {
    using Stored = Column<MemberValue<SweptRun, decltype(member)>>;
    write_dataset(file, name, Stored::type(), Stored::memory_type(), Stored::extents(runs.size()),
                  values_of(runs, member).data(), path);
  });
}

void require_whole(SweepInfo const& sweep) {
  for (auto const& key : sweep.header.keys) {
    if (key.values.empty()) throw std::invalid_argument("sweep key " + key.key + " has no values");
    if (!key.numbers.empty() && key.numbers.size() != key.values.size())
      throw std::invalid_argument(fmt::format("sweep key {} has {} numbers for {} values", key.key,
                                              key.numbers.size(), key.values.size()));
  }
  if (static_cast<std::int64_t>(sweep.runs.size()) != sweep.header.runs())
    throw std::invalid_argument("a sweep of " + std::to_string(sweep.header.runs()) + " runs has " +
                                std::to_string(sweep.runs.size()) + " results");
}

constexpr std::uint64_t room_beside_run = 65536;

// Returns the room for the index, and for the runs of `left`.
std::uint64_t room_for(fs::path const& path, SweepInfo const& sweep,
                       std::vector<std::int64_t> const& left) {
  std::uint64_t room = 1 << 20;
  for (auto const& run : sweep.runs) room += 2048 + 2 * run.message.size();
  if (!sweep.one_file) return room;
  for (auto const run : left) room += fs::file_size(swept_run_file(path, run)) + room_beside_run;
  return room;
}

constexpr std::uintmax_t most_bytes_in_memory = 4 << 20;

void copy_run(fs::path const& file, hid_t group, std::string const& name) {
  auto const from =
      fs::file_size(file) <= most_bytes_in_memory ? open_file_in_memory(file) : open_file(file);
  check(H5Ocopy(from.get(), "/", group, name.c_str(), H5P_DEFAULT, H5P_DEFAULT), file,
        "cannot copy the run into the sweep");
}

// Reads every frame and tries the copy, because the runs' own files are removed afterwards, and
// HDF5 may crash on a damaged file. (New files are not tried. If HDF5 crashes on one of them, all
// files are still there, and the next sweep tries them.)
void try_copies(std::vector<fs::path> const& files) {
  auto const trial = files.front().string() + ".trial";
  auto const read_and_copy = [&] {
    FileHandle const copy(check(H5Fcreate(trial.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT),
                                trial, "cannot create the file"));
    for (auto const& file : files) {
      auto const info = read_info(file);
      StoredSpins const spins(file, info.header.shape, info.header.cell_sites);
      for (std::int64_t frame = 0; frame < info.frames; ++frame) spins.frame(frame);
      copy_run(file, copy.get(), file.filename().string());
    }
  };
  try {
    try_reading(files.front(), read_and_copy);
  } catch (...) {
    fs::remove(trial);
    throw;
  }
  fs::remove(trial);
}

// All files share one trial, which may start a process. If it fails, each file gets a separate
// trial, to name the damaged one.
void require_whole(std::vector<fs::path> const& files) {
  if (files.empty()) return;
  try {
    try_copies(files);
  } catch (std::exception const&) {
    for (auto const& file : files) try_copies({file});
  }
}

// Calls take(runs) for these runs, several at a time where their files are small. Stops if `take`
// returns false, and returns false.
template <class Take>
bool for_each_group(fs::path const& path, std::vector<std::int64_t> const& runs, Take const& take) {
  constexpr std::size_t most_files = 64;
  std::vector<std::int64_t> group;
  std::uintmax_t bytes = 0;
  for (auto const number : runs) {
    std::error_code unknown;
    auto const size = fs::file_size(swept_run_file(path, number), unknown);
    bool const is_full =
        group.size() == most_files || unknown || bytes + size > most_bytes_in_memory;
    if (!group.empty() && is_full) {
      if (!take(group)) return false;
      group.clear();
      bytes = 0;
    }
    group.push_back(number);
    bytes += size;
  }
  return group.empty() || take(group);
}

// Copies a group of runs into the file of the sweep, or links to their files. Links are relative,
// so that the folder and the file can be moved together.
void take_in(hid_t runs, fs::path const& path, SweepInfo const& sweep,
             std::vector<std::int64_t> const& group) {
  bool const copy = sweep.one_file;
  std::vector<fs::path> files, old;
  for (auto const run : group) {
    files.push_back(swept_run_file(path, run));
    if (!sweep.runs[static_cast<std::size_t>(run)].is_new) old.push_back(files.back());
  }
  if (copy) require_whole(old);
  for (std::size_t i = 0; i < group.size(); ++i) {
    auto const name = swept_run_name(group[i]);
    auto const& file = files[i];
    if (copy) {
      copy_run(file, runs, name);
      continue;
    }
    auto const relative = file.parent_path().filename() / file.filename();
    check(H5Lcreate_external(relative.c_str(), "/", runs, name.c_str(), H5P_DEFAULT, H5P_DEFAULT),
          path, "cannot link to " + file.string());
  }
}

}  // namespace

fs::path sweep_folder(fs::path const& file) { return file.string() + ".runs"; }

std::string swept_run_name(std::int64_t run) {
  auto const digits = std::to_string(run);
  return std::string(digits.size() < 4 ? 4 - digits.size() : 0, '0') + digits;
}

fs::path swept_run_file(fs::path const& file, std::int64_t run) {
  return sweep_folder(file) / (swept_run_name(run) + ".h5");
}

class SweepCopies::File {
 public:
  File(fs::path const& path, char const* ending)
      : file(path, true, true, nullptr, ending),
        space(file.get(), path),
        runs(create_group(file.get(), "runs", path)) {}

  NewFile file;
  OpenFileSpace space;
  GroupHandle runs;
  std::set<std::int64_t> copied;
};

SweepCopies::SweepCopies(fs::path file) : path_(std::move(file)) {}
SweepCopies::~SweepCopies() = default;

void SweepCopies::remove_left() const {
  std::error_code error;
  auto const target = fs::canonical(path_, error);
  if (!error) fs::remove(target.string() + ending_of_copies, error);
}

void SweepCopies::add(std::int64_t run) {
  if (failed_) return;
  QuietErrors const quiet;
  try {
    auto const file = swept_run_file(path_, run);
    auto const bytes = fs::file_size(file);
    if (bytes > most_bytes_in_memory) return;
    if (!file_) file_ = std::make_unique<File>(path_, ending_of_copies);
    if (!file_->space.has_plenty()) return;
    file_->space.reserve(bytes + room_beside_run, path_);
    copy_run(file, file_->runs.get(), swept_run_name(run));
    file_->copied.insert(run);
  } catch (std::exception const&) {
    file_.reset();
    failed_ = true;
  }
}

bool write_sweep(fs::path const& path, SweepInfo const& sweep, std::function<bool()> const& go_on,
                 SweepCopies* copies) {
  require_whole(sweep);
  QuietErrors const quiet;
  auto to = copies ? std::move(copies->file_) : nullptr;
  // With `copies`, the file has their ending even if there are none yet. So it replaces copies that
  // a killed sweep left.
  if (!to)
    to = std::make_unique<SweepCopies::File>(path, copies ? ending_of_copies : ending_of_sweep);
  auto& file = to->file;
  auto& space = to->space;
  auto const& copied = to->copied;
  std::vector<std::int64_t> left;
  for (std::int64_t run = 0; run < sweep.header.runs(); ++run)
    if (sweep.runs[static_cast<std::size_t>(run)].has_file && !copied.contains(run))
      left.push_back(run);
  space.reserve(room_for(path, sweep, left), path);
  write_attributes(file.get(), sweep, path);
  write_grid(file.get(), sweep.header, path);
  write_results(file.get(), sweep.runs, path);
  if (!for_each_group(path, left, [&](std::vector<std::int64_t> const& group) {
        if (go_on && !go_on()) return false;
        take_in(to->runs.get(), path, sweep, group);
        return true;
      }))
    return false;
  to->runs.close();
  check(H5Fflush(file.get(), H5F_SCOPE_GLOBAL), path, "cannot write the file");
  space.trim();
  // The runs' own files are removed once they are copied, so the copies must be on the disk.
  auto const require_on_disk = [&](int error) {
    if (error != 0) throw_failure(path, "cannot write the file", std::strerror(error));
  };
  if (sweep.one_file) require_on_disk(space.sync());
  auto handle = file.commit();
  check(handle.close(), path, "cannot close the file");
  if (sweep.one_file) require_on_disk(sync_folder_of(path));
  return true;
}

}  // namespace cayspin::inline v0_2::io
