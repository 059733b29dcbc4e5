# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# shellcheck shell=bash disable=SC2034,SC2154
# Sourced by bootstrap.sh. The Debian packages by what needs them, install_packages for them, and
# provide_style_tools for what the test `style` runs.

core=(g++ cmake ninja-build git ca-certificates python3 python3-pip) # the header library, Kokkos
io=(libhdf5-dev libfmt-dev libmuparser-dev libtomlplusplus-dev libeigen3-dev) # scenes and files
program=(libcli11-dev nlohmann-json3-dev)
python=(python3-dev python3-venv) # the Python package, with nanobind from the package index
drawing=(python3-h5py python3-matplotlib)
tests=(libgtest-dev nlohmann-json3-dev valgrind clang libomp-dev doxygen libfftw3-dev pkg-config
  python3-yaml python3-jinja2 python3-nbclient python3-ipykernel python3-xarray)
bench=(libbenchmark-dev)
everything=("${core[@]}" "${io[@]}" "${program[@]}" "${python[@]}" "${tests[@]}" "${bench[@]}") # but drawing

is_installed() {
  [ "$(dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null)" = installed ]
}

# install_packages LOG PACKAGE...: those that are missing.
install_packages() {
  local log=$1 missing=() package become_root=()
  shift
  if ! command -v dpkg-query >/dev/null; then
    say "not a Debian system: taking for granted what these packages hold: $*"
    return
  fi
  for package in "$@"; do
    is_installed "$package" || missing+=("$package")
  done
  [ ${#missing[@]} -gt 0 ] || return 0

  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null ||
      fail "no right to install packages; ask for: apt-get install ${missing[*]}"
    become_root=(sudo)
  fi
  say "install ${missing[*]}"
  if [ -z "${packages_are_listed:-}" ]; then
    logged apt-update "${become_root[@]}" apt-get update
    packages_are_listed=yes
  fi
  logged "apt-$log" "${become_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y --no-install-recommends "${missing[@]}"
}

# The versions that tests/style/requirements.txt pins, from the Python package index.
provide_style_tools() {
  local tools=$deps/style pins=$root/tests/style/requirements.txt
  ! cmp -s "$pins" "$tools/installed" || return 0
  say "fetch clang-format, cmake-format and typos"
  rm -rf "$tools"
  mkdir -p "$logs"
  if python3 -m pip install --no-compile --target "$tools" -r "$pins" >"$logs/style.log" 2>&1; then
    cp "$pins" "$tools/installed"
  else
    rm -rf "$tools"
    say "the Python package index is out of reach: there is no test style ($logs/style.log)"
  fi
}

# Headers and CMake files that the module of the Python package is compiled with.
provide_nanobind() {
  local tools=$deps/nanobind pin=nanobind==3.1.0
  parts+=(PYTHON)
  [ "$(cat "$tools/installed" 2>/dev/null || true)" != "$pin" ] || return 0
  say "fetch $pin"
  rm -rf "$tools"
  mkdir -p "$logs"
  if python3 -m pip install --no-compile --target "$tools" "$pin" >"$logs/nanobind.log" 2>&1; then
    printf '%s\n' "$pin" >"$tools/installed"
  else
    rm -rf "$tools"
    say "the Python package index is out of reach: no Python package ($logs/nanobind.log)"
    unset 'parts[-1]'
  fi
}
