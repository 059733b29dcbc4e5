// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Computes the slab of scenes/slab_switching.toml with a step of 0.01, by geometric Euler, by
// classical Euler and by RKMK4. `cayspin run` computes the same, but this program compiles in
// seconds.
#include "cayspin_git_commit.hpp"
#include "io/scene.hpp"
#include "io/trajectory.hpp"

#include <cayspin/field/effective_field.hpp>
#include <cayspin/field/exchange.hpp>
#include <cayspin/field/slab_demag.hpp>
#include <cayspin/field/uniaxial_anisotropy.hpp>
#include <cayspin/field/zeeman.hpp>
#include <cayspin/generator/landau_lifshitz.hpp>
#include <cayspin/integrate.hpp>
#include <cayspin/observer/record.hpp>
#include <cayspin/stepper/corrected_euler.hpp>
#include <cayspin/stepper/methods.hpp>
#include <cayspin/version.hpp>

#include <cctype>
#include <cstdio>
#include <exception>
#include <string>
#include <type_traits>

namespace {

namespace io = cayspin::io;
using Exec = Kokkos::DefaultExecutionSpace;
using Spins = cayspin::SpinField<double>;

auto make_generator(io::Scene const& scene, cayspin::Lattice const& lattice) {
  auto const& field = scene.field;
  auto const vector = [](io::Triple const& v) { return cayspin::Vec3<double>{v[0], v[1], v[2]}; };
  auto const applied = [&](int axis) { return std::get<double>(field.applied.value()[axis]); };
  auto const& anisotropy = field.anisotropies.at(0);
  return cayspin::LandauLifshitz(
      cayspin::EffectiveField(
          cayspin::Exchange(lattice, field.exchange.value().constant),
          cayspin::UniaxialAnisotropy(anisotropy.constant, vector(anisotropy.axis)),
          cayspin::SlabDemag(vector(field.slab_demag.value().normal)),
          cayspin::Zeeman{{applied(0), applied(1), applied(2)}}),
      scene.system.damping);
}

io::TrajectoryFile create(std::filesystem::path const& path, io::Scene const& scene) {
  io::TrajectoryHeader header;
  header.scene_text = scene.text;
  header.cayspin_version = CAYSPIN_VERSION_STRING;
  header.git_commit = CAYSPIN_GIT_COMMIT;
  header.kokkos_version = std::to_string(KOKKOS_VERSION / 10000) + "." +
                          std::to_string(KOKKOS_VERSION / 100 % 100) + "." +
                          std::to_string(KOKKOS_VERSION % 100);
  for (char const* c = Exec::name(); *c; ++c)
    header.space += static_cast<char>(std::tolower(static_cast<unsigned char>(*c)));
  if (std::is_same_v<Exec, Kokkos::DefaultHostExecutionSpace>)
    header.threads = Exec().concurrency();
  header.shape = scene.lattice.shape;
  return {path, header, true};
}

/// An observer that writes scalars and a frame of all spins.
template <class Generator>
struct WriteFrame {
  Generator const& generator;
  io::TrajectoryFile& file;

  void operator()(Exec const& exec, cayspin::Step const& step, Spins const& spins) const {
    auto const now = cayspin::sample(exec, generator, step, spins);
    auto const& m = now.magnetization;
    io::Scalars const scalars{now.energy.value, now.norm_defect, {m.x, m.y, m.z}};
    file.write_scalars(now.step, now.time, scalars);
    file.write_frame(now.step, now.time, scalars, cayspin::copy_to_host(spins).data());
  }
};

template <class Stepper>
void simulate(std::string const& method, std::filesystem::path const& path) {
  Kokkos::Timer const clock;
  auto const scene = io::read_scene(CAYSPIN_DEMO_SCENE, {"integrator.method=\"" + method + "\"",
                                                         "integrator.dt=0.01", "output.every=2"});
  auto const lattice = cayspin::Lattice::chain(scene.lattice.shape[0], scene.lattice.spacing[0]);
  Spins spins("spins", lattice);
  cayspin::copy_from_host(io::initial_spins(scene), spins);
  auto const generator = make_generator(scene, lattice);
  Stepper stepper(spins);

  auto file = create(path, scene);
  WriteFrame<decltype(generator)> const write{generator, file};
  cayspin::Times const times{0, scene.integrator.dt, scene.integrator.steps};
  auto const done = cayspin::integrate(Exec(), stepper, generator, spins, times,
                                       cayspin::Every(scene.output.every, write));
  io::RunCost const cost{done.evaluations, clock.seconds(), done.step_seconds};
  file.finish(cost);
  std::printf("demo: %s: %lld steps, %lld frames in %.2g s: %s\n", method.c_str(),
              static_cast<long long>(done.steps), static_cast<long long>(file.frames()),
              clock.seconds(), path.c_str());
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 2) {
    std::fprintf(stderr, "usage: cayspin_demo FOLDER\n");
    return 2;
  }
  Kokkos::ScopeGuard const kokkos(Kokkos::InitializationSettings().set_disable_warnings(true));
  std::filesystem::path const folder = argv[1];
  simulate<cayspin::LieEuler<Spins>>("euler", folder / "geometric.h5");
  simulate<cayspin::ClassicalEuler<Spins>>("classical_euler", folder / "classical.h5");
  simulate<cayspin::Rkmk4<Spins>>("rkmk4", folder / "reference.h5");
} catch (std::exception const& error) {
  std::fprintf(stderr, "demo: %s\n", error.what());
  return 2;
}
