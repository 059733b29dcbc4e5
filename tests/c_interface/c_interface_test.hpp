// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/cayspin.h>

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

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
  void operator()(cayspin_ensemble* ensemble) const { cayspin_ensemble_close(ensemble); }
};
using Simulation = std::unique_ptr<cayspin_simulation, Close>;
using Ensemble = std::unique_ptr<cayspin_ensemble, Close>;

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

inline Ensemble open_ensemble(std::string const& text,
                              cayspin_precision precision = CAYSPIN_DOUBLE) {
  cayspin_ensemble* ensemble = nullptr;
  EXPECT_EQ(cayspin_ensemble_open_text(text.c_str(), nullptr, precision, space, &ensemble),
            CAYSPIN_OK)
      << cayspin_last_error();
  return Ensemble(ensemble);
}

/// Returns a path among the temporary files that no other process that runs these tests has.
inline std::filesystem::path temporary(std::string const& name) {
  return std::filesystem::temp_directory_path() /
         ("cayspin_c_interface_" + std::to_string(::getpid()) + "_" + name);
}

/// Returns the numbers of an array; components vary fastest, then x, y and z.
inline std::vector<double> numbers_of(cayspin_array const& array) {
  auto const at = [&](int64_t offset) {
    return array.precision == CAYSPIN_DOUBLE
               ? static_cast<double const*>(array.data)[offset]
               : static_cast<double>(static_cast<float const*>(array.data)[offset]);
  };
  std::vector<double> numbers;
  for (int64_t z = 0; z < array.shape[0]; ++z)
    for (int64_t y = 0; y < array.shape[1]; ++y)
      for (int64_t x = 0; x < array.shape[2]; ++x)
        for (int64_t c = 0; c < array.shape[3]; ++c)
          numbers.push_back(at(z * array.strides[0] + y * array.strides[1] + x * array.strides[2] +
                               c * array.strides[3]));
  return numbers;
}

/// Returns the spins of a simulation in the order of numbers_of.
inline std::vector<double> spins_of(cayspin_simulation* simulation) {
  cayspin_array spins{};
  EXPECT_EQ(cayspin_borrow_spins(simulation, &spins), CAYSPIN_OK) << cayspin_last_error();
  return numbers_of(spins);
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
