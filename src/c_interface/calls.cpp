// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "calls.hpp"

#include "io/scene.hpp"

#include <exception>
#include <new>

namespace cayspin::c_interface {

using namespace simulation;

std::string& last_error() {
  thread_local std::string message;
  return message;
}

cayspin_status failure() {
  auto const is = [](cayspin_status status, char const* message) {
    try {
      last_error() = message;
    } catch (...) {
      last_error().clear();  // no memory for the message
    }
    return status;
  };
  try {
    throw;
  } catch (UsageError const& error) {
    return is(CAYSPIN_WRONG_USAGE, error.what());
  } catch (io::SceneError const& error) {
    return is(CAYSPIN_WRONG_SCENE, error.what());
  } catch (NumbersFailed const& error) {
    return is(CAYSPIN_NUMBERS_FAILED, error.what());
  } catch (std::bad_alloc const&) {
    return is(CAYSPIN_FAILED, "out of memory");
  } catch (std::exception const& error) {
    return is(CAYSPIN_FAILED, error.what());
  } catch (...) {
    return is(CAYSPIN_FAILED, "an exception of unknown type");
  }
}

Precision precision_of(cayspin_precision precision) {
  if (precision == CAYSPIN_DOUBLE) return Precision::double_precision;
  if (precision == CAYSPIN_SINGLE) return Precision::single_precision;
  throw UsageError("precision " + std::to_string(precision) +
                   "; accepted: CAYSPIN_SINGLE, CAYSPIN_DOUBLE");
}

RunSettings settings_of(cayspin_precision precision, char const* space) {
  RunSettings settings;
  settings.precision = precision_of(precision);
  if (space != nullptr) settings.space = space;
  return settings;
}

}  // namespace cayspin::c_interface
