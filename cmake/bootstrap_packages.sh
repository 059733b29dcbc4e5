# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# shellcheck shell=bash disable=SC2034,SC2154
# Sourced by bootstrap.sh. Lists Debian packages by what needs them. install_packages installs them.
# The functions provide_... fetch tools, most of them for tests, from the Python package index.

core=(g++ cmake ninja-build git ca-certificates python3 python3-pip) # the header library, Kokkos
io=(libhdf5-dev libfmt-dev libmuparser-dev libtomlplusplus-dev libeigen3-dev libpng-dev) # scenes and files
program=(libcli11-dev nlohmann-json3-dev libfftw3-dev help2man)
python=(python3-dev python3-venv) # the Python package, with nanobind from the package index
drawing=(python3-h5py python3-matplotlib python3-tornado)
mpi=(mpich libmpich-dev)
# For the documentation's site. Its theme comes from the package index, because Debian's furo has no
# dark colours.
docs=(doxygen python3-sphinx python3-myst-parser sphinx-basic-ng python3-bs4)
tests=("${mpi[@]}" "${docs[@]}" libgtest-dev nlohmann-json3-dev valgrind clang libclang-rt-14-dev libomp-dev pkg-config
  python3-nbclient python3-ipykernel python3-xarray chromium chromium-driver
  python3-selenium zsh)
bench=(libbenchmark-dev)
everything=("${core[@]}" "${io[@]}" "${program[@]}" "${python[@]}" "${tests[@]}" "${bench[@]}") # except drawing
# Debian 12 has these. Where apt does not have one, the tests that need it are skipped.
left_out_where_unknown=(chromium chromium-driver libclang-rt-14-dev)

is_installed() {
  [ "$(dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null)" = installed ]
}

# Drops from `missing` the packages of left_out_where_unknown that apt does not have.
select_known_packages() {
  local package known=()
  for package in "${missing[@]}"; do
    case " ${left_out_where_unknown[*]} " in
      *" $package "*)
        [ -n "$(apt-cache show --no-all-versions "$package" 2>/dev/null)" ] ||
          { say "leave out $package, which apt does not have"; continue; }
        ;;
    esac
    known+=("$package")
  done
  missing=("${known[@]}")
}

# install_packages LOG PACKAGE...: installs those that are missing.
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
  if [ -z "${packages_are_listed:-}" ]; then
    logged apt-update "${become_root[@]}" apt-get update
    packages_are_listed=yes
  fi
  select_known_packages
  [ ${#missing[@]} -gt 0 ] || return 0
  say "install ${missing[*]}"
  logged "apt-$log" "${become_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y --no-install-recommends "${missing[@]}"
}

# provide_tools NAME PYTHON PINS: installs the versions listed in the file PINS, from the Python
# package index, into .deps/NAME.
provide_tools() {
  local name=$1 python=$2 pins=$3
  local tools=$deps/$name
  ! cmp -s "$pins" "$tools/installed" || return 0
  say "fetch $(sed 's/==.*//' "$pins" | paste -sd ' ')"
  rm -rf "$tools"
  mkdir -p "$logs"
  if "$python" -m pip install --no-compile --no-deps --target "$tools" -r "$pins" \
    >"$logs/$name.log" 2>&1; then
    cp "$pins" "$tools/installed"
  else
    rm -rf "$tools"
    say "the Python package index is out of reach: what needs $name is left out ($logs/$name.log)"
  fi
}

# Tools of the test `style`.
provide_style_tools() { provide_tools style python3 "$root/tests/style/requirements.txt"; }

# The theme of the site.
provide_site_theme() { provide_tools site python3 "$root/docs/site/requirements.txt"; }

# nvdisasm, which the test `sass` runs where there is nvcc.
provide_nvdisasm() {
  ! find_nvcc || provide_tools nvdisasm python3 "$root/tests/cuda/requirements.txt"
}

# Other projects' programs that must read our files in the tests `interchange`. They are installed
# for the Python of the tests, which has the packages that they need.
provide_interchange_tools() {
  provide_tools interchange "$PYTHON" "$root/tests/interchange/requirements.txt"
}

# nanobind: headers and CMake files for compiling the module of the Python package.
provide_nanobind() {
  provide_tools nanobind python3 "$root/python/build_requirements.txt"
  [ ! -d "$deps/nanobind" ] || parts+=(PYTHON)
}
