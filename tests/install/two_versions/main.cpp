// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include <cstdint>

std::int64_t sites_of_this();
std::int64_t sites_of_other();

int main() { return sites_of_this() == 7 && sites_of_other() == -7 ? 0 : 1; }
