// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Preloaded into the program: a file system that cannot lock folders.
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>

extern "C" int flock(int file, int operation) {
  struct stat status {};
  if (::fstat(file, &status) != 0) return -1;
  if (!S_ISDIR(status.st_mode)) return static_cast<int>(::syscall(SYS_flock, file, operation));
  errno = ENOSYS;
  return -1;
}
