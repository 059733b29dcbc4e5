// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "file_beside.hpp"

#include "durable.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace cayspin::inline v0_2::io {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void throw_unwritten(fs::path const& path, std::string_view reason) {
  throw std::runtime_error(fmt::format("{}: cannot write the file: {}", path.string(), reason));
}

}  // namespace

void require_free(fs::path const& path, bool overwrite) {
  std::error_code ignored;
  auto const status = fs::status(path, ignored);
  if (!fs::exists(status)) return;
  if (!fs::is_regular_file(status)) throw_unwritten(path, "it exists and is not a regular file");
  if (!overwrite)
    throw_unwritten(path, "it exists (choose another name, or overwrite with --overwrite)");
}

FileBeside::FileBeside(fs::path path, bool overwrite)
    : path_(std::move(path)), target_(followed(path_)), partial_(target_.string() + ".partial") {
  require_free(path_, overwrite);
  errno = 0;
  stream_.open(partial_, std::ios::binary | std::ios::trunc);
  if (!stream_) fail();
  errno = 0;
}

FileBeside::~FileBeside() {
  if (committed_) return;
  stream_.close();
  std::error_code ignored;
  fs::remove(partial_, ignored);
}

void FileBeside::commit() {
  stream_.close();
  if (!stream_) fail();
  std::error_code error;
  fs::rename(partial_, target_, error);
  if (error) throw_unwritten(path_, error.message());
  committed_ = true;
}

void FileBeside::fail() const {
  throw_unwritten(path_, errno == 0 ? "the disk is full" : std::strerror(errno));
}

}  // namespace cayspin::inline v0_2::io
