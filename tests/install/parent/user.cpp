// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
int user() { return 0; }
