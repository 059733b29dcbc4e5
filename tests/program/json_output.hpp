// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "hdf5/attribute.hpp"
#include "hdf5/handle.hpp"
#include "program_test.hpp"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace cayspin::program::test {

using nlohmann::json;

/// Compares the output of commands with --json to the values in their files.
struct JsonOutput : ProgramTest {
  std::string const film = R"toml([system]
kind = "llg"
damping = 0.1
[lattice]
shape = [8, 6]
[field]
exchange = 10.0
anisotropy = { constant = 0.1, axis = [1, 0, 0] }
slab_demag = { normal = [0, 0, 1] }
[initial]
uniform = [1, 0.1, 0.1]
)toml";

  std::string const si_film = R"toml(units = "SI"
[material]
Ms = 8e5
A = 1.3e-11
alpha = 0.02
damping_form = "gilbert"
[system]
kind = "llg"
[lattice]
shape = [4, 3]
spacing = 5e-9
[field]
slab_demag = { normal = [0, 0, 1] }
applied = [0.05, 0, 0]
[initial]
uniform = [1, 0.1, 0.2]
)toml";

  static json parsed(std::string const& output) {
    EXPECT_TRUE(is_one_line(output));
    return json::parse(output, nullptr, false);
  }
  json json_of(Arguments const& arguments) const {
    return parsed(output_of(joined(arguments, {"--json"})));
  }
  json info(std::string const& file) const { return json_of({"info", file}); }

  /// Appends the numbers in nested arrays, in order.
  static void append_numbers(json const& value, std::vector<double>& numbers) {
    if (value.is_array())
      for (auto const& one : value) append_numbers(one, numbers);
    else
      numbers.push_back(value.get<double>());
  }

  /// Expects each of these entries to have the extents and values of the dataset of that name.
  void expect_datasets(json const& object, std::string const& file,
                       std::vector<std::string> const& names,
                       std::string const& group = "/") const {
    for (auto const& name : names) {
      auto const [extents, values] = read_dataset(file, group + name);
      EXPECT_FALSE(values.empty()) << name;
      std::vector<double> found;
      auto const* rows = &object.at(name);
      append_numbers(*rows, found);
      EXPECT_EQ(found, values) << name;
      for (auto const extent : extents) {
        ASSERT_TRUE(rows->is_array()) << name;
        ASSERT_EQ(rows->size(), static_cast<std::size_t>(extent)) << name;
        rows = &rows->front();
      }
    }
  }

  /// Expects each of these entries to have the value of the attribute of that name.
  void expect_attributes(json const& object, std::string const& file,
                         std::vector<std::string> const& numbers,
                         std::vector<std::string> const& texts) const {
    auto const path = in_folder(file);
    auto const opened = io::open_file(path);
    io::RootAttributes const attributes(opened.get(), path);
    for (auto const& name : numbers) {
      auto const& value = object.at(name);
      double const number = value.is_boolean() ? value.get<bool>() : value.get<double>();
      EXPECT_EQ(number, attributes.read_real(name.c_str())) << name;
    }
    for (auto const& name : texts)
      EXPECT_EQ(object.at(name), attributes.read_text(name.c_str())) << name;
  }

  static void expect_nulls(json const& object, std::vector<std::string> const& names) {
    for (auto const& name : names) EXPECT_TRUE(object.at(name).is_null()) << name;
  }
};

}  // namespace cayspin::program::test
