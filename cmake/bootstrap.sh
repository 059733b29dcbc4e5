#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# From a clone to a built, tested, running cayspin. Usage: see the text below.
set -euo pipefail

usage() {
  cat <<'TXT'
Usage: bash cmake/bootstrap.sh deps|build|compile|test|demo|bench [--preset NAME]
  deps     install what is missing: Debian packages, and Kokkos into .deps/
  build    deps, then the program into build/NAME/bin
  compile  build everything and run nothing: for a GPU that is elsewhere
  test     build everything and run the tests
  demo     build one small program, run a switching slab three ways and draw it: a first look
  bench    build and run the benchmarks; print and draw them beside their goals
NAME is a preset of CMakePresets.json; the default is release.
TXT
}

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root"
deps=$root/.deps
logs=$root/build/logs
kokkos_version=4.7.0
kokkos_source=${CAYSPIN_KOKKOS_SOURCE:-$deps/kokkos-source}

say() { printf 'cayspin: %s\n' "$*"; }
fail() { printf 'cayspin: %s\n' "$*" >&2; exit 1; }

# logged NAME COMMAND...: the command's output goes to build/logs/NAME.log, shown when it fails.
logged() {
  local log=$logs/$1.log
  shift
  mkdir -p "$logs"
  "$@" >"$log" 2>&1 || { tail -n 30 "$log" >&2; fail "failed: $* (all of it in $log)"; }
}

. "$root/cmake/bootstrap_packages.sh"
. "$root/cmake/bootstrap_kokkos.sh"

configure() {
  local options=()
  if [ "$preset" = release ]; then
    [ -z "$kokkos_prefix" ] || options+=("-DKokkos_ROOT=$kokkos_prefix")
  else
    options+=("-DCAYSPIN_KOKKOS_SOURCE=$kokkos_source")
  fi
  if [ "$preset" = cuda ]; then
    provide_nvcc
    options+=("-DCMAKE_CXX_COMPILER=$kokkos_source/bin/nvcc_wrapper")
  fi
  say "configure $preset"
  logged configure cmake --preset "$preset" "${options[@]}"
  grep -A3 '^-- cayspin ' "$logs/configure.log"
}

# build TARGET...
build() {
  configure
  say "build $preset: $*"
  logged build cmake --build --preset "$preset" --target "$@"
}

# The scripts that draw read PYTHON: an interpreter put in front of Debian's may lack its packages.
choose_python() {
  local candidate
  for candidate in python3 /usr/bin/python3; do
    if "$candidate" -c 'import h5py, matplotlib' 2>/dev/null; then
      export PYTHON=$candidate
      return
    fi
  done
  fail "no python3 with h5py and matplotlib"
}

[ $# -ge 1 ] || { usage >&2; exit 2; }
verb=$1
shift
preset=release
while [ $# -gt 0 ]; do
  case $1 in
    --preset) [ $# -ge 2 ] || fail "--preset needs a name"; preset=$2; shift 2 ;;
    *) usage >&2; exit 2 ;;
  esac
done
case $verb in
  deps | build | compile | test | demo | bench) ;;
  -h | --help) usage; exit 0 ;;
  *) usage >&2; exit 2 ;;
esac
build_dir=$root/build/$preset

install_packages
provide_kokkos
case $verb in
  deps) say "everything needed is there" ;;
  build) build cayspin_program; say "the program: $build_dir/bin/cayspin" ;;
  compile) build all; say "compiled for the preset $preset: $build_dir" ;;
  test) build all; ctest --preset "$preset" -j "$(nproc)" ;;
  demo)
    choose_python
    build cayspin_demo
    bash demo/run.sh "$build_dir"
    say "the program, which runs scenes: bash cmake/bootstrap.sh build, then"
    say "  build/$preset/bin/cayspin run scenes/slab_switching.toml; your own code: examples/"
    ;;
  bench) choose_python; build bench; bash bench/run.sh "$build_dir" ;;
esac
