// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/scene.hpp"

#include <cayspin/spin_field.hpp>

#include <cstdint>
#include <functional>

// A scene's field.demag or field.dipoles. In src, only demagnetization.cpp includes FFTW.
namespace cayspin::simulation {

/// Function that writes H of the spins into a field.
template <class Real>
using FieldOnHost = std::function<void(SpinField<Real, Kokkos::HostSpace> const& spins,
                                       SpinField<Real, Kokkos::HostSpace> const& field)>;

/// Function that writes H in the memory space of the spins.
template <class Spins>
using FieldInPlace = std::function<void(typename Spins::memory_space::execution_space const& exec,
                                        Spins const& spins, Spins const& field)>;

/// Returns the field of a scene's demag; `mu0` multiplies its strength.
template <class Real>
FieldOnHost<Real> demagnetization_on_host(io::Demagnetization const& demag, double mu0,
                                          Lattice const& lattice);

/// Returns the field for spins in the memory of a device; empty for dipoles, for a part of a
/// lattice, and if this build has no Fourier transforms for that device.
template <class Spins>
FieldInPlace<Spins> demagnetization_in_place(io::Demagnetization const& demag, double mu0,
                                             Lattice const& lattice);

/// Returns the bytes of memory that the field's Fourier transforms need.
template <class Real>
std::int64_t demagnetization_bytes(io::Demagnetization const& demag, Lattice const& lattice);

/// Throws io::SceneError for a demagnetising field in a build without FFTW.
void require_demagnetization(io::Scene const& scene);

}  // namespace cayspin::simulation
