// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/demagnetization/tensor.hpp>

#include <filesystem>
#include <functional>
#include <string>

namespace cayspin::simulation {

/// Cache file for a demagnetising field's tensors, which can take long to compute. It holds a line
/// that identifies the tensors, their values, and a checksum.
class InteractionsFile {
 public:
  /// `of`: one line with everything that the tensors depend on.
  InteractionsFile(std::filesystem::path path, std::string of);

  /// Returns the tensors of the file. If it is missing or damaged, or holds other tensors, returns
  /// those of `compute`, and stores them if `compute` took at least `least_seconds` and the folder
  /// is writable.
  DemagnetizingTensors read_or(std::function<DemagnetizingTensors()> const& compute,
                               double least_seconds = 2) const;

 private:
  DemagnetizingTensors read() const;
  void write(DemagnetizingTensors const& tensors) const;

  std::filesystem::path path_;
  std::string head_;
};

}  // namespace cayspin::simulation
