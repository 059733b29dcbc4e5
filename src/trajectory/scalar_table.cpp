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

namespace cayspin::inline v0_2::io {

ScalarTable::ScalarTable(std::filesystem::path path, bool in_si, bool overwrite,
                         MoreScalars const& more)
    : path_(std::move(path)) {
  FileBeside file(path_, overwrite);
  auto const joule = in_si ? "J" : "";
  auto names = fmt::format("# t ({})\tmx ()\tmy ()\tmz ()\tE_total ({})\tnorm_defect ()",
                           in_si ? "s" : "", joule);
  for (std::int64_t region = 0; region < more.regions; ++region)
    for (char const axis : {'x', 'y', 'z'}) names += fmt::format("\tm{}_region{} ()", axis, region);
  for (std::int64_t region = 0; region < more.regions; ++region)
    names += fmt::format("\tE_region{} ({})", region, joule);
  for (auto const& term : more.terms) names += fmt::format("\tE_{} ({})", term, joule);
  if (more.shift) names += "\tshift (cells)";
  file.stream() << names << '\n';
  file.commit();
  file_ = ::open(path_.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  if (file_ < 0)
    throw std::runtime_error(
        fmt::format("{}: cannot write the file: {}", path_.string(), std::strerror(errno)));
}

ScalarTable::~ScalarTable() {
  if (file_ >= 0) ::close(file_);
}

void ScalarTable::append(std::vector<Line> const& samples) {
  fmt::memory_buffer lines;
  auto const at_end = std::back_inserter(lines);
  for (auto const& [sample, more] : samples) {
    auto const& scalars = sample.scalars;
    auto const& m = scalars.magnetization;
    fmt::format_to(at_end, "{}\t{}\t{}\t{}\t{}\t{}", sample.time, m[0], m[1], m[2], scalars.energy,
                   scalars.norm_defect);
    for (double const number : more) fmt::format_to(at_end, "\t{}", number);
    lines.push_back('\n');
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

}  // namespace cayspin::inline v0_2::io
