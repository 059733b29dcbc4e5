# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# The target cayspin::fftw, if FFTW 3 is found in both precisions (Debian: libfftw3-dev). FFTW is
# under the GPL: programs that link it must be distributed under the GPL, or with a licence bought
# from its authors. With CUDA, the target also links cuFFT.
find_path(CAYSPIN_FFTW_INCLUDE_DIR fftw3.h)
find_library(CAYSPIN_FFTW_DOUBLE fftw3)
find_library(CAYSPIN_FFTW_SINGLE fftw3f)
mark_as_advanced(CAYSPIN_FFTW_INCLUDE_DIR CAYSPIN_FFTW_DOUBLE CAYSPIN_FFTW_SINGLE)
if(NOT TARGET cayspin::fftw AND CAYSPIN_FFTW_INCLUDE_DIR AND CAYSPIN_FFTW_DOUBLE
   AND CAYSPIN_FFTW_SINGLE)
  add_library(cayspin::fftw INTERFACE IMPORTED)
  target_include_directories(cayspin::fftw INTERFACE ${CAYSPIN_FFTW_INCLUDE_DIR})
  target_link_libraries(cayspin::fftw INTERFACE cayspin::cayspin ${CAYSPIN_FFTW_DOUBLE}
                                                ${CAYSPIN_FFTW_SINGLE})
  if(Kokkos_ENABLE_CUDA OR "CUDA" IN_LIST Kokkos_DEVICES)
    include(${CMAKE_CURRENT_LIST_DIR}/cayspinCudaToolkit.cmake)
    cayspin_find_with_cuda(CUDAToolkit REQUIRED)
    target_link_libraries(cayspin::fftw INTERFACE CUDA::cufft)
  endif()
endif()
