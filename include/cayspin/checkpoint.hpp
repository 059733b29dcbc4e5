// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace cayspin::inline v0_2 {

/// Named numbers and fields that a run carries from step to step in addition to its spins. If they
/// are restored together with the spins, the run continues bitwise as if it had not been
/// interrupted, on any host space and with any number of threads.
class Checkpoint {
 public:
  virtual ~Checkpoint() = default;
  /// Returns true when values are read back from the checkpoint, false when they are stored in it.
  virtual bool restores() const = 0;
  /// Stores or restores `value`. Counts and flags are passed as numbers, too.
  virtual void number(std::string const& name, double& value) = 0;
  /// Stores or restores the values of all sites: an array (sites, components) in row-major order;
  /// the x index of sites varies fastest. A call that stores may move from `numbers`.
  virtual void field(std::string const& name, std::vector<double>& numbers) = 0;
};

/// A checkpoint in host memory, empty at first.
class CheckpointInMemory final : public Checkpoint {
 public:
  /// Ends storing: later calls restore values.
  void close() { restores_ = true; }

  bool restores() const override { return restores_; }
  /// While restoring, number() and field() throw std::out_of_range for a name that was not stored.
  void number(std::string const& name, double& value) override {
    if (restores_)
      value = numbers_.at(name);
    else
      numbers_[name] = value;
  }
  void field(std::string const& name, std::vector<double>& numbers) override {
    if (restores_)
      numbers = fields_.at(name);
    else
      fields_[name] = std::move(numbers);
  }

 private:
  bool restores_ = false;
  std::map<std::string, double> numbers_;
  std::map<std::string, std::vector<double>> fields_;
};

}  // namespace cayspin::inline v0_2
