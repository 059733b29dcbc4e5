// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/scene.hpp"

#include <cayspin/spin_field.hpp>

#include <cstdint>
#include <functional>

// A scene's field.demag or field.dipoles. In src, only demagnetization.cpp includes FFTW.
namespace cayspin::simulation {

/// Function that computes H of the spins in host memory.
template <class Real>
using FieldOnHost = std::function<void(SpinField<Real, Kokkos::HostSpace> const& spins,
                                       SpinField<Real, Kokkos::HostSpace> const& field)>;

/// Function that computes H of the spins in their own memory space.
template <class Spins>
using FieldInPlace = std::function<void(typename Spins::memory_space::execution_space const& exec,
                                        Spins const& spins, Spins const& field)>;

/// Returns the function for a scene's field.demag or field.dipoles, whose strength is multiplied by
/// `mu0`.
template <class Real>
FieldOnHost<Real> demagnetization_on_host(io::Demagnetization const& demag, double mu0,
                                          Lattice const& lattice);

/// Returns the function for spins in the memory of a device. It is empty for dipoles, for a part of
/// a lattice, and if this build has no Fourier transforms for that device.
template <class Spins>
FieldInPlace<Spins> demagnetization_in_place(io::Demagnetization const& demag, double mu0,
                                             Lattice const& lattice);

/// Returns the bytes of memory that the field's Fourier transforms need.
template <class Real>
std::int64_t demagnetization_bytes(io::Demagnetization const& demag, Lattice const& lattice);

/// Throws io::SceneError if the scene has field.demag or field.dipoles and this build has no FFTW.
void require_demagnetization(io::Scene const& scene);

}  // namespace cayspin::simulation
