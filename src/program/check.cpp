// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "command.hpp"
#include "failure.hpp"
#include "text.hpp"

#include <fmt/format.h>

#include <cmath>

namespace cayspin::program {

int check(CheckOptions const& options) {
  auto const scene = io::read_scene(options.scene, options.overrides);
  io::check_files(scene);
  auto const plan = make_plan(scene, options.precision);
  fmt::print("{}\n", plan.stable_dt);
  return Status::done;
}

}  // namespace cayspin::program
