// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "simulate.hpp"

#include "denormals.hpp"
#include "variant.hpp"

#include <cayspin/stepper/implicit.hpp>

namespace cayspin::simulation {

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
    ending.failure = error.what();
  } catch (StepTooSmall const& error) {
    ending.failure = error.what();
  }
  return ending;
}

#define CAYSPIN_INSTANTIATE(Space, Real) template struct Simulation<Real, Space>;
CAYSPIN_FOR_EACH_SPACE(CAYSPIN_INSTANTIATE, double)
CAYSPIN_FOR_EACH_SPACE(CAYSPIN_INSTANTIATE, float)
#undef CAYSPIN_INSTANTIATE

}  // namespace cayspin::simulation
