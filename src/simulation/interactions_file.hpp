// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/demagnetization/tensor.hpp>

#include <filesystem>
#include <functional>
#include <string>

namespace cayspin::simulation {

/// A file that keeps a demagnetising field's tensors where they took long to compute: a line with
/// what they are of, the numbers, and a checksum.
class InteractionsFile {
 public:
  /// `of`: one line, all that the tensors depend on.
  InteractionsFile(std::filesystem::path path, std::string of);

  /// Those of the file; where it is not there, damaged or of others, those of `compute`, which the
  /// file keeps from now on where they took `least_seconds` and the folder can be written.
  DemagnetizingTensors read_or(std::function<DemagnetizingTensors()> const& compute,
                               double least_seconds = 2) const;

 private:
  DemagnetizingTensors read() const;
  void write(DemagnetizingTensors const& tensors) const;

  std::filesystem::path path_;
  std::string head_;
};

}  // namespace cayspin::simulation
