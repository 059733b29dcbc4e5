// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "scalar_table.hpp"

#include "files/file_beside.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <iterator>
#include <stdexcept>
#include <utility>

namespace cayspin::inline v0_1::io {

ScalarTable::ScalarTable(std::filesystem::path path, bool in_si, bool overwrite)
    : path_(std::move(path)) {
  FileBeside file(path_, overwrite);
  file.stream() << fmt::format("# t ({})\tmx ()\tmy ()\tmz ()\tE_total ({})\tnorm_defect ()\n",
                               in_si ? "s" : "", in_si ? "J" : "");
  file.commit();
  file_ = ::open(path_.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  if (file_ < 0)
    throw std::runtime_error(
        fmt::format("{}: cannot write the file: {}", path_.string(), std::strerror(errno)));
}

ScalarTable::~ScalarTable() {
  if (file_ >= 0) ::close(file_);
}

void ScalarTable::append(std::vector<Sample> const& samples) {
  fmt::memory_buffer lines;
  for (auto const& [step, time, scalars] : samples) {
    auto const& m = scalars.magnetization;
    fmt::format_to(std::back_inserter(lines), "{}\t{}\t{}\t{}\t{}\t{}\n", time, m[0], m[1], m[2],
                   scalars.energy, scalars.norm_defect);
  }
  auto const before = ::lseek(file_, 0, SEEK_END);
  for (std::size_t done = 0; done < lines.size();) {
    auto const count = ::write(file_, lines.data() + done, lines.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) {
      auto const reason = std::strerror(count < 0 ? errno : ENOSPC);
      [[maybe_unused]] auto const result = ::ftruncate(file_, before);
      throw std::runtime_error(
          fmt::format("{}: cannot write the file: {}", path_.string(), reason));
    }
    done += static_cast<std::size_t>(count);
  }
}

}  // namespace cayspin::inline v0_1::io
