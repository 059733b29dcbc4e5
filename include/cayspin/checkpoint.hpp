// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace cayspin::inline v0_1 {

/// Numbers and fields by name: what a run carries from one step to the next beside its spins. With
/// the spins it gives the bits of a run without a break, on any host space and thread count.
class Checkpoint {
 public:
  virtual ~Checkpoint() = default;
  /// Does it give back what it holds, or take what it is given?
  virtual bool restores() const = 0;
  /// Takes `value`, or replaces it. Counts and flags are numbers, too.
  virtual void number(std::string const& name, double& value) = 0;
  /// The same for the numbers of all sites, (sites, components) with x fastest.
  virtual void field(std::string const& name, std::vector<double>& numbers) = 0;
};

/// A checkpoint in host memory, empty at first.
class CheckpointInMemory final : public Checkpoint {
 public:
  /// From now on it gives back.
  void close() { restores_ = true; }

  bool restores() const override { return restores_; }
  /// Throws std::out_of_range for a name that it does not hold.
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

}  // namespace cayspin::inline v0_1
