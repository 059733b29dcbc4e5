// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "simulation.hpp"

#include <exception>
#include <new>

namespace cayspin::c_interface {

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
  } catch (simulation::UsageError const& error) {
    return is(CAYSPIN_WRONG_USAGE, error.what());
  } catch (io::SceneError const& error) {
    return is(CAYSPIN_WRONG_SCENE, error.what());
  } catch (simulation::NumbersFailed const& error) {
    return is(CAYSPIN_NUMBERS_FAILED, error.what());
  } catch (std::bad_alloc const&) {
    return is(CAYSPIN_FAILED, "out of memory");
  } catch (std::exception const& error) {
    return is(CAYSPIN_FAILED, error.what());
  } catch (...) {
    return is(CAYSPIN_FAILED, "an exception of unknown type");
  }
}

}  // namespace cayspin::c_interface
