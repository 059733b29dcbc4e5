// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "synced_file.hpp"

#include "error.hpp"
#include "files/durable.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <random>
#include <span>
#include <utility>
#include <vector>

namespace cayspin::inline v0_2::io {
namespace {

std::uint64_t sector_of(std::uint64_t offset) { return offset / sector_bytes * sector_bytes; }

std::uint64_t random_mark() {
  std::random_device device;
  return std::uint64_t{device()} << 32U | device();
}

}  // namespace

SyncedFile::SyncedFile() : mark_(random_mark()) {}

SyncedFile::~SyncedFile() {
  if (file_ >= 0) ::close(file_);
}

int SyncedFile::open(char const* name, int flags) {
  file_ = ::open(name, flags | O_CLOEXEC, 0666);
  struct stat status {};
  if (file_ < 0 || ::fstat(file_, &status) != 0) return errno;
  written_end = static_cast<std::uint64_t>(status.st_size);
  end = 0;
  return 0;
}

int SyncedFile::failed(int error) {
  if (error_ == 0) error_ = error;
  return error;
}

int SyncedFile::read(std::uint64_t offset, void* data, std::size_t bytes) const {
  if (int const error = read_all(file_, data, bytes, offset)) return error;
  auto* const to = static_cast<std::byte*>(data);
  for (auto over = over_.lower_bound(sector_of(offset));
       over != over_.end() && over->first < offset + bytes; ++over) {
    auto const begin = std::max(offset, over->first);
    auto const end_of_both = std::min(offset + bytes, over->first + sector_bytes);
    std::memcpy(to + (begin - offset), over->second.bytes.data() + (begin - over->first),
                end_of_both - begin);
  }
  return 0;
}

int SyncedFile::write(std::uint64_t offset, void const* data, std::size_t bytes) {
  auto const* const from = static_cast<std::byte const*>(data);
  auto const over = std::min<std::uint64_t>(bytes, std::max(committed_end_, offset) - offset);
  if (int const error = write_over(offset, from, over)) return failed(error);
  if (int const error = write_all(file_, from + over, bytes - over, offset + over))
    return failed(error);
  written_end = std::max(written_end, offset + bytes);
  return 0;
}

int SyncedFile::write_over(std::uint64_t offset, std::byte const* data, std::size_t bytes) {
  while (bytes > 0) {
    auto const begin = sector_of(offset);
    auto const part = std::min<std::size_t>(bytes, begin + sector_bytes - offset);
    auto const [over, is_new] = over_.try_emplace(begin, Sector{begin, {}});
    auto& sector = over->second.bytes;
    if (is_new && part < sector_bytes)
      if (int const error = read_all(file_, sector.data(), sector_bytes, begin)) return error;
    std::memcpy(sector.data() + (offset - begin), data, part);
    offset += part;
    data += part;
    bytes -= part;
  }
  return 0;
}

int SyncedFile::commit() {
  if (error_ != 0 || !journal_) return error_;
  if (int const error = put_appended_on_disk()) return failed(error);
  if (int const error = put_over_committed()) return failed(error);
  over_.clear();
  committed_end_ = sector_of(end + sector_bytes - 1);
  return 0;
}

// Also puts on disk the sectors that the last commit overwrote. After that, their journal may be
// reused.
int SyncedFile::put_appended_on_disk() const {
  struct stat status {};
  if (::fstat(file_, &status) != 0) return errno;
  if (static_cast<std::uint64_t>(status.st_size) < end &&
      ::ftruncate(file_, static_cast<off_t>(end)) != 0)
    return errno;
  return sync_file(file_);
}

int SyncedFile::put_over_committed() {
  std::vector<Sector> changed;
  for (auto const& [offset, sector] : over_) {
    std::array<std::byte, sector_bytes> before{};
    if (int const error = read_all(file_, before.data(), sector_bytes, offset)) return error;
    if (before != sector.bytes) changed.push_back(sector);
  }
  if (changed.empty()) return 0;
  if (int const error = journal_->write(changed)) return error;
  half_applied_ = true;
  for (auto const& sector : changed)
    if (int const error = write_all(file_, sector.bytes.data(), sector_bytes, sector.offset))
      return error;
  half_applied_ = false;
  return 0;
}

std::optional<std::uint64_t> SyncedFile::place_of_mark() const {
  std::vector<std::byte> bytes(end);
  if (read_all(file_, bytes.data(), bytes.size(), 0) != 0) return {};
  auto const mark = std::as_bytes(std::span(&mark_, 1));
  auto const found = std::search(bytes.begin(), bytes.end(), mark.begin(), mark.end());
  if (found == bytes.end()) return {};
  return static_cast<std::uint64_t>(found - bytes.begin());
}

void SyncedFile::begin(std::filesystem::path const& path) {
  auto const place = place_of_mark();
  if (!place) throw_failure(path, "cannot create the file", "its mark is not where it was written");
  if (int const error = put_appended_on_disk())
    throw_failure(path, "cannot create the file", std::strerror(error));
  journal_.emplace(path, FileMark{*place, mark_});
  committed_end_ = sector_of(end + sector_bytes - 1);
}

int SyncedFile::close() {
  int error = commit();
  // Once the overwritten sectors are on disk, the journal is not needed.
  if (journal_ && !half_applied_ && sync_file(file_) == 0) {
    if (error == 0 && ::ftruncate(file_, static_cast<off_t>(end)) != 0) error = errno;
    if (error == 0) error = sync_file(file_);
    journal_->remove();
  }
  journal_.reset();
  over_.clear();
  committed_end_ = 0;
  if (::close(std::exchange(file_, -1)) != 0 && error == 0) error = errno;
  return error;
}

}  // namespace cayspin::inline v0_2::io
