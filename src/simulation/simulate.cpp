// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "simulate.hpp"

#include "denormals.hpp"
#include "text.hpp"
#include "variant.hpp"

#include <cayspin/stepper/implicit.hpp>
#include <cayspin/stepper/step_control.hpp>

#include <fmt/format.h>

#include <string>

namespace cayspin::simulation {

namespace {

std::string text_of(NotConverged const& error, io::Units const& units) {
  return fmt::format(
      "integrator.dt: the equation of the step from t = {} is not solved; accepted: a smaller dt",
      time_text(units, error.t()));
}

std::string text_of(StepTooSmall const& error, io::Units const& units) {
  auto const text = fmt::format("integrator.tolerance: from t = {} it needs a step below {}",
                                time_text(units, error.t()), time_text(units, error.dt()));
  if (!(error.min_dt() > error.dt()))
    return text + "; the numbers are not finite, or the field is not smooth";
  return fmt::format(
      "{}, and integrator.min_dt is {}; accepted: a larger tolerance, or a smaller min_dt", text,
      time_text(units, error.min_dt()));
}

}  // namespace

template <class Real, class Space>
Ending Simulation<Real, Space>::advance(OpenMethod& method, RunObserver<Exec, Spins>& observed_by) {
  observer = &observed_by;
  Ending ending;
  try {
    FlushDenormals const while_stepping;
    ending.summary = method.advance();
  } catch (NumbersFailed const& error) {
    ending.failure = error.what();
  } catch (NotConverged const& error) {
    ending.failure = text_of(error, units);
  } catch (StepTooSmall const& error) {
    ending.failure = text_of(error, units);
  }
  return ending;
}

#define CAYSPIN_INSTANTIATE(Space, Real) template struct Simulation<Real, Space>;
CAYSPIN_FOR_EACH_SPACE(CAYSPIN_INSTANTIATE, double)
CAYSPIN_FOR_EACH_SPACE(CAYSPIN_INSTANTIATE, float)
#undef CAYSPIN_INSTANTIATE

}  // namespace cayspin::simulation
