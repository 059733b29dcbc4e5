// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "energy_table.hpp"

#include "paragraph.hpp"
#include "statistics.hpp"

#include <cmath>

namespace cayspin::paper {
namespace {

// Energies are between 0.1 and 1, so energy errors below this are rounding.
constexpr double round_off = 1e-14;

std::string number(double value) {
  if (std::isnan(value)) return "?";
  return value == 0 ? "0" : fmt::format("{:.2e}", value);
}

std::string order_text(double order) {
  return std::isfinite(order) ? fmt::format("{:.2f}", order) : "";
}

std::string place(double paper, Spread const& ours) {
  if (std::isnan(paper)) return "not recoverable";
  bool const below = paper < ours.low;
  bool const above = paper > ours.high;
  if (!below && !above) return "inside";
  if (paper < 10 * round_off && ours.low < round_off) return "rounding, as ours";
  return below ? fmt::format("below, {:.2f} of its end", paper / ours.low)
               : fmt::format("above, {:.2f} of its end", paper / ours.high);
}

}  // namespace

EnergyTable::EnergyTable(Context const& context, std::string_view name, std::string_view title)
    : context_(context),
      file_(context.folder, fmt::format("{}.csv", name),
            "bodies,update,dt,paper,median,low,high,"
            "mean_of_ten_low,mean_of_ten_median,mean_of_ten_high,order_of_means") {
  fmt::print("\n{}\n", title);
}

void EnergyTable::note(std::string_view text) const { print_paragraph(text); }

void EnergyTable::add(Block const& block) {
  auto const bodies = draw_bodies(block.law, context_.bodies, context_.seed);
  fmt::print("\n  {}: {} bodies, {}\n", block.name, bodies.size(), describe(block.law));
  fmt::print("  {:<13}{:>5}  {:>8}  {:>8} {:^21}  {:^21}  {:>5} {:<18} {}\n", "update", "dt",
             "paper", "median", "5 - 95 %", "of means of ten", "order", "ours, of means",
             "the paper is");
  for (auto const& column : block.columns) {
    std::vector<double> coarser;
    for (std::size_t i = 0; i < block.dts.size(); ++i) {
      double const dt = block.dts[i], paper = column.paper[i];
      auto const errors = run_ensemble(bodies, column.choice, dt, block.end).energy_errors;
      auto const means = means_of_ten(errors);
      auto const one = spread(errors), ten = spread(means);
      std::string paper_order, order;
      Spread slope{};
      if (i > 0) {
        double const ratio = block.dts[i - 1] / dt;
        slope = spread(orders(coarser, means, ratio, round_off));
        paper_order = order_text(std::log(column.paper[i - 1] / paper) / std::log(ratio));
        if (!std::isnan(slope.median))
          order = fmt::format("{:.2f} ({:.2f} - {:.2f})", slope.median, slope.low, slope.high);
      }
      fmt::print("  {:<13}{:>5g}  {:>8}  {:>8} {:>9} - {:<9}  {:>9} - {:<9}  {:>5} {:<18} {}\n",
                 i == 0 ? column.name : "", dt, number(paper), number(one.median), number(one.low),
                 number(one.high), number(ten.low), number(ten.high), paper_order, order,
                 place(paper, block.dts.size() == 1 ? one : ten));
      file_.row(block.name, column.name, dt, paper, one.median, one.low, one.high, ten.low,
                ten.median, ten.high, slope.median);
      coarser = means;
    }
  }
}

}  // namespace cayspin::paper
