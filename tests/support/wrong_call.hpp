// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace cayspin::test {

/// Returns the error message of a call, or "taken" if the call raises no error.
template <class Error = std::invalid_argument>
std::string refusal(std::function<void()> const& call) {
  try {
    call();
    return "taken";
  } catch (Error const& error) {
    return error.what();
  }
}

/// A call that must be refused by an exception with a message of one line.
struct WrongCall {
  std::string name;
  std::function<void()> call;
};

template <class Error = std::invalid_argument>
void expect_refused(std::vector<WrongCall> const& calls) {
  for (auto const& [name, call] : calls) {
    try {
      call();
      ADD_FAILURE() << name << ": taken";
    } catch (Error const& error) {
      EXPECT_NE(std::string(error.what()), "") << name;
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << name << error.what();
    } catch (std::exception const& error) {
      ADD_FAILURE() << name << ": refused as another kind of error: " << error.what();
    }
  }
}

}  // namespace cayspin::test
