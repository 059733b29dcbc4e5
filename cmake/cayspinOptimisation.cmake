# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# Included when another project adds or finds cayspin: warns if the build has no -O.
get_directory_property(cayspin_seen_options COMPILE_OPTIONS)
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES
   AND NOT "${CMAKE_CXX_FLAGS} ${cayspin_seen_options}" MATCHES "[-/]O")
  message(WARNING "cayspin is compiled without optimisation, because CMAKE_BUILD_TYPE is not set: "
                  "pass -DCMAKE_BUILD_TYPE=Release.")
endif()
unset(cayspin_seen_options)
