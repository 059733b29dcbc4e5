// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Random discs, balls, rings, layers and films with holes: from random and uniform starts each
// search converges to a minimum. CAYSPIN_SHAPED_FILMS is the number of shapes.
#include "io/scene.hpp"
#include "scenes_of_text.hpp"
#include "simulation/scene_field.hpp"
#include "simulation/scene_minimizer.hpp"

#include <cayspin/scalars.hpp>

#include <cstdlib>
#include <random>

namespace cayspin::simulation::test {
namespace {

using Space = Kokkos::DefaultHostExecutionSpace;

class ShapedText {
 public:
  explicit ShapedText(unsigned seed) : engine_(seed) {
    lattice(seed % 5);
    terms();
    std::string const start =
        chance(0.5) ? fmt::format("random = {{ seed = {} }}", seed)
                    : "uniform = " + std::string(chance(0.5) ? "[0, 0, 1]" : "[1, 0.2, 0.1]");
    text = fmt::format(
        "system = {{ kind = 'llg', damping = 0.1 }}\n"
        "integrator = {{ method = 'rkmk4', dt = 0.1, steps = 0 }}\n"
        "[lattice]\n{}[field]\n{}[initial]\n{}\n",
        lattice_, field_, start);
  }
  std::string text;

 private:
  double uniform(double least, double most) { return least + (most - least) * engine_() * 0x1p-32; }
  bool chance(double probability) { return uniform(0, 1) < probability; }

  void lattice(unsigned kind) {
    double const radius = uniform(0.25, 0.5);
    auto const around = [&](std::string const& axes) {
      return fmt::format("{} < {:.4f}", axes, radius * radius);
    };
    std::string const in_plane = "(x-0.5)*(x-0.5)+(y-0.5)*(y-0.5)";
    switch (kind) {
      case 0:
        return shape("[16, 16, 1]", around(in_plane));
      case 1:
        return shape("[9, 9, 9]", around(in_plane + "+(z-0.5)*(z-0.5)"));
      case 2:
        return shape("[16, 16, 2]", around(in_plane) + " && " + in_plane + " > 0.03");
      case 3:
        return shape("[8, 8, 8]", fmt::format("k < {:.0f}", uniform(1, 7)));
      default:
        return shape("[14, 12, 2]",
                     fmt::format("random(i+14*j+168*k, 3) < {:.3f}", uniform(0.6, 0.95)));
    }
  }
  void shape(std::string const& extents, std::string const& occupied) {
    lattice_ = fmt::format("shape = {}\noccupied = '{}'\n", extents, occupied);
  }

  void terms() {
    double const strength = uniform(0.5, 5);
    field_ += fmt::format("exchange = {:.4f}\n", strength);
    if (chance(0.4))
      field_ += fmt::format("dmi = {{ {} = {:.4f} }}\n",
                            chance(0.5) ? "bulk" : "normal = [0, 0, 1], interfacial",
                            uniform(0.1, 0.5) * strength);
    std::string axes;
    if (chance(0.6))
      axes += fmt::format("{{ constant = {:.4f}, axis = [0, {:.3f}, 1] }}, ", uniform(0.1, 2),
                          uniform(0, 1));
    if (chance(0.4))
      axes += fmt::format("{{ cubic = {:.4f}, axes = [[1, 0, 0], [0, 1, 0]] }}, ", uniform(-1, 1));
    if (!axes.empty()) field_ += "anisotropy = [" + axes + "]\n";
    if (chance(0.4)) field_ += fmt::format("demag = {{ strength = {:.4f} }}\n", uniform(0.2, 1.5));
    // The applied field is oblique, so that every rotation of the spins costs energy.
    field_ += fmt::format("applied = [{:.4f}, {:.4f}, {:.4f}]\n", uniform(0.02, 0.1),
                          uniform(0.02, 0.1), uniform(-0.3, 0.3));
  }

  std::mt19937 engine_;
  std::string lattice_, field_;
};

template <class Real>
void expect_minimum(unsigned seed) {
  constexpr bool is_double = sizeof(Real) == sizeof(double);
  using Spins = SpinField<Real, Space::memory_space>;
  ShapedText const shaped(seed);
  SCOPED_TRACE(fmt::format("seed {}, {} bytes\n{}", seed, sizeof(Real), shaped.text));
  auto const scene = scene_of(shaped.text);
  auto const lattice = make_plan_to_relax(scene, is_double ? Precision::double_precision
                                                           : Precision::single_precision)
                           .lattice;
  Spins spins("spins", lattice);
  copy_from_host(io::initial_spins(scene), spins);
  auto const field = field_of<Spins>(scene, lattice, false).made_for(FieldFor::energy);
  double const torque = is_double ? 1e-7 : 1e-3;
  auto const found =
      SceneMinimizer<Real, Space>(spins).minimize(Space(), scene, field, spins, {.torque = torque});
  EXPECT_EQ(to_string(found.end), "converged") << found.torque;
  EXPECT_LT(found.torque, torque);
  EXPECT_GT(found.curvature, -1e3 * torque);
}

TEST(ShapedFilms, EndInMinima) {
  // Opening a run initialises Kokkos.
  end_of(
      scene_of("system = { kind = 'llg', damping = 0.1 }\n"
               "integrator = { method = 'rkmk4', dt = 0.1, steps = 0 }\n"
               "lattice = { shape = [1] }\ninitial = { uniform = [0, 0, 1] }\n"));
  char const* const wanted = std::getenv("CAYSPIN_SHAPED_FILMS");
  auto const films = static_cast<unsigned>(wanted ? std::atoi(wanted) : 30);
  for (unsigned seed = 0; seed < films; ++seed)
    if (seed % 4 == 0)
      expect_minimum<float>(seed);
    else
      expect_minimum<double>(seed);
}

}  // namespace
}  // namespace cayspin::simulation::test
