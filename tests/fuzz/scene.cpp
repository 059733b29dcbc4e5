// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Fuzzes the texts of scenes. Expressions are evaluated; initial spins are computed on small
// lattices.
#include "io/scene.hpp"

#include "fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t bytes) {
  cayspin::fuzz::refuse_or_read([&] {
    auto const scene = cayspin::io::parse_scene(
        std::string(reinterpret_cast<char const*>(data), bytes), "/nonexistent/scene.toml");
    if (cayspin::io::sites(scene) > 1000) return;
    cayspin::io::initial_spins(scene);
    if (scene.system.kind == cayspin::io::SystemKind::rigid_body)
      cayspin::io::inverse_inertia(scene);
  });
  return 0;
}
