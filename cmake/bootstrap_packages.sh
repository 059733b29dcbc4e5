# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# shellcheck shell=bash disable=SC2034,SC2154
# Sourced by bootstrap.sh. The Debian packages by what needs them, install_packages for them, and
# provide_style_tools and provide_interchange_tools for what tests of these names run.

core=(g++ cmake ninja-build git ca-certificates python3 python3-pip) # the header library, Kokkos
io=(libhdf5-dev libfmt-dev libmuparser-dev libtomlplusplus-dev libeigen3-dev) # scenes and files
program=(libcli11-dev nlohmann-json3-dev)
drawing=(python3-h5py python3-matplotlib)
tests=(libgtest-dev nlohmann-json3-dev valgrind clang libomp-dev doxygen)
bench=(libbenchmark-dev)
everything=("${core[@]}" "${io[@]}" "${program[@]}" "${tests[@]}" "${bench[@]}") # but drawing

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

# provide_tools NAME PYTHON: the versions that tests/NAME/requirements.txt pins, from the Python
# package index, in .deps/NAME.
provide_tools() {
  local name=$1 python=$2
  local tools=$deps/$name pins=$root/tests/$name/requirements.txt
  ! cmp -s "$pins" "$tools/installed" || return 0
  say "fetch $(sed 's/==.*//' "$pins" | paste -sd ' ')"
  rm -rf "$tools"
  mkdir -p "$logs"
  if "$python" -m pip install --no-compile --no-deps --target "$tools" -r "$pins" \
    >"$logs/$name.log" 2>&1; then
    cp "$pins" "$tools/installed"
  else
    rm -rf "$tools"
    say "the Python package index is out of reach: tests of $name are left out ($logs/$name.log)"
  fi
}

# What the test `style` runs.
provide_style_tools() { provide_tools style python3; }

# The programs of others that the tests `interchange` hold files to: for the Python of the tests,
# which has the packages that they need.
provide_interchange_tools() { provide_tools interchange "$PYTHON"; }
