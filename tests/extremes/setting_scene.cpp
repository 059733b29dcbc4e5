// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "setting_scene.hpp"

#include "exact.hpp"
#include "io/relax.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

namespace cayspin::extremes {
namespace {

// Returns a number as text that reads back exactly, or infinity in TOML's spelling.
std::string decimal(double number) {
  return std::isfinite(number) ? fmt::format("{:.17e}", number) : "inf";
}

std::string lines_of(MethodChoice const& choice) {
  auto keys = choice.keys();
  std::ranges::replace(keys, ',', '\n');
  return keys;
}

std::string scene_text(Integrator const& integrator, Setting const& setting) {
  bool const body = integrator.of_rigid_bodies;
  auto const& n = setting.shape;
  auto const system = body
                          ? fmt::format("kind = \"rigid_body\"\ninertia = [{0}, {0}, {1}]\n",
                                        decimal(1 / setting.field), decimal(0.5 / setting.field))
                          : fmt::format("kind = \"llg\"\ndamping = {}\n", decimal(setting.damping));
  auto const strength =
      setting.switched_on_at > 0
          ? fmt::format("\"t < {} ? 0 : {}\"", setting.switched_on_at, setting.field)
          : decimal(setting.field);
  auto field = body ? std::string()
                    : fmt::format("[field]\nexchange = {}\napplied = [0, 0, {}]\n",
                                  decimal(setting.exchange), strength);
  if (setting.multirate)
    field += fmt::format(
        "{}slab_demag = {{ normal = [0, 0, 1], where = \"host\", multirate = true, strength = {} }}\n",
        body ? "[field]\n" : "", decimal(*setting.multirate));
  auto const initial = setting.initial.empty()
                           ? fmt::format("uniform = [{}, 0, {}]", setting.along_field ? 0 : across,
                                         setting.along_field ? 1 : along)
                           : setting.initial;
  auto const thermal = setting.temperature ? fmt::format("[thermal]\ntemperature = {}\nseed = 3\n",
                                                         decimal(*setting.temperature))
                                           : std::string();
  return fmt::format(
      "[system]\n{}[lattice]\nshape = [{}]\n{}[initial]\n{}\n"
      "[integrator]\n{}\n{}{}dt = {}\nsteps = {}\n{}",
      system,
      body ? fmt::format("{}", n[0] * n[1] * n[2]) : fmt::format("{}, {}, {}", n[0], n[1], n[2]),
      field, initial, lines_of(integrator),
      integrator.method->adaptive ? fmt::format("tolerance = {}\nmin_dt = {}\n",
                                                decimal(setting.tolerance), decimal(setting.min_dt))
                                  : std::string(),
      setting.substeps > 1 ? fmt::format("substeps = {}\n", setting.substeps) : std::string(),
      decimal(setting.dt), setting.steps, thermal);
}

}  // namespace

io::Scene scene_of(Integrator const& integrator, Setting const& setting) {
  struct File {
    std::filesystem::path path =
        std::filesystem::temp_directory_path() / fmt::format("cayspin-extremes-{}.toml", getpid());
    ~File() {
      std::error_code ignored;
      std::filesystem::remove(path, ignored);
    }
  } const file;
  std::ofstream(file.path) << scene_text(integrator, setting);
  return integrator.relaxes ? io::read_scene_to_relax(file.path) : io::read_scene(file.path);
}

}  // namespace cayspin::extremes
