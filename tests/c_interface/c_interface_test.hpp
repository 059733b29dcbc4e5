// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/cayspin.h>

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <type_traits>

namespace cayspin::test {

/// Returns a scene of two uncoupled spins that precess about z, with period 2 pi. `more` comes
/// before [initial].
inline std::string scene_text(std::string const& more = {}, std::string const& end = "steps = 10") {
  return "[system]\nkind = \"llg\"\ndamping = 0.0\n[lattice]\nshape = [2]\n"
         "[field]\napplied = [0.0, 0.0, 1.0]\n" +
         more + "[initial]\nuniform = [1.0, 0.0, 0.0]\n" +
         "[integrator]\nmethod = \"rkmk4\"\ndt = 0.01\n" + end + "\n";
}

struct Close {
  void operator()(cayspin_simulation* simulation) const { cayspin_close(simulation); }
};
using Simulation = std::unique_ptr<cayspin_simulation, Close>;

/// The space of simulations. Null: the default.
#if defined(CAYSPIN_HOST_DEVICE)
inline constexpr char const* space = "host_device";
inline constexpr bool on_host = false;
#else
inline constexpr char const* space = nullptr;
inline constexpr bool on_host = true;
#endif

inline Simulation open(std::string const& text, cayspin_precision precision = CAYSPIN_DOUBLE) {
  cayspin_simulation* simulation = nullptr;
  EXPECT_EQ(cayspin_open_text(text.c_str(), nullptr, precision, space, &simulation), CAYSPIN_OK)
      << cayspin_last_error();
  return Simulation(simulation);
}

/// Expects the status `is` of a failed call to be `expected`, and the message to be one line that
/// contains `words`.
inline void expect_failure(cayspin_status is, cayspin_status expected, std::string const& words) {
  EXPECT_EQ(is, expected);
  EXPECT_NE(std::string(cayspin_last_error()).find(words), std::string::npos)
      << "\"" << cayspin_last_error() << "\" has no \"" << words << "\"";
  EXPECT_EQ(std::string(cayspin_last_error()).find('\n'), std::string::npos);
}

}  // namespace cayspin::test
