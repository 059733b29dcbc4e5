// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// cayspin reproduce: values read from the files it writes.
#include "../support/larger.hpp"
#include "program_test.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

namespace cayspin::program::test {
namespace {

using Row = std::vector<std::string>;

// Splits a line of CSV; a quoted cell may contain commas.
Row cells(std::string const& line) {
  Row row(1);
  bool quoted = false;
  for (char const c : line)
    if (c == '"')
      quoted = !quoted;
    else if (c == ',' && !quoted)
      row.emplace_back();
    else
      row.back() += c;
  return row;
}

class Reproducing : public ProgramTest {
 protected:
  std::string output(Arguments const& arguments) const {
    return output_of(joined(joined({"reproduce"}, arguments), {"--output", "numbers"}));
  }

  std::vector<Row> rows(std::string const& name) const {
    std::ifstream file(in_folder("numbers/" + name));
    std::vector<Row> rows;
    for (std::string line; std::getline(file, line);) rows.push_back(cells(line));
    EXPECT_GT(rows.size(), 1u) << name;
    return rows;
  }

  /// Returns the value in `column` of the row that starts with these cells.
  double number(std::string const& name, Row const& begin, std::string const& column) const {
    auto const all = rows(name);
    auto const place = std::ranges::find(all.front(), column) - all.front().begin();
    for (auto const& row : all)
      if (std::equal(begin.begin(), begin.end(), row.begin()))
        return std::stod(row.at(static_cast<std::size_t>(place)));
    ADD_FAILURE() << name << ": no such row";
    return std::nan("");
  }
};

TEST_F(Reproducing, OrdersOfTheTables) {
  auto const text = output({"table2", "table3", "table4", "--bodies", "100"});
  EXPECT_TRUE(contains(text, "100 bodies, three moments of inertia uniform in [1.25, 3.75]"));
  struct Expected {
    std::string table, bodies, update, dt;
    double low, high;
  };
  // Orders from mean errors of ten bodies, at dt and at 10 * dt.
  for (auto const& [table, bodies, update, dt, low, high] :
       std::vector<Expected>{{"table2.csv", "triaxial", "F^Eul_def", "0.01", 0.9, 1.1},
                             {"table2.csv", "triaxial", "F^Eul_orth", "0.01", 0.9, 1.1},
                             {"table2.csv", "triaxial", "F^Eul_cor", "0.01", 1.97, 2.05},
                             {"table3.csv", "triaxial", "F^RK2_def", "0.01", 2.98, 3.02},
                             {"table3.csv", "triaxial", "F^RK2_orth", "0.01", 2.98, 3.02},
                             {"table3.csv", "triaxial", "F^RK2_dcor", "0.1", 4.8, 5},
                             {"table3.csv", "triaxial", "F^RK2_ocor", "0.1", 4.2, 5.05},
                             {"table4.csv", "triaxial", "F^sy4_def", "0.1", 4.2, 4.95},
                             {"table4.csv", "triaxial", "F^sy4_dcor", "0.1", 4.9, 5.05},
                             {"table4.csv", "triaxial", "F^sy4_ocor", "0.1", 4.9, 5.05},
                             {"table4.csv", "triaxial", "F^RK4_def", "0.1", 4.75, 5},
                             {"table4.csv", "axisymmetric", "F^RK4_def", "0.1", 4.9, 5}}) {
    double const order = number(table, {bodies, update, dt}, "order_of_means");
    EXPECT_GE(order, low) << update;
    EXPECT_LE(order, high) << update;
  }
}

TEST_F(Reproducing, ErrorsOfTheTables) {
  output({"table2", "table3", "table4", "separatrix", "--bodies", "200"});
  struct Expected {
    std::string table, update, dt;
    double low, high;
  };
  // Ranges around our medians. The paper's values are within a decade or two of these.
  for (auto const& [table, update, dt, low, high] :
       std::vector<Expected>{{"table2.csv", "F^Eul_def", "0.1", 5e-3, 1.5e-2},
                             {"table2.csv", "F^Eul_orth", "0.1", 4e-4, 1.6e-3},
                             {"table2.csv", "F^Eul_cor", "0.1", 1.2e-7, 5e-7},
                             {"table3.csv", "F^RK2_def", "0.1", 3e-6, 1.3e-5},
                             {"table3.csv", "F^RK2_orth", "0.1", 6e-9, 5e-8},
                             {"table3.csv", "F^RK2_dcor", "0.1", 3e-9, 1.3e-8},
                             {"table3.csv", "F^RK2_ocor", "0.1", 1.5e-12, 2e-11},
                             {"table4.csv", "F^sy4_def", "0.1", 1.2e-10, 5e-10},
                             {"table4.csv", "F^sy4_orth", "0.1", 5e-13, 5e-12},
                             {"table4.csv", "F^sy4_dcor", "0.1", 2e-11, 1e-10},
                             {"table4.csv", "F^sy4_ocor", "0.1", 2e-14, 2.5e-13},
                             {"table4.csv", "F^RK4_def", "0.1", 1.1e-10, 4.6e-10},
                             {"table4.csv", "F^RK4_orth", "0.1", 2.5e-13, 2.5e-12},
                             {"separatrix.csv", "F^Eul_def", "0.01", 1e-3, 5e-3},
                             {"separatrix.csv", "F^Eul_orth", "0.01", 0, 1e-13},
                             {"separatrix.csv", "F^Eul_cor", "0.01", 0, 1e-13}}) {
    double const median = number(table, {"triaxial", update, dt}, "median");
    EXPECT_GE(median, low) << update;
    EXPECT_LE(median, high) << update;
  }
  auto const axisymmetric = [&](std::string const& table, std::string const& update) {
    return number(table, {"axisymmetric", update, "1"}, "mean_of_ten_median");
  };
  EXPECT_LT(axisymmetric("table2.csv", "F^Eul_cor"), 1e-15);
  EXPECT_LT(axisymmetric("table3.csv", "F^RK2_ocor"), 1e-10);
  // For axisymmetric bodies the corrections of order 4 vanish.
  EXPECT_NEAR(axisymmetric("table4.csv", "F^sy4_dcor") / axisymmetric("table4.csv", "F^sy4_def"), 1,
              1e-6);
  EXPECT_NEAR(axisymmetric("table4.csv", "F^sy4_ocor"), axisymmetric("table4.csv", "F^sy4_orth"),
              1e-15);
}

TEST_F(Reproducing, Errata) {
  output({"errata", "--bodies", "100"});
  struct Expected {
    std::string erratum, quantity;
    double printed, printed_tolerance, corrected, corrected_tolerance;
  };
  constexpr double any = 1e300, order = 0.15;
  for (auto const& [erratum, quantity, printed, printed_tolerance, corrected, corrected_tolerance] :
       std::vector<Expected>{
           {"1", "distance from m' = m x I^-1 m at t = 10, geometric Euler, dt = 0.01", 0.85, 0.35,
            0, 5e-3},
           {"1", "... largest difference of the two over all bodies", 0, any, 0, 1e-14},
           {"2", "local error along A_o over dt^2, dt = 0.001: sign, on A", 0.025, 0.015, 0, 1e-8},
           {"2", "local error along A_o over dt^2, dt = 0.001: |A|^2, on A", 0.0125, 0.008, 0,
            1e-8},
           {"2", "energy order, dt 0.05 to 0.025: sign, on A", 1, order, 2, order},
           {"2", "energy order, dt 0.05 to 0.025: sign, on A_o", 1, order, 2, order},
           {"2", "energy order, dt 0.05 to 0.025: |A|^2, on A", 1, order, 2, order},
           {"2", "energy error, sign, on A_o, over that of sigma = 0", 2, 0.02, 0, any},
           {"2", "order of the remainder of sigma by a forward difference: switching slab", 2, 0, 1,
            order},
           {"2", "implicit Euler, energy order: there the printed sign is right", 2, order, 1,
            order},
           {"2", "switching slab, dt = 0.01, backward differences: largest distance of a spin",
            0.66, 0.01, 0.0061, 0.0001},
           {"3", "|second form / first form - 1|", 2, 0.5, 0, 1e-13},
           {"3", "energy order of geometric Euler with the second form", 1, order, 2, order},
           {"4", "energy order, dt 0.05 to 0.025", 2, order, 4, 0.3},
           {"4", "energy order without any correction", 0, any, 3, order},
           {"5", "|sigma_def / sigma of the invariants - 1|, largest", 2, 1e-9, 0, 1e-9},
           {"5", "energy order, dt 0.05 to 0.025, A = -I^-1 m", 3, order, 4, 0.3},
           {"5", "energy error over [0, 10], dt = 0.05, A = -I^-1 m", 1.6e-7, 1e-7, 0, 1e-9},
           {"6", "order of the trajectory, default generator", 3, order, 4, order},
           {"6", "order of the trajectory, orthogonal generator", 3, order, 4, order},
           {"6", "Table 4, F^RK4_def, slope of the energy error dt 1 to 0.1 (paper: 4.86)", 2.9,
            order, 4.9, order},
           {"6", "Table 4, F^RK4_orth, slope of the energy error dt 1 to 0.1 (paper: 4.68)", 2.95,
            order, 4.7, 0.35},
           {"7", "order of the trajectory", 4, order, 4, order},
           {"7", "energy error of one step of 0.2, over that of the second", 3, order, 1, 0},
           {"7", "Table 4, dt = 0.1, F^sy4_orth over F^RK4_orth (paper: 2.4)", 2, 0.6, 2. / 3, 0.2},
           {"8", "... order of its trajectory, A = -I^-1 m", 1, order, 2, order},
           {"9", "Heun, order of the finest pair of dt, sigma = 10", 0, any, 2, 0.05},
           {"9", "RKMK4, order of the finest pair of dt, sigma = -10", 0, any, 4, 0.05}}) {
    auto const both = [&](std::string const& column) {
      return number("errata.csv", {erratum, quantity}, column);
    };
    if (printed_tolerance < any) {
      EXPECT_NEAR(both("printed"), printed, printed_tolerance) << quantity;
    }
    if (corrected_tolerance < any) {
      EXPECT_NEAR(both("corrected"), corrected, corrected_tolerance) << quantity;
    }
  }
}

TEST_F(Reproducing, Figures) {
  output({"figures"});
  double longest = 0, distance = 0;
  std::vector<Row> accurate, optimal;
  for (auto const& row : rows("slab_full.csv")) {
    if (row[0] == "accurate") accurate.push_back(row);
    if (row[0] == "geometric Euler, optimal sigma, dt = 0.01") optimal.push_back(row);
    if (row[0] == "Euler, dt = 0.0001") longest = cayspin::test::larger(longest, std::stod(row[5]));
  }
  ASSERT_EQ(accurate.size(), 1201u);
  ASSERT_EQ(optimal.size(), accurate.size());
  for (std::size_t i = 0; i < accurate.size(); ++i) {
    double square = 0;
    EXPECT_NEAR(std::stod(accurate[i][1]), std::stod(optimal[i][1]), 1e-9);
    for (std::size_t c = 2; c < 5; ++c)
      square += std::pow(std::stod(accurate[i][c]) - std::stod(optimal[i][c]), 2);
    distance = cayspin::test::larger(distance, std::sqrt(square));
  }
  EXPECT_NEAR(std::expm1(longest), 3.699e-3, 4e-5);
  EXPECT_NEAR(distance, 6.1e-3, 1e-4);
  int in_weak_field = 0;
  for (auto const& row : rows("orders.csv"))
    if (row[0] == "weak field, [0, 1]") {
      ++in_weak_field;
      double const expected = row[1].starts_with("Heun")               ? 2
                              : row[1].starts_with("RKMK4 as printed") ? 3
                                                                       : 4;
      EXPECT_NEAR(std::stod(row[3]), expected, 0.05) << row[1];
    }
  EXPECT_EQ(in_weak_field, 5 * 11);  // methods times values of sigma
}

TEST_F(Reproducing, TheSameForTheSameSeed) {
  auto const table = [&](std::string const& seed) {
    output({"table4", "--bodies", "20", "--seed", seed});
    return rows("table4.csv");
  };
  auto const first = table("5");
  EXPECT_EQ(table("5"), first);
  EXPECT_NE(table("6"), first);
}

TEST_F(Reproducing, WrongUses) {
  expect_refused({"reproduce", "table5"}, "table5");
  expect_refused({"reproduce", "table1", "--bodies", "0"}, "--bodies");
  expect_refused({"reproduce", "table1", "--seed", "a"}, "(see cayspin reproduce --help)\n");
  write("taken", "");
  auto const outcome =
      expect_status(2, {"reproduce", "table1", "--bodies", "10", "--output", "taken"});
  EXPECT_TRUE(contains(outcome.errors, "taken/table1.csv: cannot be written"));
}

}  // namespace
}  // namespace cayspin::program::test
