// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "numbers_file.hpp"

#include <fstream>
#include <stdexcept>

namespace cayspin::paper {

NumbersFile::NumbersFile(std::optional<std::filesystem::path> const& folder, std::string_view name,
                         std::string_view columns)
    : text_(fmt::format("{}\n", columns)) {
  if (folder) path_ = *folder / name;
}

void NumbersFile::write() const {
  if (!path_) return;
  auto const partial = path_->string() + ".partial";
  std::error_code error;
  std::filesystem::create_directories(path_->parent_path(), error);
  std::ofstream file(partial, std::ios::trunc);
  file << text_;
  file.close();
  if (file) std::filesystem::rename(partial, *path_, error);
  if (!file || error) {
    std::filesystem::remove(partial, error);
    throw std::runtime_error(fmt::format("{}: cannot be written", path_->string()));
  }
}

}  // namespace cayspin::paper
