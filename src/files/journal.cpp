// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "journal.hpp"

#include "durable.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <vector>

namespace cayspin::inline v0_2::io {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t journal_magic =
    0x314c4e4a59414321;  // identifies the layout of journals and the byte order

struct Head {
  std::uint64_t magic, mark_offset, mark, sectors, checksum;
};
static_assert(sizeof(Sector) == sizeof(std::uint64_t) + sector_bytes);
static_assert(std::is_trivially_copyable_v<Sector> && std::is_trivially_copyable_v<Head>);

// Fletcher's sum would not do: it does not distinguish bytes of 0 from bytes of 0xff, and sectors
// full of either occur.
std::uint64_t checksum(Head head, std::span<Sector const> sectors) {
  head.checksum = 0;
  std::uint64_t hash = 0;
  auto const add = [&](std::span<std::byte const> bytes) {
    for (std::size_t i = 0; i < bytes.size(); i += sizeof(std::uint64_t)) {
      std::uint64_t word = 0;
      std::memcpy(&word, bytes.data() + i, sizeof word);
      hash = (hash ^ word) * 0x9E3779B97F4A7C15U;
      hash ^= hash >> 32U;
    }
  };
  add(std::as_bytes(std::span(&head, 1)));
  add(std::as_bytes(sectors));
  return hash;
}

fs::path journal_of(fs::path const& path) {
  std::error_code error;
  auto const file = fs::canonical(path, error);
  return (error ? path : file).string() + ".journal";
}

class Descriptor {
 public:
  explicit Descriptor(int file) : file_(file) {}
  Descriptor(Descriptor&& other) noexcept : file_(std::exchange(other.file_, -1)) {}
  Descriptor& operator=(Descriptor&&) = delete;
  ~Descriptor() {
    if (file_ >= 0) ::close(file_);
  }
  int get() const { return file_; }

 private:
  int file_;
};

// Returns true unless the file was removed, or replaced, before this process locked it.
bool has_name(int file, fs::path const& path) {
  struct stat open {
  }, named{};
  return ::fstat(file, &open) == 0 && ::stat(path.c_str(), &named) == 0 &&
         open.st_ino == named.st_ino && open.st_dev == named.st_dev;
}

struct Record {
  FileMark mark;
  std::vector<Sector> sectors;
};

// Returns nothing if the journal is incomplete. Such a journal is not needed, because the file is
// changed only after the whole journal is on the disk.
std::optional<Record> read_record(int file) {
  struct stat status {};
  Head head{};
  if (::fstat(file, &status) != 0 || read_all(file, &head, sizeof head, 0) != 0) return {};
  auto const room = static_cast<std::uint64_t>(status.st_size);
  if (head.magic != journal_magic || room < sizeof head ||
      head.sectors > (room - sizeof head) / sizeof(Sector))
    return {};
  Record record{{head.mark_offset, head.mark}, std::vector<Sector>(head.sectors)};
  if (read_all(file, record.sectors.data(), head.sectors * sizeof(Sector), sizeof head) != 0 ||
      head.checksum != checksum(head, record.sectors))
    return {};
  return record;
}

bool has_mark(int file, FileMark const& mark) {
  std::uint64_t found = 0;
  return read_all(file, &found, sizeof found, mark.offset) == 0 && found == mark.value;
}

bool has_all(int file, std::span<Sector const> sectors) {
  return std::ranges::all_of(sectors, [&](Sector const& sector) {
    std::array<std::byte, sector_bytes> found{};
    return read_all(file, found.data(), sector_bytes, sector.offset) == 0 && found == sector.bytes;
  });
}

int complete(fs::path const& path, std::span<Sector const> sectors) {
  Descriptor const file(::open(path.c_str(), O_RDWR | O_CLOEXEC));
  if (file.get() < 0) return errno;
  for (auto const& sector : sectors)
    if (int const error = write_all(file.get(), sector.bytes.data(), sector_bytes, sector.offset))
      return error;
  return sync_file(file.get());
}

}  // namespace

Journal::Journal(fs::path const& path, FileMark mark) : path_(journal_of(path)), mark_(mark) {
  auto const fail = [&](char const* reason) {
    if (file_ >= 0) ::close(file_);
    throw std::runtime_error(fmt::format("{}: cannot write the file: {}", path_.string(), reason));
  };
  do {
    if (file_ >= 0) ::close(file_);
    file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (file_ < 0) fail(std::strerror(errno));
    if (::flock(file_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
      fail("another program is writing it");
  } while (!has_name(file_, path_));
  if (::ftruncate(file_, 0) != 0) fail(std::strerror(errno));
}

Journal::~Journal() { ::close(file_); }

int Journal::write(std::span<Sector const> sectors) const {
  Head head{journal_magic, mark_.offset, mark_.value, sectors.size(), 0};
  head.checksum = checksum(head, sectors);
  if (int const error = write_all(file_, &head, sizeof head, 0)) return error;
  if (int const error = write_all(file_, sectors.data(), sectors.size_bytes(), sizeof head))
    return error;
  return sync_file(file_);
}

void Journal::remove() const { ::unlink(path_.c_str()); }

// Several readers may do this at once: they write the same bytes.
void complete_from_journal(fs::path const& path) {
  auto const beside = journal_of(path);
  Descriptor const journal(::open(beside.c_str(), O_RDONLY | O_CLOEXEC));
  if (journal.get() < 0) return;
  int const unlocked = ::flock(journal.get(), LOCK_SH | LOCK_NB) == 0 ? 0 : errno;
  if (unlocked == EWOULDBLOCK || !has_name(journal.get(), beside)) return;
  Descriptor const file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.get() < 0) return;
  if (auto const record = read_record(journal.get())) {
    if (!has_mark(file.get(), record->mark)) return;
    auto const error = has_all(file.get(), record->sectors) ? sync_file(file.get())
                       : unlocked != 0                      ? unlocked  // a writer may be active
                                                            : complete(path, record->sectors);
    if (error != 0)
      throw std::runtime_error(fmt::format("{}: cannot complete the file from {}: {}",
                                           path.string(), beside.string(), std::strerror(error)));
  }
  if (::flock(journal.get(), LOCK_EX | LOCK_NB) == 0 && has_name(journal.get(), beside))
    ::unlink(beside.c_str());
}

}  // namespace cayspin::inline v0_2::io
