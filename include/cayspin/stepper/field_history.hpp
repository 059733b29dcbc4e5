// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/lattice.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>

namespace cayspin::inline v0_2::detail {

/// A ring of the last Count fields of a run, and the lengths of the steps that start from them.
template <class Field, std::size_t Count>
class FieldHistory {
 public:
  FieldHistory(std::string const& label, Lattice const& lattice) {
    for (auto& field : fields_) field = Field(label, lattice);
  }

  std::size_t known() const { return known_; }
  void forget() { known_ = 0; }

  /// Returns the field `back` steps before the last stored one.
  Field const& operator[](std::size_t back) const { return fields_[(newest_ + back) % Count]; }
  /// Returns the memory for the next field, which is that of the oldest field.
  Field const& following() const { return (*this)[Count - 1]; }

  /// Records that following() now has the next field, and that a step of dt starts from it.
  void remember(double dt) {
    newest_ = (newest_ + Count - 1) % Count;
    known_ = std::min(known_ + 1, Count);
    std::move_backward(steps_.begin(), steps_.end() - 1, steps_.end());
    steps_[0] = dt;
  }

  /// Returns true if a step of dt may follow: it has the sign of the last step and is at most twice
  /// as long.
  bool is_followed_by(double dt) const { return 0 < dt / steps_[0] && dt / steps_[0] <= 2; }

  /// For cayspin::serialize.
  template <class Visit>
  void visit_memory(Visit const& visit) {
    visit.count("known", known_, Count);
    for (std::size_t back = 0; back < known_; ++back) {
      visit("step_" + std::to_string(back), steps_[back]);
      visit("field_" + std::to_string(back), (*this)[back]);
    }
  }

  /// Returns times relative to the end of the last step, in multiples of `unit`: first 0, for that
  /// end itself, then the times of the last Count - 1 fields, newest first, which are negative.
  std::array<double, Count> times(double unit) const {
    std::array<double, Count> times{};
    double sum = 0;
    for (std::size_t j = 1; j < Count; ++j) {
      sum += steps_[j - 1];
      times[j] = -sum / unit;
    }
    return times;
  }

 private:
  std::array<Field, Count> fields_;
  std::array<double, Count> steps_{};  // newest first
  std::size_t newest_ = 0, known_ = 0;
};

}  // namespace cayspin::inline v0_2::detail
