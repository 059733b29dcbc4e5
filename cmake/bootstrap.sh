#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# Installs what cayspin needs, and builds, tests and runs it from a clone. Usage: see the text
# below.
set -euo pipefail

usage() {
  cat <<'TXT'
Usage: bash cmake/bootstrap.sh deps|build|compile|test|test-all|python|wheels|docs|demo|bench|gpu
         [--preset NAME] [--python PYTHON]...
  deps     install everything that any of the others needs, and print the option for CMake
  build    build the program into build/NAME/bin
  compile  build everything and run nothing: for a GPU that is elsewhere
  test     build everything but the benchmarks and run the tests
  test-all the same, with the tests that take long, and those that compile the library once more:
           each header alone, with sanitizers, for nvcc, by clang, on a device that host threads play
  python   build the Python package and install it into build/venv
  wheels   build, into build/wheels/out, Python wheels that contain their libraries, for any x86-64
           with glibc 2.35 or newer; one for each interpreter PYTHON, the default being python3
  docs     build the documentation as a site, build/docs/site/index.html
  demo     build one small program, run a switching slab three ways and draw it: a first look
  bench    build and run the benchmarks; print and draw them beside their goals
  gpu      on a machine with a GPU: test and bench, and one report with the model of the GPU beside
Each verb first installs the Debian packages that it needs and builds Kokkos into .deps/.
NAME is a preset of CMakePresets.json; the default is release, and cuda for gpu.
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

# logged NAME COMMAND...: writes the output of the command to build/logs/NAME.log. If the command
# fails, prints the end of this file.
logged() {
  local log=$logs/$1.log
  shift
  mkdir -p "$logs"
  "$@" >"$log" 2>&1 || { tail -n 30 "$log" >&2; fail "failed: $* (all of it in $log)"; }
}

. "$root/cmake/bootstrap_packages.sh"
. "$root/cmake/bootstrap_kokkos.sh"
. "$root/cmake/bootstrap_wheels.sh"

# Switches on the parts that the verb needs. In a new build folder, the other parts are off; in an
# old one, they stay as they are.
choose_parts() {
  local part
  for part in APP PROGRAM PYTHON TESTS ALL_TESTS EXAMPLES BENCH MPI; do
    case " ${parts[*]} " in
      *" $part "*) options+=("-DCAYSPIN_BUILD_$part=ON") ;;
      *) [ -f "$build_dir/CMakeCache.txt" ] || options+=("-DCAYSPIN_BUILD_$part=OFF") ;;
    esac
  done
}

configure() {
  local options=()
  choose_parts
  options+=("${kokkos_option[@]}")
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

# python3-matplotlib takes half a minute to install, so it is installed while the compilation runs.
start_installing_drawing() {
  install_packages drawing "${drawing[@]}" &
  installing_drawing=$!
  trap wait EXIT
}

# Sets PYTHON for the scripts that draw, because the first python3 on PATH may lack Debian's
# packages.
finish_installing_drawing() {
  local candidate
  wait "$installing_drawing" || exit 1
  for candidate in python3 /usr/bin/python3; do
    if "$candidate" -c 'import h5py, matplotlib' 2>/dev/null; then
      export PYTHON=$candidate
      return
    fi
  done
  fail "no python3 with h5py and matplotlib"
}

install_python_package() {
  local venv=$root/build/venv
  [ -x "$venv/bin/python" ] || logged venv "$PYTHON" -m venv --system-site-packages "$venv"
  say "pip install . into build/venv (all of it in build/logs/pip.log)"
  mkdir -p "$logs"
  "$venv/bin/python" -m pip install --verbose . 2>&1 | tee "$logs/pip.log" |
    grep --line-buffered -oE '\[[0-9]+/[0-9]+\] .{0,80}|Successfully installed.*|(CMake Error|.*error:).*' ||
    fail "pip failed: see $logs/pip.log"
  say "import cayspin with $venv/bin/python; the program: $venv/bin/cayspin"
}

# Builds the documentation's site. Warnings are errors.
build_site() {
  local candidate
  provide_site_theme
  for candidate in python3 /usr/bin/python3; do
    PYTHONPATH=$deps/site "$candidate" -c 'import furo, myst_parser, sphinx' 2>/dev/null || continue
    say "build the site (all of it in build/logs/site.log)"
    logged site "$candidate" -B docs/site/build_site.py build/docs
    say "the site: $root/build/docs/site/index.html"
    return
  done
  fail "no python3 with sphinx, myst_parser and furo"
}

# Fails, before anything is built, if there is no GPU here to run it.
require_gpu() {
  case $preset in
    cuda)
      compgen -G '/dev/nvidia[0-9]*' >/dev/null ||
        fail "no NVIDIA GPU here: there is no /dev/nvidia0"
      provide_nvcc
      ;;
    hip) [ -e /dev/kfd ] || fail "no AMD GPU here: there is no /dev/kfd" ;;
    *) say "the preset $preset is not known to need a GPU; going on" ;;
  esac
}

# Failures do not end the script; the report includes them.
report_gpu() {
  mkdir -p "$build_dir"
  say "test (all of it in build/$preset/gpu-tests.txt)"
  ctest --preset "$preset" -j "$(nproc)" >"$build_dir/gpu-tests.txt" 2>&1 || say "tests failed"
  say "bench (its tables in build/$preset/gpu-bench.txt)"
  bash bench/run.sh "$build_dir" >"$build_dir/gpu-bench.txt" 2>&1 || say "the benchmarks failed"
  "$PYTHON" bench/gpu_report.py "$build_dir"
}

print_cmake_option() {
  say "everything is installed"
  if [ ${#kokkos_option[@]} -gt 0 ]; then
    say "your own build: cmake -B build ${kokkos_option[*]}"
  else
    say "your own build: cmake -B build (CMake finds Kokkos by itself)"
  fi
}

[ $# -ge 1 ] || { usage >&2; exit 2; }
verb=$1
shift
preset=release
[ "$verb" != gpu ] || preset=cuda
pythons=()
while [ $# -gt 0 ]; do
  case $1 in
    --preset) [ $# -ge 2 ] || fail "--preset needs a name"; preset=$2; shift 2 ;;
    --python) [ $# -ge 2 ] || fail "--python needs an interpreter"; pythons+=("$2"); shift 2 ;;
    *) usage >&2; exit 2 ;;
  esac
done
[ "$verb" = wheels ] || [ ${#pythons[@]} -eq 0 ] || fail "--python is for wheels"
build_dir=$root/build/$preset

if [ "$verb" = docs ]; then
  install_packages docs "${docs[@]}"
  build_site
  exit 0
fi

if [ "$verb" = wheels ]; then
  install_packages install "${core[@]}" "${io[@]}" "${program[@]}" "${python[@]}" zlib1g-dev
  [ ${#pythons[@]} -gt 0 ] || pythons=(python3)
  build_wheels
  exit 0
fi

case $verb in
  deps) packages=("${everything[@]}") parts=() ;;
  demo) packages=("${core[@]}" "${io[@]}") parts=(APP) ;;
  python) packages=("${core[@]}" "${io[@]}" "${program[@]}" "${python[@]}") parts=() ;;
  kokkos-source) provide_kokkos_source; exit 0 ;; # for CMake, under pip
  build) packages=("${core[@]}" "${io[@]}" "${program[@]}") parts=(APP PROGRAM) ;;
  test) packages=("${everything[@]}") parts=(APP PROGRAM TESTS EXAMPLES MPI) ;;
  test-all) packages=("${everything[@]}") parts=(APP PROGRAM TESTS ALL_TESTS EXAMPLES MPI) ;;
  compile) packages=("${everything[@]}") parts=(APP PROGRAM TESTS EXAMPLES BENCH MPI) ;;
  bench) packages=("${core[@]}" "${bench[@]}") parts=(BENCH) ;;
  gpu)
    require_gpu
    packages=("${everything[@]}") parts=(APP PROGRAM TESTS EXAMPLES BENCH MPI)
    ;;
  -h | --help) usage; exit 0 ;;
  *) usage >&2; exit 2 ;;
esac

if [ "$preset" = mpi ]; then
  packages+=("${mpi[@]}")
  parts+=(MPI)
fi

install_packages install "${packages[@]}"
start_installing_drawing
provide_kokkos
case "$verb $preset" in
  "test release" | "test-all release" | "test host-device") provide_nanobind ;;
esac
case $verb in
  deps)
    provide_style_tools
    provide_site_theme
    provide_nvdisasm
    finish_installing_drawing
    provide_interchange_tools
    print_cmake_option
    ;;
  build)
    finish_installing_drawing
    build cayspin_program cayspin_c
    say "the program: $build_dir/bin/cayspin"
    ;;
  compile)
    finish_installing_drawing
    build all
    say "compiled for the preset $preset: $build_dir"
    ;;
  test | test-all)
    provide_style_tools
    provide_site_theme
    [ "$verb" = test ] || provide_nvdisasm
    finish_installing_drawing
    provide_interchange_tools
    build all
    ctest --preset "$preset" -j "$(nproc)"
    ;;
  python) finish_installing_drawing; install_python_package ;;
  demo)
    build cayspin_demo
    finish_installing_drawing
    bash demo/run.sh "$build_dir"
    say "the program, which runs scenes: bash cmake/bootstrap.sh build, then"
    say "  build/$preset/bin/cayspin run scenes/slab_switching.toml; your own code: examples/"
    ;;
  bench) finish_installing_drawing; build bench; bash bench/run.sh "$build_dir" ;;
  gpu)
    provide_nvdisasm
    finish_installing_drawing
    build all bench
    report_gpu
    ;;
esac
