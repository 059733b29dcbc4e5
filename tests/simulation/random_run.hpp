// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/scene.hpp"
#include "simulation/method_choice.hpp"
#include "simulation/precision.hpp"
#include "simulation/variant.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <cstdlib>
#include <random>
#include <string>

namespace cayspin::simulation::test {

/// Returns the environment variable `name` as a number, or `usual` if the variable is not set.
inline std::int64_t setting(char const* name, std::int64_t usual) {
  char const* const asked = std::getenv(name);
  return asked ? std::atoll(asked) : usual;
}
inline std::uint64_t random_seed() {
  return static_cast<std::uint64_t>(setting("CAYSPIN_SEED", 1));
}

/// Tables of a scene: a small lattice, its field and its initial spins. [system] and [integrator]
/// are missing.
inline constexpr char const* chain_of_nine =
    "lattice = { shape = [9] }\nfield = { exchange = 1.0 }\n"
    "initial = { random = { seed = 4 } }\n";

/// A small random scene for a method, by seed and number.
class RandomRun {
 public:
  RandomRun(std::uint64_t seed, std::int64_t number)
      : engine_(seed * 1000003u + static_cast<std::uint64_t>(number)) {}

  std::int64_t below(std::int64_t count) {
    return static_cast<std::int64_t>(static_cast<double>(engine_() >> 11) * 0x1p-53 *
                                     static_cast<double>(count));
  }
  bool one_in(int count) { return below(count) == 0; }

  /// Returns TOML that may be invalid: parse_scene then refuses it.
  std::string scene(Variant const& variant) {
    bool const bodies = variant.of_rigid_bodies ||
                        (variant.isotropy == io::Isotropy::zero && !variant.in_chart && one_in(8));
    auto text = bodies ? rigid_bodies() : lattice_and_field();
    text += fmt::format("[initial]\nrandom = {{ seed = {} }}\n", 1 + below(1000));
    text += fmt::format("[integrator]\n{}\n", integrator(variant, bodies));
    return text;
  }

 private:
  std::string rigid_bodies() {
    return fmt::format(
        "[system]\nkind = \"rigid_body\"\ninertia = [1.0, 2.0, 3.0]\n[lattice]\nshape = [{}]\n",
        1 + below(20));
  }

  std::string lattice_and_field() {
    conserves_ = one_in(3);
    static constexpr char const* shapes[] = {"[13]", "[8, 6]", "[4, 6, 4]", "[1, 9]", "[34, 2]"};
    static constexpr char const* boundaries[] = {"\"open\"", "\"periodic\""};
    auto text = fmt::format("[system]\nkind = \"llg\"\ndamping = {}\n",
                            conserves_ ? "0.0" : (one_in(2) ? "0.3" : "0.02"));
    auto const boundary = below(2);
    text += fmt::format("[lattice]\nshape = {}\nboundary = {}\n", shapes[below(5)],
                        boundaries[boundary]);
    bool const has_regions = numbers_of_sites && one_in(3);
    if (boundary == 0 && !has_regions && one_in(2))
      text += "follow = { axis = \"x\", quantity = \"mz\", value = 0.1 }\n";
    if (has_regions) text += "regions = \"(i + 2*j + k) % 3\"\n";
    bool const has_moments = has_regions && one_in(2), has_spacers = has_moments && one_in(2);
    if (has_moments)
      text += has_spacers ? "moments = { regions = [1, 0, 0.7] }\n"
                          : "moments = { regions = [1, 0.5, 0.7] }\n";
    if (has_regions && one_in(3)) text += "gyromagnetic = { regions = [1, 1.3, 0.6] }\n";
    text += "[field]\nexchange = 1.0\n";
    if (has_spacers)
      text += "interlayer = [ { between = [0, 2], J = -0.3, biquadratic = 0.05, range = 1 } ]\n";
    else if (has_regions && one_in(2))
      text +=
          "exchange_between = [ { between = [0, 1], factor = 0.3 } ]\n"
          "interlayer = [ { between = [1, 2], J = -0.3, biquadratic = 0.05 } ]\n";
    if (has_regions && one_in(2))
      text +=
          fmt::format("sources = [ {{ profile = [\"0.3*x\", 0.1, \"0.2*y\"], time = \"{}\" }} ]\n",
                      conserves_ ? "1" : "cos(3*t)");
    bool const has_crystal_terms = has_regions && one_in(2);
    if (has_crystal_terms) {
      text +=
          "dmi = { d2d = 0.2 }\n"
          "anisotropy = [ { cubic = \"0.2*x\", axes = [[\"cos(i)\", \"sin(i)\", 0], [\"-sin(i)\", "
          "\"cos(i)\", 0]], constant2 = 0.5 }, { constant = 0.3, axis = [\"i+1\", \"j\", 0] }, "
          "{ hexagonal = 0.02, axis = [0, 0, 1], in_plane = [1, 0, 0] } ]\n";
      if (!conserves_)
        text += "in_time = { anisotropy = \"1 + 0.3*sin(5*t)\", dmi = \"exp(-t)\" }\n";
    } else if (has_regions && one_in(2)) {
      text +=
          "anisotropy = { constant = 0.7, axis = { regions = [[1, 2, 3], [0, 0, 1], [1, 0, 0]] } "
          "}\n";
    } else if (one_in(2)) {
      text += "anisotropy = { constant = 0.7, axis = [1, 2, 3] }\n";
    }
    if (one_in(3)) text += "slab_demag = { normal = [0, 0, 1] }\n";
    if (one_in(2))
      text += "applied = [0.3, -0.2, 0.4]\n";
    else if (!conserves_)
      text += "applied = [\"0.5*cos(7*t)\", \"0.1\", \"0.4*sin(3*t)\"]\n";
    if (has_regions && !conserves_ && one_in(2))
      text +=
          "[torque.slonczewski]\ndamping_like = { profile = { regions = [0.2, -0.1, 0.3] }, time = "
          "\"cos(t)\" }\nlambda = 1.5\npolarization = [\"x-0.5\", \"y\", 1]\n";
    return text;
  }

  std::string integrator(Variant const& variant, bool bodies) {
    MethodChoice choice{.method = variant.method};
    choice.compensated = variant.compensated;
    choice.isotropy = variant.isotropy;
    if (choice.isotropy == io::Isotropy::zero && one_in(3)) {
      choice.isotropy = io::Isotropy::constant;
      choice.sigma = 0.4;
    }
    if (variant.in_chart)
      choice.generator = io::Generator::tangent;
    else if (one_in(2))
      choice.generator = io::Generator::orthogonal;
    if (one_in(3)) choice.rotation = io::Rotation::exponential;
    auto keys = choice.keys();
    for (auto& c : keys)
      if (c == ',') c = '\n';
    keys += fmt::format("\ndt = {}\nsteps = {}", one_in(2) ? 0.03 : 0.011, steps);
    if (variant.method->adaptive) keys += "\ntolerance = 1e-5";
    if (!bodies && conserves_ && one_in(3)) keys += "\nenergy_control = true";
    if (!bodies && !conserves_ && one_in(4)) keys += "\nuntil_torque = 1e-9";
    return keys;
  }

 public:
  static constexpr std::int64_t steps = 40;
  bool numbers_of_sites = true;  ///< allows site-dependent values

 private:
  std::mt19937_64 engine_;
  bool conserves_ = false;
};

}  // namespace cayspin::simulation::test
