# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# shellcheck shell=bash disable=SC2154
# Sourced by bootstrap.sh. install_packages: the Debian packages that are missing.

packages=(
  g++ cmake ninja-build git ca-certificates pkg-config python3 python3-pip
  libeigen3-dev libhdf5-dev libtomlplusplus-dev libcli11-dev libfmt-dev libmuparser-dev
  libgtest-dev libbenchmark-dev nlohmann-json3-dev python3-h5py python3-matplotlib valgrind
)

is_installed() {
  [ "$(dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null)" = installed ]
}

install_packages() {
  local missing=() package become_root=()
  if ! command -v dpkg-query >/dev/null; then
    say "not a Debian system: taking for granted what these packages hold: ${packages[*]}"
    return
  fi
  for package in "${packages[@]}"; do
    is_installed "$package" || missing+=("$package")
  done
  [ ${#missing[@]} -gt 0 ] || return 0

  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null ||
      fail "no right to install packages; ask for: apt-get install ${missing[*]}"
    become_root=(sudo)
  fi
  say "install ${missing[*]}"
  logged apt-update "${become_root[@]}" apt-get update
  logged apt-install "${become_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y --no-install-recommends "${missing[@]}"
}
