// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <nlohmann/json.hpp>

#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace cayspin::test {

/// Returns a list of tests/data/oracles.json. Inputs are doubles; results are decimal strings of 32
/// digits, computed with 70 digits.
inline nlohmann::json oracles(std::string const& list) {
  std::string const path = CAYSPIN_TEST_DATA "/oracles.json";
  std::ifstream file(path);
  if (!file) throw std::runtime_error("cannot read " + path);
  auto const all = nlohmann::json::parse(file);
  if (all.at(list).empty()) throw std::runtime_error(path + ": no cases in " + list);
  return all.at(list);
}

inline long double decimal(nlohmann::json const& digits) {
  if (digits.is_number()) return digits.get<double>();
  return std::strtold(digits.get<std::string>().c_str(), nullptr);
}

/// Returns all numbers of an array in order, whether it is nested or not.
inline std::vector<double> decimals(nlohmann::json const& array) {
  std::vector<double> numbers;
  for (auto const& entry : array.is_array() ? array : nlohmann::json::array({array})) {
    if (!entry.is_array()) {
      numbers.push_back(static_cast<double>(decimal(entry)));
      continue;
    }
    auto const inner = decimals(entry);
    numbers.insert(numbers.end(), inner.begin(), inner.end());
  }
  return numbers;
}

}  // namespace cayspin::test
