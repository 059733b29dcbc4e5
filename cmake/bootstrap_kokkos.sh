# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# shellcheck shell=bash disable=SC2034,SC2154
# Sourced by bootstrap.sh. provide_kokkos sets kokkos_option, the option that cmake needs: none when
# CMake finds a Kokkos by itself (CMAKE_PREFIX_PATH, Kokkos_ROOT), otherwise the prefix of the one
# built here. Presets other than release, mpi and host-device build Kokkos inside their own tree
# from the source.

release=4.7.00
release_sha256=126b774a24dde8c1085c4aede7564c0b7492d6a07d85380f2b387a712cea1ff5
carrier=pygenten
carrier_version=0.1.5
carrier_sha256=e620f05c742905e2db705d875f1cac92ef0ed453f9e6734e9beda26cc0f9cce7

kokkos_options=(
  -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_STANDARD=20 -DKokkos_ARCH_NATIVE=ON
  -DKokkos_ENABLE_SERIAL=ON -DKokkos_ENABLE_OPENMP=ON -DKokkos_ENABLE_TESTS=OFF
  -DKokkos_ENABLE_DEPRECATED_CODE_4=OFF # as in Kokkos 5
  -DCMAKE_POSITION_INDEPENDENT_CODE=ON # the Python module is a shared library
  -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=12 # takes a quarter of the processor time
)

provide_kokkos() {
  kokkos_option=()
  case $preset in
    release | mpi | host-device)
      if ! kokkos_is_found; then
        build_kokkos "$deps/kokkos"
        kokkos_option=("-DKokkos_ROOT=$deps/kokkos")
      fi
      ;;
    *)
      provide_kokkos_source
      kokkos_option=("-DCAYSPIN_KOKKOS_SOURCE=$kokkos_source")
      ;;
  esac
}

kokkos_is_found() {
  local probe=$root/build/find-kokkos
  mkdir -p "$probe" "$logs"
  printf '%s\n' 'cmake_minimum_required(VERSION 3.25)' 'project(probe LANGUAGES CXX)' \
    'find_package(Kokkos 4.5...<6 REQUIRED CONFIG)' >"$probe/CMakeLists.txt"
  cmake --fresh -G Ninja -S "$probe" -B "$probe/build" >"$logs/find-kokkos.log" 2>&1
}

# build_kokkos PREFIX
build_kokkos() {
  local prefix=$1 processor built_with
  local stamp=$prefix/built-with
  processor=$(grep -m1 -E '^(model name|CPU part)' /proc/cpuinfo || true)
  built_with="$kokkos_version ${kokkos_options[*]} $(c++ --version | head -n1) $processor"
  [ "$(cat "$stamp" 2>/dev/null || true)" != "$built_with" ] || return 0
  provide_kokkos_source
  say "build Kokkos (Serial, OpenMP) into $prefix"
  rm -rf "$deps/kokkos-build" "$prefix"
  logged kokkos-configure cmake -G Ninja -S "$kokkos_source" -B "$deps/kokkos-build" \
    "-DCMAKE_INSTALL_PREFIX=$prefix" "${kokkos_options[@]}"
  logged kokkos-build cmake --build "$deps/kokkos-build" --target install
  rm -rf "$deps/kokkos-build"
  printf '%s\n' "$built_with" >"$stamp"
}

provide_kokkos_source() {
  if [ ! -f "$kokkos_source/CMakeLists.txt" ]; then
    [ -z "${CAYSPIN_KOKKOS_SOURCE:-}" ] || fail "CAYSPIN_KOKKOS_SOURCE: no Kokkos in $kokkos_source"
    rm -rf "$kokkos_source.part"
    source_from_release || source_from_package_index ||
      fail "no Kokkos source in reach; set CAYSPIN_KOKKOS_SOURCE to one, or CMAKE_PREFIX_PATH to an" \
           "installed Kokkos 4.5 to 5 (what was tried: $logs/kokkos-*.log)"
    mv "$kokkos_source.part" "$kokkos_source"
  fi
  if [ -z "${CAYSPIN_KOKKOS_SOURCE:-}" ]; then
    logged kokkos-mend cmake "-DKOKKOS_SOURCE=$kokkos_source" -P cmake/mend_kokkos_cuda13.cmake
  fi
}

# Gives up after 20 s without an answer, as in a network that drops packets.
source_from_release() {
  local file=$deps/kokkos-$release.tar.gz
  local url=https://github.com/kokkos/kokkos/releases/download/$release/kokkos-$release.tar.gz
  say "fetch Kokkos $kokkos_version"
  mkdir -p "$deps" "$logs" "$kokkos_source.part"
  timeout 300 python3 - "$url" "$file" >"$logs/kokkos-release.log" 2>&1 <<'PYTHON' || return 1
import shutil, sys, urllib.request
with urllib.request.urlopen(sys.argv[1], timeout=20) as answer, open(sys.argv[2], "wb") as file:
    shutil.copyfileobj(answer, file)
PYTHON
  unpack_checked "$file" "$release_sha256" "kokkos-$release" 1
}

# unpack_checked FILE SHA256 FOLDER DEPTH: checks an archive, unpacks what its FOLDER contains, and
# deletes the archive. DEPTH is the number of components of the path FOLDER.
unpack_checked() {
  printf '%s  %s\n' "$2" "$1" | sha256sum --check --quiet ||
    fail "$1 is not the file it should be; delete it and try again"
  tar -xzf "$1" -C "$kokkos_source.part" --strip-components="$4" "$3"
  rm "$1"
}

# The Python package index carries Kokkos inside a source distribution.
source_from_package_index() {
  local file=$deps/$carrier-$carrier_version.tar.gz
  say "its release is out of reach: fetch it in $carrier $carrier_version from the Python package index"
  mkdir -p "$deps" "$logs"
  python3 -m pip download --no-deps --no-binary "$carrier" --dest "$deps" \
    "$carrier==$carrier_version" >"$logs/kokkos-package-index.log" 2>&1 || return 1
  mkdir -p "$kokkos_source.part"
  unpack_checked "$file" "$carrier_sha256" "$carrier-$carrier_version/tpls/kokkos" 3
}

# Kokkos' nvcc_wrapper takes nvcc from PATH, where the toolkit does not put it.
find_nvcc() {
  local folder
  for folder in /usr/local/cuda/bin $(printf '%s\n' /usr/local/cuda-*/bin | sort -rV); do
    ! command -v nvcc >/dev/null || return 0
    [ ! -x "$folder/nvcc" ] || export PATH=$PATH:$folder
  done
  command -v nvcc >/dev/null
}

provide_nvcc() {
  find_nvcc || fail "no nvcc on PATH or in /usr/local/cuda*: install CUDA's toolkit"
}
