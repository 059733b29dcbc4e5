// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "interactions_file.hpp"

#include "trajectory/fletcher32.hpp"

#include <unistd.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <span>
#include <system_error>
#include <type_traits>
#include <utility>

namespace cayspin::simulation {

namespace fs = std::filesystem;

namespace {

static_assert(std::is_trivially_copyable_v<DemagnetizingTensor>);

std::span<std::byte const> bytes_of(DemagnetizingTensors const& tensors) {
  return std::as_bytes(std::span(tensors));
}

std::uint32_t checksum(std::string const& head, DemagnetizingTensors const& tensors) {
  io::Fletcher32 sum;
  auto const even = head + (head.size() % 2 == 0 ? "" : " ");
  sum.add(std::as_bytes(std::span(even)));
  sum.add(bytes_of(tensors));
  return sum.value();
}

}  // namespace

InteractionsFile::InteractionsFile(fs::path path, std::string of)
    : path_(std::move(path)), head_("cayspin's demagnetising tensors 1: " + std::move(of) + "\n") {}

DemagnetizingTensors InteractionsFile::read_or(std::function<DemagnetizingTensors()> const& compute,
                                               double least_seconds) const {
  if (auto tensors = read(); !tensors.empty()) return tensors;
  auto const begin = std::chrono::steady_clock::now();
  auto tensors = compute();
  std::chrono::duration<double> const took = std::chrono::steady_clock::now() - begin;
  if (took.count() >= least_seconds) write(tensors);
  return tensors;
}

/// Returns the tensors of the file; empty if it is missing or damaged, or holds other tensors.
DemagnetizingTensors InteractionsFile::read() const {
  std::error_code error;
  auto const size = fs::file_size(path_, error);
  auto const rest = static_cast<std::uintmax_t>(head_.size()) + sizeof(std::uint32_t);
  if (error || size <= rest || (size - rest) % sizeof(DemagnetizingTensor) != 0) return {};
  std::ifstream file(path_, std::ios::binary);
  std::string head(head_.size(), ' ');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  if (!file || head != head_) return {};
  DemagnetizingTensors tensors((size - rest) / sizeof(DemagnetizingTensor));
  file.read(reinterpret_cast<char*>(tensors.data()),
            static_cast<std::streamsize>(bytes_of(tensors).size()));
  std::uint32_t sum = 0;
  file.read(reinterpret_cast<char*>(&sum), sizeof sum);
  if (!file || sum != checksum(head_, tensors)) return {};
  return tensors;
}

// Writes under a temporary name, then renames the file. Runs that start together may all do so,
// because they write equal contents.
void InteractionsFile::write(DemagnetizingTensors const& tensors) const {
  auto const partial = fs::path(path_.string() + ".partial" + std::to_string(::getpid()));
  std::error_code error;
  {
    std::ofstream file(partial, std::ios::binary);
    auto const sum = checksum(head_, tensors);
    file << head_;
    file.write(reinterpret_cast<char const*>(tensors.data()),
               static_cast<std::streamsize>(bytes_of(tensors).size()));
    file.write(reinterpret_cast<char const*>(&sum), sizeof sum);
    file.close();
    if (file) fs::rename(partial, path_, error);
    if (file && !error) return;
  }
  fs::remove(partial, error);
}

}  // namespace cayspin::simulation
