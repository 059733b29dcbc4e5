// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include <cayspin/io/scene.hpp>

int main(int, char** argv) {
  auto const scene = cayspin::io::read_scene(argv[1]);
  return scene.system.damping == 0.25 ? 0 : 1;
}
