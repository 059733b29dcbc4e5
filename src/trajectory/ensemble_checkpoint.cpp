// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "io/ensemble_checkpoint.hpp"

#include "files/durable.hpp"
#include "fletcher32.hpp"
#include "format.hpp"
#include "hdf5/attribute.hpp"
#include "hdf5/dataset.hpp"
#include "hdf5/error.hpp"
#include "hdf5/guarded_reading.hpp"
#include "new_file.hpp"
#include "open_file_space.hpp"
#include "require.hpp"

#include <algorithm>
#include <cstring>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>

namespace cayspin::inline v0_2::io {
namespace {

constexpr char const* ensemble_mark = "ensemble_checkpoint_format";
constexpr char const* ensemble_sum_mark = "checksum";
constexpr std::int64_t ensemble_checkpoint_version = 1;
constexpr std::uint64_t ensemble_checkpoint_overhead = 64 * 1024;
constexpr hsize_t bytes_of_chunk = 1 << 20;
constexpr char const* cannot_read = "cannot read the checkpoint";

// Never 0: otherwise zeros in place of a state and its checksum would be valid.
std::int64_t checksum_of(std::span<std::byte const> bytes) {
  return std::int64_t{1} + fletcher32(bytes);
}

class PackedBytes {
 public:
  std::vector<std::byte> all;

  template <class Number>
  void add(Number const& number) {
    add_bytes(&number, sizeof(Number));
  }
  void add(std::string const& text) {
    add(static_cast<std::int64_t>(text.size()));
    add_bytes(text.data(), text.size());
  }
  template <class Number>
  void add(std::vector<Number> const& numbers) {
    add(static_cast<std::int64_t>(numbers.size()));
    add_bytes(numbers.data(), numbers.size() * sizeof(Number));
  }
  // A checksum ignores the last of an odd number of bytes.
  void end() {
    if (all.size() % 2 != 0) all.emplace_back();
  }

 private:
  void add_bytes(void const* from, std::size_t count) {
    auto const* const bytes = static_cast<std::byte const*>(from);
    all.insert(all.end(), bytes, bytes + count);
  }
};

class UnpackedBytes {
 public:
  UnpackedBytes(std::span<std::byte const> bytes, std::filesystem::path const& path)
      : left_(bytes), path_(path) {}

  template <class Number>
  Number number() {
    Number value;
    take(&value, sizeof value);
    return value;
  }
  std::string text() {
    std::string text(count(1), ' ');
    take(text.data(), text.size());
    return text;
  }
  std::vector<double> numbers() {
    std::vector<double> numbers(count(sizeof(double)));
    take(numbers.data(), numbers.size() * sizeof(double));
    return numbers;
  }

 private:
  std::size_t count(std::size_t bytes_of_one) {
    auto const count = number<std::int64_t>();
    if (count < 0 || static_cast<std::size_t>(count) > left_.size() / bytes_of_one) refuse();
    return static_cast<std::size_t>(count);
  }
  void take(void* to, std::size_t count) {
    if (count > left_.size()) refuse();
    if (count > 0) std::memcpy(to, left_.data(), count);
    left_ = left_.subspan(count);
  }
  [[noreturn]] void refuse() const {
    throw_failure(path_, "cannot read dataset state", "a state ends too early");
  }

  std::span<std::byte const> left_;
  std::filesystem::path const& path_;
};

ReplicaState unpacked(std::span<std::byte const> bytes, std::filesystem::path const& path) {
  UnpackedBytes from(bytes, path);
  ReplicaState state;
  state.step = from.number<std::int64_t>();
  state.has_ended = from.number<std::int64_t>() != 0;
  for (auto left = from.number<std::int64_t>(); left > 0; --left) {
    auto const name = from.text();
    state.numbers[name] = from.number<double>();
  }
  for (auto left = from.number<std::int64_t>(); left > 0; --left) {
    auto const name = from.text();
    state.fields[name] = from.numbers();
  }
  state.close();
  return state;
}

// Returns the checksum of everything but the states.
std::int64_t checksum_of(EnsembleCheckpointInfo const& info) {
  PackedBytes bytes;
  auto const& header = info.header;
  for (auto const* const text : {&header.scene_text, &header.cayspin_version, &header.precision})
    bytes.add(*text);
  for (auto const number :
       {header.shape[0], header.shape[1], header.shape[2], header.cell_sites, header.step})
    bytes.add(number);
  bytes.add(header.time);
  bytes.add(std::int64_t{header.si});
  for (auto const* const of_replicas : {&info.begins, &info.ends, &info.checksums})
    bytes.add(*of_replicas);
  bytes.end();
  return checksum_of(std::span<std::byte const>(bytes.all));
}

}  // namespace

void ReplicaState::number(std::string const& name, double& value) {
  if (!restores_) {
    numbers[name] = value;
    return;
  }
  auto const found = numbers.find(name);
  if (found != numbers.end())
    value = found->second;
  else if (!is_of_guard(name))
    throw std::runtime_error("the checkpoint has no number " + name);
}

void ReplicaState::field(std::string const& name, std::vector<double>& values) {
  if (!restores_) {
    fields[name] = std::move(values);
    return;
  }
  auto const found = fields.find(name);
  if (found == fields.end()) throw std::runtime_error("the checkpoint has no field " + name);
  values = found->second;
}

std::vector<std::byte> state_bytes(ReplicaState const& state) {
  PackedBytes to;
  to.add(state.step);
  to.add(std::int64_t{state.has_ended});
  to.add(static_cast<std::int64_t>(state.numbers.size()));
  for (auto const& [name, number] : state.numbers) {
    to.add(name);
    to.add(number);
  }
  to.add(static_cast<std::int64_t>(state.fields.size()));
  for (auto const& [name, numbers] : state.fields) {
    to.add(name);
    to.add(numbers);
  }
  to.end();
  return std::move(to.all);
}

class EnsembleCheckpointWriter::Implementation {
 public:
  Implementation(std::filesystem::path path, CheckpointHeader const& header, std::int64_t replicas)
      : path_(std::move(path)), file_(path_, true, true), space_(file_.get(), path_) {
    auto const count = static_cast<std::size_t>(replicas);
    info_ = {header, std::vector<std::int64_t>(count), std::vector<std::int64_t>(count),
             std::vector<std::int64_t>(count)};
    space_.reserve(ensemble_checkpoint_overhead + header.scene_text.size() + 24 * count, path_);
    RootAttributes const attributes(file_.get(), path_);
    attributes.create(ensemble_mark, ensemble_checkpoint_version);
    attributes.create("cayspin_version", header.cayspin_version);
    attributes.create("scene", header.scene_text);
    attributes.create("precision", header.precision);
    attributes.create("nx", header.shape[0]);
    attributes.create("ny", header.shape[1]);
    attributes.create("nz", header.shape[2]);
    attributes.create("cell_sites", header.cell_sites);
    attributes.create("step", header.step);
    attributes.create("time", header.time);
    attributes.create("units", std::string(header.si ? si_units : reduced_units));
    Extents const chunk{bytes_of_chunk};
    states_ =
        create_growing_dataset(file_.get(), "state", H5T_STD_U8LE, chunk, PropertyHandle(), path_);
  }

  void add(std::vector<PackedReplica> const& replicas, std::vector<std::byte> const& states) {
    require_open();
    if (states.empty()) return;
    // A chunk takes its whole space when its first byte is written.
    space_.reserve(states.size() + 2 * bytes_of_chunk + ensemble_checkpoint_overhead, path_);
    append_block(states_.get(), H5T_NATIVE_UINT8, {static_cast<hsize_t>(size_)}, {states.size()},
                 states.data(), path_);
    std::size_t begin = 0;
    for (auto const& [number, bytes] : replicas) {
      auto const at = static_cast<std::size_t>(number);
      auto const count = static_cast<std::size_t>(bytes);
      info_.begins.at(at) = size_;
      info_.ends[at] = size_ += bytes;
      info_.checksums[at] = checksum_of(std::span(states).subspan(begin, count));
      begin += count;
    }
  }

  void commit() {
    require_open();
    if (std::ranges::find(info_.checksums, 0) != info_.checksums.end())
      throw std::logic_error(path_.string() + ": some replicas were not stored");
    std::string const action = "cannot write the file";
    for (auto const& [name, numbers] : {std::pair{"begin", &info_.begins},
                                        {"end", &info_.ends},
                                        {"state_checksum", &info_.checksums}})
      write_dataset(file_.get(), name, H5T_STD_I64LE, H5T_NATIVE_INT64, {numbers->size()},
                    numbers->data(), path_);
    RootAttributes(file_.get(), path_).create(ensemble_sum_mark, checksum_of(info_));
    states_.close();
    check(H5Fflush(file_.get(), H5F_SCOPE_GLOBAL), path_, action.c_str());
    space_.trim();
    if (int const error = space_.sync()) throw_failure(path_, action, std::strerror(error));
    auto committed = file_.commit();
    check(committed.close(), path_, action.c_str());
    if (int const error = sync_folder_of(path_)) throw_failure(path_, action, std::strerror(error));
  }

 private:
  void require_open() const {
    if (states_.get() < 0) throw std::logic_error(path_.string() + ": the checkpoint has ended");
  }

  std::filesystem::path path_;
  NewFile file_;
  OpenFileSpace space_;
  DatasetHandle states_;
  EnsembleCheckpointInfo info_;
  std::int64_t size_ = 0;
};

EnsembleCheckpointWriter::EnsembleCheckpointWriter(std::filesystem::path path,
                                                   CheckpointHeader const& header,
                                                   std::int64_t replicas) {
  require_precision(header.precision);
  require_shape(header.shape);
  QuietErrors const quiet;
  implementation_ = std::make_unique<Implementation>(std::move(path), header, replicas);
}
EnsembleCheckpointWriter::~EnsembleCheckpointWriter() {
  QuietErrors const quiet;
  implementation_.reset();
}
EnsembleCheckpointWriter::EnsembleCheckpointWriter(EnsembleCheckpointWriter&&) noexcept = default;

void EnsembleCheckpointWriter::add(std::vector<PackedReplica> const& replicas,
                                   std::vector<std::byte> const& states) {
  QuietErrors const quiet;
  not_moved(implementation_).add(replicas, states);
}

void EnsembleCheckpointWriter::commit() {
  QuietErrors const quiet;
  not_moved(implementation_).commit();
}

namespace {

std::vector<std::int64_t> read_of_replicas(hid_t file, char const* name, hsize_t replicas,
                                           std::filesystem::path const& path) {
  auto const dataset = open_dataset(file, name, 1, path);
  if (dataset_extents(dataset.get(), path)[0] != replicas)
    throw_failure(path, cannot_read, "its datasets are of different numbers of replicas");
  std::vector<std::int64_t> numbers(replicas);
  read_block(dataset.get(), H5T_NATIVE_INT64, {0}, {replicas}, numbers.data(), path);
  return numbers;
}

EnsembleCheckpointInfo read_whole_checkpoint(std::filesystem::path const& path) {
  auto const file = open_file(path);
  RootAttributes const attributes(file.get(), path);
  if (!attributes.has(ensemble_mark))
    throw_failure(path, cannot_read, "it is not one of an ensemble");
  attributes.require_version(ensemble_mark, ensemble_checkpoint_version, cannot_read);
  EnsembleCheckpointInfo info;
  auto& header = info.header;
  header.cayspin_version = attributes.read_text("cayspin_version");
  header.scene_text = attributes.read_text("scene");
  header.precision = attributes.read_text("precision");
  header.shape = {attributes.read_integer("nx"), attributes.read_integer("ny"),
                  attributes.read_integer("nz")};
  header.cell_sites = attributes.read_integer("cell_sites");
  header.step = attributes.read_integer("step");
  header.time = attributes.read_real("time");
  header.si = attributes.read_word("units", si_units, reduced_units);
  auto const replicas = dataset_extents(open_dataset(file.get(), "begin", 1, path).get(), path)[0];
  info.begins = read_of_replicas(file.get(), "begin", replicas, path);
  info.ends = read_of_replicas(file.get(), "end", replicas, path);
  info.checksums = read_of_replicas(file.get(), "state_checksum", replicas, path);
  if (attributes.read_integer(ensemble_sum_mark) != checksum_of(info))
    throw_failure(path, cannot_read, "its contents are not those written");
  return info;
}

std::vector<ReplicaState> read_states(std::filesystem::path const& path,
                                      EnsembleCheckpointInfo const& info,
                                      ReplicaRange const& replicas) {
  auto const file = open_file(path);
  auto const dataset = open_dataset(file.get(), "state", 1, path);
  std::vector<ReplicaState> states;
  std::vector<std::byte> bytes;
  for (std::int64_t number = 0; number < replicas.count; ++number) {
    auto const at = static_cast<std::size_t>(replicas.first + number);
    auto const begin = static_cast<hsize_t>(info.begins.at(at));
    auto const end = static_cast<hsize_t>(info.ends[at]);
    bytes.resize(end - begin);
    read_block(dataset.get(), H5T_NATIVE_UINT8, {begin}, {end - begin}, bytes.data(), path);
    if (checksum_of(std::span<std::byte const>(bytes)) != info.checksums[at])
      throw_failure(path, "cannot read dataset state", "its bytes are not those written");
    states.push_back(unpacked(bytes, path));
  }
  return states;
}

}  // namespace

bool is_ensemble_checkpoint(std::filesystem::path const& path) {
  QuietErrors const quiet;
  return read_guarded(path, [&] {
    auto const file = open_file(path);
    return RootAttributes(file.get(), path).has(ensemble_mark);
  });
}

EnsembleCheckpointInfo read_ensemble_checkpoint(std::filesystem::path const& path) {
  return read_guarded(path, [&] { return read_whole_checkpoint(path); });
}

std::vector<ReplicaState> read_replica_states(std::filesystem::path const& path,
                                              EnsembleCheckpointInfo const& info,
                                              ReplicaRange const& replicas) {
  return read_guarded(path, [&] { return read_states(path, info, replicas); });
}

}  // namespace cayspin::inline v0_2::io
