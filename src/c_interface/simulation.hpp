// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "simulation/failure.hpp"
#include "simulation/scene_run.hpp"

#include <cayspin/cayspin.h>

#include <memory>
#include <mutex>
#include <optional>
#include <string>

struct cayspin_simulation {
  std::mutex turn;  // of the calls of several threads
  std::unique_ptr<cayspin::simulation::SceneRun> run;
  std::optional<cayspin::simulation::LentVectors> borrowed, borrowed_field;
};

namespace cayspin::c_interface {

/// What cayspin_last_error returns.
std::string& last_error();

/// The status and message of the exception that is being handled.
cayspin_status failure();

/// CAYSPIN_OK after work(), otherwise the status of what it throws.
template <class Work>
cayspin_status guarded(Work const& work) {
  try {
    work();
    return CAYSPIN_OK;
  } catch (...) {
    return failure();
  }
}

/// Throws UsageError naming a null pointer.
template <class Type>
Type& required(Type* pointer, char const* name) {
  if (pointer == nullptr)
    throw simulation::UsageError(std::string(name) + " is NULL; accepted: a valid pointer");
  return *pointer;
}

}  // namespace cayspin::c_interface
