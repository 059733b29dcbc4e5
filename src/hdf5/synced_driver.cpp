// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// HDF5 file driver for SyncedFile. It works with HDF5 1.10 to 1.14.
#include "synced_file.hpp"

#include <fcntl.h>
#include <sys/file.h>

#include <cerrno>
#include <cstring>
#include <limits>
#include <new>

#if __has_include(<H5FDdevelop.h>)
#include <H5FDdevelop.h>
#endif

namespace cayspin::inline v0_2::io {
namespace {

// The first member must be HDF5's own struct.
struct OpenFile {
  H5FD_t shared;
  SyncedFile* file;
};

SyncedFile& file_of(H5FD_t const* file) { return *reinterpret_cast<OpenFile const*>(file)->file; }

// Reports an error in the format of HDF5's own drivers, which failure_reason() parses.
herr_t report(int error) {
  if (error == 0) return 0;
  H5Epush2(H5E_DEFAULT, __FILE__, __func__, __LINE__, H5E_ERR_CLS, H5E_FILE, H5E_CANTOPERATE,
           "the file failed, error message = '%s'", std::strerror(error));
  return -1;
}

H5FD_t* open(char const* name, unsigned flags, hid_t access, haddr_t) {
  auto const* const given = static_cast<SyncedFile* const*>(H5Pget_driver_info(access));
  auto* const opened = given ? new (std::nothrow) OpenFile{{}, *given} : nullptr;
  if (!opened) return nullptr;
  int const error = opened->file->open(name, ((flags & H5F_ACC_RDWR) != 0 ? O_RDWR : O_RDONLY) |
                                                 ((flags & H5F_ACC_TRUNC) != 0 ? O_TRUNC : 0) |
                                                 ((flags & H5F_ACC_CREAT) != 0 ? O_CREAT : 0) |
                                                 ((flags & H5F_ACC_EXCL) != 0 ? O_EXCL : 0));
  if (error == 0) return &opened->shared;
  delete opened;
  report(error);
  return nullptr;
}

herr_t close(H5FD_t* file) {
  int const error = file_of(file).close();
  delete reinterpret_cast<OpenFile*>(file);
  return report(error);
}

herr_t query(H5FD_t const*, unsigned long* flags) {
  if (flags)
    *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
             H5FD_FEAT_AGGREGATE_SMALLDATA | H5FD_FEAT_POSIX_COMPAT_HANDLE |
             H5FD_FEAT_DEFAULT_VFD_COMPATIBLE;
  return 0;
}

haddr_t get_end(H5FD_t const* file, H5FD_mem_t) { return file_of(file).end; }

herr_t set_end(H5FD_t* file, H5FD_mem_t, haddr_t end) {
  file_of(file).end = end;
  return 0;
}

haddr_t get_written_end(H5FD_t const* file, H5FD_mem_t) { return file_of(file).written_end; }

herr_t get_handle(H5FD_t* file, hid_t, void** handle) {
  *handle = file_of(file).descriptor();
  return 0;
}

herr_t read(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t offset, size_t bytes, void* data) {
  return report(file_of(file).read(offset, data, bytes));
}

herr_t write(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t offset, size_t bytes, void const* data) {
  return report(file_of(file).write(offset, data, bytes));
}

// Does nothing, so that reserved space beyond the end is kept. SyncedFile::close() truncates the
// file.
herr_t truncate(H5FD_t*, hid_t, hbool_t) { return 0; }

herr_t change_lock(H5FD_t* file, int operation) {
  if (::flock(*file_of(file).descriptor(), operation) == 0 || errno == ENOSYS) return 0;
  return report(errno);
}

herr_t lock(H5FD_t* file, hbool_t for_writing) {
  return change_lock(file, (for_writing ? LOCK_EX : LOCK_SH) | LOCK_NB);
}

herr_t unlock(H5FD_t* file) { return change_lock(file, LOCK_UN); }

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"  // members differ between versions
H5FD_class_t const driver = {
#ifdef H5FD_CLASS_VERSION
    .version = H5FD_CLASS_VERSION,
    .value = static_cast<H5FD_class_value_t>(511),  // the last value for unregistered drivers
#endif
    .name = "cayspin_synced",
    .maxaddr = std::numeric_limits<off_t>::max(),
    .fc_degree = H5F_CLOSE_WEAK,
    .fapl_size = sizeof(SyncedFile*),
    .open = open,
    .close = close,
    .query = query,
    .get_eoa = get_end,
    .set_eoa = set_end,
    .get_eof = get_written_end,
    .get_handle = get_handle,
    .read = read,
    .write = write,
    .truncate = truncate,
    .lock = lock,
    .unlock = unlock,
    .fl_map = H5FD_FLMAP_DICHOTOMY,
};
#pragma GCC diagnostic pop

hid_t registered_driver() {
  static hid_t id = H5I_INVALID_HID;
  if (H5Iget_type(id) != H5I_VFL) id = H5FDregister(&driver);  // H5close unregisters the driver
  return id;
}

}  // namespace

void SyncedFile::use_in(hid_t file_access) {
  SyncedFile* const self = this;
  H5Pset_driver(file_access, registered_driver(), &self);
}

}  // namespace cayspin::inline v0_2::io
