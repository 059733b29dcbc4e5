// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "sections.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace cayspin::inline v0_2::io::detail {
namespace {

// Times are n * dt in double precision, which must hold n exactly.
constexpr std::int64_t most_steps = std::int64_t{1} << 53;

std::int64_t read_steps(Table const& table, double dt) {
  constexpr std::string_view accepted = "exactly one of end, steps";
  auto const end = table.find("end");
  auto const steps = table.find("steps");
  if (end && steps) end->fail("stands beside integrator.steps", accepted);
  if (end) return whole_steps(*end, dt);
  if (!steps) detail::fail(table.item().place, "integrator.end", "is missing", accepted);
  auto const count = integer(*steps, {"a whole number >= 0", 0});
  if (count > most_steps) steps->fail("more than 2^53 steps");
  return count;
}

void read_isotropy(Item const& item, Scene& scene, Integrator& integrator) {
  if (item.node->is_table()) {
    Table const table(item, scene);
    table.accept_only({"constant"});
    integrator.isotropy = Isotropy::constant;
    integrator.sigma = number(table.required("constant", "a finite number"));
    return;
  }
  constexpr std::string_view accepted = "{ constant = sigma }";
  std::string strings;
  for (auto const& entry : words<Isotropy>()) {
    if (entry.value != Isotropy::constant) {
      strings += fmt::format("\"{}\", ", entry.name);
    }
  }
  integrator.isotropy = word<Isotropy>(item, strings + std::string(accepted));
  if (integrator.isotropy == Isotropy::constant) item.fail("\"constant\" has no value", accepted);
}

Method const* read_method(Table const& table) {
  std::vector<Word<Method const*>> known;
  for (auto const* const method : methods()) known.push_back({method->word, method});
  std::span<Word<Method const*> const> const words = known;
  return word_among(words, table.required("method", quoted(words)));
}

// Reads generator, isotropy and rotation, which baselines and "auto" do not have.
void read_coordinates(Table const& table, Integrator& integrator) {
  auto const& method = *integrator.method;
  auto const generator = table.find("generator");
  auto const isotropy = table.find("isotropy");
  auto const rotation = table.find("rotation");
  auto const cap = table.find("isotropy_cap");
  if (method.is_baseline() || method.automatic) {
    for (auto const& item : {generator, isotropy, rotation, cap}) {
      if (item)
        item->fail(fmt::format("method \"{}\" does not take it", method.word), "no such key");
    }
    return;
  }
  if (generator) integrator.generator = word<Generator>(*generator);
  if (isotropy) read_isotropy(*isotropy, table.scene(), integrator);
  integrator.rotation = method.usual_rotation();
  if (rotation) integrator.rotation = word<Rotation>(*rotation);
  if (cap) {
    if (integrator.isotropy != Isotropy::finite_difference &&
        integrator.isotropy != Isotropy::finite_difference_backward)
      cap->fail("belongs to isotropy \"finite_difference\" and \"finite_difference_backward\"",
                "no such key");
    integrator.isotropy_cap = positive_number(*cap);
  }
}

// Reads the tolerance of an adaptive method. Other methods refuse tolerance, min_dt and max_dt,
// except that "auto" accepts max_dt.
void read_tolerance(Table const& table, Integrator& integrator) {
  if (!integrator.method->adaptive) {
    bool const takes_max_dt = integrator.method->automatic;  // for the method that it chooses
    for (std::string_view const key : {"tolerance", "min_dt", "max_dt"})
      if (auto const item = table.find(key); item && !(key == "max_dt" && takes_max_dt))
        item->fail(fmt::format("method \"{}\" {}", integrator.method->word,
                               integrator.method->automatic ? "chooses it" : "takes steps of dt"),
                   "no such key");
    return;
  }
  constexpr std::string_view accepted = "a number > 0, at most 1";
  auto const tolerance = table.required("tolerance", accepted);
  integrator.tolerance = number(tolerance, {accepted});
  if (!(*integrator.tolerance > 0) || *integrator.tolerance > 1)
    tolerance.fail(fmt::format("{} is no tolerance", *integrator.tolerance), accepted);
}

// Reads the target error for which "auto" chooses a method.
void read_error(Table const& table, Integrator& integrator) {
  auto const item = table.find("error");
  if (!integrator.method->automatic) {
    if (item) item->fail("belongs to method \"auto\"", "no such key");
    return;
  }
  constexpr std::string_view accepted = "a number from 1e-13 to 1";
  auto const error = table.required("error", accepted);
  integrator.error = number(error, {accepted});
  if (!(*integrator.error >= 1e-13) || *integrator.error > 1)
    error.fail(fmt::format("{} is out of reach", *integrator.error), accepted);
}

// Default number of observations of a run with adaptive steps or method "auto". Because it is a
// power of two, the run ends exactly at `end`.
constexpr double usual_looks = 128;

double read_dt(Table const& table, Integrator const& integrator) {
  bool const has_default = !integrator.method->has_equal_steps() && !table.contains("steps");
  if (has_default && !table.contains("dt"))
    return positive_number(table.required("end", "a time > 0")) / usual_looks;
  return positive_number(table.required("dt", "a number > 0"));
}

}  // namespace

// The number of steps must be whole to within 1e-9. Beyond 2e6 steps, the rounding errors of the
// two decimal numbers and of their quotient exceed that, so the tolerance is 2 eps times the
// quotient there.
std::int64_t whole_steps(Item const& item, double dt) {
  auto const time = number(item, not_negative);
  double const quotient = time / dt;
  if (!(quotient <= static_cast<double>(most_steps)))
    item.fail("more than 2^53 steps", "a shorter time or a larger dt");
  double const whole = std::round(quotient);
  double const tolerance = std::max(1e-9, 2 * std::numeric_limits<double>::epsilon() * quotient);
  if (std::abs(quotient - whole) > tolerance) {
    double const fewer = std::max(1.0, std::floor(quotient));
    item.fail(fmt::format("{} is {:.12g} steps of dt = {}, not a whole number", time, quotient, dt),
              fmt::format("dt = {} or {}", time / fewer, time / (fewer + 1)));
  }
  if (whole == 0 && time > 0)
    item.fail(fmt::format("{} is less than a step of dt = {}", time, dt), "a smaller dt");
  return static_cast<std::int64_t>(whole);
}

Integrator read_integrator(Table const& root, SystemKind kind) {
  auto const table = root.table(
      "integrator", "a table [integrator]; only cayspin relax, modes and path go without");
  table.accept_only(names_of_keys<Integrator>());
  Integrator integrator;
  integrator.method = read_method(table);
  read_coordinates(table, integrator);
  read_tolerance(table, integrator);
  read_error(table, integrator);
  integrator.dt = read_dt(table, integrator);
  integrator.steps = read_steps(table, integrator.dt);
  if (!std::isfinite(static_cast<double>(integrator.steps) * integrator.dt)) {
    table.find("dt")->fail("the last time is not finite", "a smaller dt or fewer steps");
  }
  read_keys(table, integrator);
  if (integrator.max_dt < integrator.min_dt)
    table.find("max_dt")->fail(fmt::format("{} is below min_dt", integrator.max_dt),
                               "a number >= min_dt");
  if (auto const item = table.find("until_torque"); item && kind == SystemKind::rigid_body)
    item->fail("a rigid body has no torque m x H", "no such key");
  return integrator;
}

}  // namespace cayspin::inline v0_2::io::detail
