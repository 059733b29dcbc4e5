// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "simulation/failure.hpp"
#include "simulation/scene_run.hpp"

#include <cayspin/cayspin.h>

#include <string>

/// Statuses, messages and arguments of the functions of the C interface.
namespace cayspin::c_interface {

/// Returns the calling thread's text for cayspin_last_error.
std::string& last_error();

/// Returns the status of the exception being handled, and stores its message.
cayspin_status failure();

/// Calls work(). Returns CAYSPIN_OK, or the status of the exception that it throws.
template <class Work>
cayspin_status guarded(Work const& work) {
  try {
    work();
    return CAYSPIN_OK;
  } catch (...) {
    return failure();
  }
}

/// Returns *pointer; throws UsageError with `name` for a null pointer.
template <class Type>
Type& required(Type* pointer, char const* name) {
  if (pointer == nullptr)
    throw simulation::UsageError(std::string(name) + " is NULL; accepted: a valid pointer");
  return *pointer;
}

/// Throws UsageError for a number that is not in the enumeration.
simulation::Precision precision_of(cayspin_precision precision);

/// Returns the settings of a run. `space` may be null.
simulation::RunSettings settings_of(cayspin_precision precision, char const* space);

}  // namespace cayspin::c_interface
