// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include <cayspin/vec3.hpp>
#include <cayspin/version.hpp>

#include <cstring>

int main() {
  constexpr cayspin::Vec3<double> z{0, 0, 1};
  return z.z == 1 && std::strlen(CAYSPIN_VERSION_STRING) > 0 ? 0 : 1;
}
