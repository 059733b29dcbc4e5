// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

/// Conversion between SI and the reduced units of the library. Needs no Kokkos.
/// docs/guide/units.md derives the formulas.
namespace cayspin::inline v0_2::units {

// CODATA 2022.
inline constexpr double vacuum_permeability = 1.25663706127e-6;  ///< N/A^2
inline constexpr double bohr_magneton = 9.2740100657e-24;        ///< J/T
inline constexpr double boltzmann = 1.380649e-23;                ///< J/K
inline constexpr double electronvolt = 1.602176634e-19;          ///< J
inline constexpr double rydberg = 2.1798723611030e-18;           ///< J
inline constexpr double elementary_charge = 1.602176634e-19;     ///< C
inline constexpr double reduced_planck = 1.054571817e-34;        ///< J s
/// |gamma| of the free electron, rad/(s T).
inline constexpr double electron_gamma = 1.760859e11;

namespace detail {
inline double positive(double value, char const* what) {
  if (!(value > 0) || !std::isfinite(value))
    throw std::invalid_argument(std::string("cayspin::units: ") + what +
                                " must be positive and finite");
  return value;
}
}  // namespace detail

/// A damping constant, of Gilbert's equation or of Landau and Lifshitz's. In both forms the
/// constant is the `damping` of LandauLifshitz; only the unit of time differs.
class Damping {
 public:
  Damping() = default;  ///< none

  double alpha() const { return alpha_; }
  /// Returns the factor of the unit of time: 1 + alpha^2 in Gilbert's form, otherwise 1.
  double time_factor() const { return time_factor_; }

  friend Damping gilbert(double alpha);
  friend Damping landau_lifshitz(double alpha);

 private:
  Damping(double alpha, double time_factor) : alpha_(alpha), time_factor_(time_factor) {
    if (!(alpha >= 0) || !std::isfinite(alpha))
      throw std::invalid_argument("cayspin::units: the damping must be >= 0 and finite");
  }
  double alpha_ = 0, time_factor_ = 1;
};

/// dm/dt = -gamma * m x B + alpha * m x dm/dt. Throws std::invalid_argument when alpha is negative
/// or not finite.
inline Damping gilbert(double alpha) { return {alpha, 1 + alpha * alpha}; }
/// dm/dt = -gamma * m x B - alpha * gamma * m x (m x B). Throws like gilbert.
inline Damping landau_lifshitz(double alpha) { return {alpha, 1}; }

/// A current through a magnet.
struct PolarizedCurrent {
  double density = 0;       ///< j, A/m^2
  double polarization = 0;  ///< P
  double Ms = 0;            ///< saturation magnetization, A/m
  double gamma = electron_gamma;
};
/// Returns the velocity of Zhang and Li's torque in m/s, as defined by Thiaville et al. (2005):
/// u = -g * mu_B * P * j / (2 * e * Ms), with g * mu_B = gamma * hbar. Electrons move against the
/// current, and so do walls if P > 0. Throws std::invalid_argument when Ms is not positive and
/// finite.
///   drift_velocity({.density = 1e12, .polarization = 0.4, .Ms = 8e5})
inline double drift_velocity(PolarizedCurrent const& current) {
  return -current.gamma * reduced_planck * current.polarization * current.density /
         (2 * elementary_charge * detail::positive(current.Ms, "Ms"));
}

/// A current that injects spins into a magnetic layer.
struct LayerCurrent {
  double density = 0;     ///< j, A/m^2
  double efficiency = 0;  ///< polarization or spin Hall angle
  double Ms = 0;          ///< saturation magnetization of the layer, A/m
  double thickness = 0;   ///< of the layer, m
};
/// Returns the damping-like torque of a current in T:
/// hbar * j * efficiency / (2 * e * Ms * thickness).
/// If j * efficiency is positive, spins turn towards the polarization. Throws std::invalid_argument
/// when Ms or the thickness is not positive and finite.
///   spin_torque({.density = 1e12, .efficiency = 0.1, .Ms = 8e5, .thickness = 3e-9})
inline double spin_torque(LayerCurrent const& current) {
  return reduced_planck * current.efficiency * current.density /
         (2 * elementary_charge * detail::positive(current.Ms, "Ms") *
          detail::positive(current.thickness, "the thickness"));
}

/// SI values of the reduced units, and conversions.
class ReducedUnits {
 public:
  double time_unit() const { return time_; }      ///< s
  double length_unit() const { return length_; }  ///< m
  double field_unit() const { return field_; }    ///< T, of B = mu0 H
  double energy_unit() const { return energy_; }  ///< J
  /// Unit of the velocity of ZhangLi, in m/s: length_unit() * Damping::time_factor() / time_unit().
  /// The unit of time contains the time factor, and so applies it to all terms of the equation,
  /// ZhangLi included. The velocity must not contain the factor a second time.
  double velocity_unit() const { return velocity_; }
  double damping() const { return damping_; }  ///< of LandauLifshitz

  double time(double seconds) const { return seconds / time_; }
  double length(double metres) const { return metres / length_; }
  double velocity(double metres_per_second) const { return metres_per_second / velocity_; }
  double applied(double tesla) const { return tesla / field_; }
  double applied_from_ampere_per_metre(double h) const { return applied(vacuum_permeability * h); }
  double energy(double joules) const { return joules / energy_; }
  double temperature(double kelvin) const { return boltzmann * kelvin / energy_; }
  /// Converts a rate, such as an angular frequency.
  double rate(double per_second) const { return per_second * time_; }

  double seconds(double time) const { return time * time_; }
  double metres(double length) const { return length * length_; }
  double tesla(double field) const { return field * field_; }
  double joules(double energy) const { return energy * energy_; }
  double kelvin(double temperature) const { return temperature * energy_ / boltzmann; }
  double per_second(double rate) const { return rate / time_; }

 protected:
  /// `moment`: of a spin or of a cell, J/T.
  ReducedUnits(double moment, double energy, double length, double gamma, Damping const& damping)
      : time_(damping.time_factor() * moment / (detail::positive(gamma, "gamma") * energy)),
        length_(length),
        field_(energy / moment),
        energy_(energy),
        velocity_(length * gamma * field_),
        damping_(damping.alpha()) {}

 private:
  double time_, length_, field_, energy_, velocity_, damping_;
};

/// Units of micromagnetics. The unit of H is Ms, that of energy is mu0 * Ms^2 * (volume of a cell),
/// and that of length is the cell's extent along x.
class Micromagnetic : public ReducedUnits {
 public:
  /// Constants that define the units.
  struct Material {
    double Ms = 0;                    ///< saturation magnetization, A/m
    std::array<double, 3> cell = {};  ///< extents of a cell, m
    Damping damping = {};             ///< gilbert(alpha) or landau_lifshitz(alpha)
    double gamma = electron_gamma;    ///< |gamma|, rad/(s T); gamma0 = mu0 * gamma in m/(A s)
  };

  /// Throws std::invalid_argument for values that are not positive and finite.
  explicit Micromagnetic(Material const& material)
      : Micromagnetic(material, detail::positive(material.Ms, "Ms"), volume_of(material.cell)) {}

  std::array<double, 3> spacing() const { return spacing_; }

  /// Returns the constant of Exchange, from A in J/m.
  double exchange(double A) const { return 2 * A / (pressure_ * length_unit() * length_unit()); }
  /// Returns the constant of UniaxialAnisotropy, from Ku in J/m^3 with E = -Ku * V * (m.e)^2 for a
  /// cell of volume V.
  double anisotropy(double Ku) const { return 2 * Ku / pressure_; }
  /// Returns the constant of CubicAnisotropy, from Kc in J/m^3.
  double cubic_anisotropy(double Kc) const { return Kc / pressure_; }
  /// Returns the constant of InterfacialDmi and BulkDmi, from D in J/m^2.
  double dmi(double D) const { return D / (pressure_ * length_unit()); }
  /// Returns the strength of SlabDemag, from a demagnetising factor.
  double demagnetization(double factor) const { return factor; }

 private:
  static double volume_of(std::array<double, 3> const& cell) {
    for (double const extent : cell) detail::positive(extent, "each extent of a cell");
    return cell[0] * cell[1] * cell[2];
  }
  Micromagnetic(Material const& material, double Ms, double volume)
      : ReducedUnits(Ms * volume, vacuum_permeability * Ms * Ms * volume, material.cell[0],
                     material.gamma, material.damping),
        pressure_(vacuum_permeability * Ms * Ms),
        spacing_{1, material.cell[1] / material.cell[0], material.cell[2] / material.cell[0]} {}

  double pressure_;  // mu0 * Ms^2
  std::array<double, 3> spacing_;
};

/// Units of atomistic spins with E = -J * sum(S_i.S_j) - K * sum((S.e)^2) - mu_s * sum(S.B), where
/// the first sum counts each pair once. Lattices have a spacing of 1.
class Atomistic : public ReducedUnits {
 public:
  /// Constants that define the units.
  struct Material {
    double mu_s = 0;                ///< moment of an atom, J/T
    double energy = 0;              ///< unit of energy, such as |J|, in joules
    double lattice_constant = 0;    ///< m
    Damping damping = {};           ///< gilbert(alpha) or landau_lifshitz(alpha)
    double gamma = electron_gamma;  ///< |gamma|, rad/(s T)
  };

  /// Throws std::invalid_argument for values that are not positive and finite.
  explicit Atomistic(Material const& material)
      : ReducedUnits(detail::positive(material.mu_s, "mu_s"),
                     detail::positive(material.energy, "the unit of energy"),
                     detail::positive(material.lattice_constant, "the lattice constant"),
                     material.gamma, material.damping),
        dipolar_(vacuum_permeability * material.mu_s * material.mu_s /
                 std::pow(material.lattice_constant, 3) / material.energy) {}

  /// Returns the constant of Exchange, from J in joules. The energy of Exchange is 0 for parallel
  /// spins.
  double exchange(double J) const { return J / energy_unit(); }
  /// Returns the constant of UniaxialAnisotropy, from K in joules.
  double anisotropy(double K) const { return 2 * K / energy_unit(); }
  /// Returns the constant of CubicAnisotropy, from Kc in joules.
  double cubic_anisotropy(double Kc) const { return Kc / energy_unit(); }
  /// Returns the constant of InterfacialDmi and BulkDmi, from the D of a bond in joules.
  double dmi(double D) const { return D / energy_unit(); }
  /// Returns the strength of SlabDemag, from a demagnetising factor.
  double demagnetization(double factor) const { return factor * dipolar_; }

 private:
  double dipolar_;  // mu0 * mu_s^2 / a^3, in units of energy
};

}  // namespace cayspin::inline v0_2::units
