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

/// A number of the environment.
inline std::int64_t setting(char const* name, std::int64_t usual) {
  char const* const asked = std::getenv(name);
  return asked ? std::atoll(asked) : usual;
}
inline std::uint64_t random_seed() {
  return static_cast<std::uint64_t>(setting("CAYSPIN_SEED", 1));
}

/// The tables of a small scene.
inline constexpr char const* chain_of_nine =
    "lattice = { shape = [9] }\nfield = { exchange = 1.0 }\n"
    "initial = { random = { seed = 4 } }\n";

/// A small scene for a method, drawn by seed and number.
class RandomRun {
 public:
  RandomRun(std::uint64_t seed, std::int64_t number)
      : engine_(seed * 1000003u + static_cast<std::uint64_t>(number)) {}

  std::int64_t below(std::int64_t count) {
    return static_cast<std::int64_t>(static_cast<double>(engine_() >> 11) * 0x1p-53 *
                                     static_cast<double>(count));
  }
  bool one_in(int count) { return below(count) == 0; }

  /// TOML that may have no meaning: then parse_scene refuses it.
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
    text += fmt::format("[lattice]\nshape = {}\nboundary = {}\n", shapes[below(5)],
                        boundaries[below(2)]);
    text += "[field]\nexchange = 1.0\n";
    if (one_in(2)) text += "anisotropy = { constant = 0.7, axis = [1, 2, 3] }\n";
    if (one_in(3)) text += "slab_demag = { normal = [0, 0, 1] }\n";
    if (one_in(2))
      text += "applied = [0.3, -0.2, 0.4]\n";
    else if (!conserves_)
      text += "applied = [\"0.5*cos(7*t)\", \"0.1\", \"0.4*sin(3*t)\"]\n";
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

 private:
  std::mt19937_64 engine_;
  bool conserves_ = false;
};

}  // namespace cayspin::simulation::test
