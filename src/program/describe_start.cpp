// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "describe.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace cayspin::program {
namespace {

struct StartText {
  io::Units const& units;

  template <class Numbers>
  static std::string vector(Numbers const& numbers) {
    return fmt::format("({:.6g})", fmt::join(numbers, ", "));
  }
  std::string length(double length) const {
    return fmt::format("{:.6g}{}", length * units.length, units.si ? " m" : "");
  }

  std::string operator()(io::UniformStart const& start) const {
    return "uniform " + vector(start.direction);
  }
  std::string operator()(io::ExpressionStart const& start) const {
    return fmt::format("({}), normalised", fmt::join(start.components, ", "));
  }
  std::string operator()(io::RandomStart const& start) const {
    return fmt::format("random on the sphere, seed {}", start.seed);
  }
  std::string operator()(io::FileStart const& start) const { return "from " + start.path.string(); }
  std::string operator()(io::GivenStart const&) const { return "spins of the program"; }
  std::string operator()(io::InitialState const& state) const { return std::visit(*this, state); }

  std::string operator()(io::VortexState const& vortex) const {
    return fmt::format("vortex at {}, circulation {}, polarity {}, core of radius {}",
                       vector(vortex.center), vortex.circulation, vortex.polarity,
                       length(vortex.radius));
  }
  std::string operator()(io::SkyrmionState const& skyrmion) const {
    return fmt::format("{} skyrmion at {}, polarity {}, chirality {}, radius {}, wall of width {}",
                       skyrmion.bloch ? "Bloch" : "Neel", vector(skyrmion.center),
                       skyrmion.polarity, skyrmion.chirality, length(skyrmion.radius),
                       length(skyrmion.width));
  }
  std::string operator()(io::TwoDomainsState const& domains) const {
    return fmt::format("two domains along {}: {} and {}, wall {} at {:.6g}, of width {}",
                       "xyz"[domains.axis], vector(domains.directions[0]),
                       vector(domains.directions[1]), vector(domains.wall), domains.position,
                       length(domains.width));
  }
  std::string operator()(io::HelixState const& helix) const {
    return fmt::format("helix of period {} along {}, about {}, phase {:.6g}", length(helix.period),
                       vector(helix.direction), vector(helix.normal), helix.phase);
  }
};

}  // namespace

std::string describe_start(io::Scene const& scene) {
  return std::visit(StartText{scene.units}, scene.initial);
}

}  // namespace cayspin::program
