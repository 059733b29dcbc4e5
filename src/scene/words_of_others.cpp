// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "io/words_of_others.hpp"

#include "io/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <initializer_list>
#include <vector>

namespace cayspin::inline v0_2::io {
namespace {

struct ForeignWord {
  std::string_view of_others, here;
};

// Lower-case words of mumax3 and mumax+, OOMMF and Ubermag, Spirit, Vampire, UppASD, Sunny.
constexpr std::array foreign_words{
    ForeignWord{"msat", "material.Ms"},
    ForeignWord{"aex", "material.A, in reduced units field.exchange"},
    ForeignWord{"dind", "material.D, in reduced units field.dmi"},
    ForeignWord{"dbulk", "material.D_bulk, in reduced units field.dmi"},
    ForeignWord{"ku1", "material.Ku, in reduced units field.anisotropy"},
    ForeignWord{"kc1", "field.anisotropy = { cubic = K, axes = [..] }"},
    ForeignWord{"anisu", "material.axis"},
    ForeignWord{"anisc1", "field.anisotropy = { cubic = K, axes = [..] }"},
    ForeignWord{"b_ext", "field.applied"},
    ForeignWord{"bext", "field.applied"},
    ForeignWord{"external_field", "field.applied"},
    ForeignWord{"external_field_magnitude", "field.applied"},
    ForeignWord{"applied_field", "field.applied"},
    ForeignWord{"zeeman", "field.applied"},
    ForeignWord{"enabledemag", "field.demag"},
    ForeignWord{"demagnetization", "field.demag"},
    ForeignWord{"ddi_method", "field.dipoles"},
    ForeignWord{"pbc", "lattice.boundary"},
    ForeignWord{"setpbc", "lattice.boundary"},
    ForeignWord{"boundary_conditions", "lattice.boundary"},
    ForeignWord{"cellsize", "lattice.spacing"},
    ForeignWord{"lattice_constant", "lattice.spacing"},
    ForeignWord{"gridsize", "lattice.shape"},
    ForeignWord{"n_basis_cells", "lattice.shape"},
    ForeignWord{"ncell", "lattice.shape"},
    ForeignWord{"setgeom", "lattice.occupied"},
    ForeignWord{"geometry", "lattice.occupied"},
    ForeignWord{"defregion", "lattice.regions"},
    ForeignWord{"bravais_lattice", "lattice.crystal"},
    ForeignWord{"posfile", "lattice.basis"},
    ForeignWord{"momfile", "lattice.moments"},
    ForeignWord{"mu_spin", "material.mu_s"},
    ForeignWord{"atomic-spin-moment", "material.mu_s"},
    ForeignWord{"maxerr", "integrator.tolerance"},
    ForeignWord{"fixdt", "integrator.dt"},
    ForeignWord{"timestep", "integrator.dt"},
    ForeignWord{"time-step", "integrator.dt"},
    ForeignWord{"llg_dt", "integrator.dt"},
    ForeignWord{"llg_n_iterations", "integrator.steps"},
    ForeignWord{"nstep", "integrator.steps"},
    ForeignWord{"solver", "integrator.method"},
    ForeignWord{"setsolver", "integrator.method"},
    ForeignWord{"alpha", "system.damping, in SI material.alpha"},
    ForeignWord{"lambda", "system.damping, in SI material.alpha"},
    ForeignWord{"lambda1", "system.damping, in SI material.alpha"},
    ForeignWord{"llg_damping", "system.damping, in SI material.alpha"},
    ForeignWord{"gammall", "material.gamma"},
    ForeignWord{"xi", "torque.zhang_li.nonadiabaticity"},
    ForeignWord{"llg_beta", "torque.zhang_li.nonadiabaticity"},
    ForeignWord{"pol", "torque.slonczewski.efficiency or torque.zhang_li.polarization"},
    ForeignWord{"fixedlayer", "torque.slonczewski.polarization"},
    ForeignWord{"temp", "thermal.temperature"},
    ForeignWord{"llg_temperature", "thermal.temperature"},
    ForeignWord{"thermseed", "thermal.seed"},
    ForeignWord{"llg_seed", "thermal.seed"},
    ForeignWord{"exchange-matrix", "field.couplings"},
    ForeignWord{"jij", "field.couplings"},
    ForeignWord{"n_shells_exchange", "field.couplings = { shells = [..] }"},
    ForeignWord{"interaction_pairs_file", "field.couplings"},
    ForeignWord{"n_interaction_pairs", "field.couplings"},
    ForeignWord{"pairs", "field.couplings"},
    ForeignWord{"jfile", "field.couplings"},
    ForeignWord{"dmfile", "field.couplings, each bond with its D"},
    ForeignWord{"unit-cell-file", "field.couplings = { file = \"NAME.ucf\" }"},
    ForeignWord{"autosave", "output.every"},
    ForeignWord{"tableautosave", "output.scalars_every"},
    ForeignWord{"rkky",
                "field.interlayer = [{ between = [a, b], J = 2 sigma, biquadratic = 2 sigma2 }]"},
    ForeignWord{"ext_interexchange", "field.exchange_between = [{ between = [a, b], factor = f }]"},
    ForeignWord{"ext_scaleexchange", "field.exchange_between = [{ between = [a, b], factor = f }]"},
    ForeignWord{"epsilonprime", "torque.slonczewski.epsilon_prime"},
    ForeignWord{"geom", "lattice.occupied"},
    ForeignWord{"edgesmooth", "lattice.occupied (a cell is either in or out)"},
    ForeignWord{"bmagnoisescale", "thermal.temperature"},
    ForeignWord{"setgridsize", "lattice.shape"},
    ForeignWord{"setcellsize", "lattice.spacing"},
    ForeignWord{"h_ext", "field.applied, in SI mu0 H in T"},
    ForeignWord{"hext", "field.applied, in SI mu0 H in T"},
    ForeignWord{"happ", "field.applied, in SI mu0 H in T"},
    ForeignWord{"bc", "lattice.boundary"},
    ForeignWord{"pbc_x", "lattice.boundary"},
    ForeignWord{"pbc_y", "lattice.boundary"},
    ForeignWord{"pbc_z", "lattice.boundary"},
    ForeignWord{"dx", "lattice.spacing"},
    ForeignWord{"dy", "lattice.spacing"},
    ForeignWord{"dz", "lattice.spacing"},
    ForeignWord{"nx", "lattice.shape"},
    ForeignWord{"ny", "lattice.shape"},
    ForeignWord{"nz", "lattice.shape"},
    ForeignWord{"unit-cell-size", "lattice.spacing"},
    ForeignWord{"alat", "lattice.spacing"},
    ForeignWord{"bravais_vectors", "lattice.cell"},
    ForeignWord{"anisotropy_magnitude", "material.K, in reduced units field.anisotropy"},
    ForeignWord{"interaction_pairs", "field.couplings"},
    ForeignWord{"dij", "field.couplings, each bond with its D"},
    ForeignWord{"tmax", "integrator.end"},
    ForeignWord{"t_end", "integrator.end"},
    ForeignWord{"tstep", "integrator.dt"},
    ForeignWord{"mxstep", "integrator.steps"},
    ForeignWord{"total-time-steps", "integrator.steps"},
    ForeignWord{"random_seed", "thermal.seed, or initial.random = { seed = N }"},
    ForeignWord{"iseed", "thermal.seed, or initial.random = { seed = N }"},
    ForeignWord{"mode", "cayspin run, with [thermal] at a temperature"},
    ForeignWord{"relax", "cayspin relax, or relax = true in a [[stage]]"},
    ForeignWord{"dear", "multirate"},
    ForeignWord{"regrid", "initial.file, of a lattice of the same shape"},
    ForeignWord{"anisc2", "field.anisotropy = { cubic = K, axes = [..] }"},
    ForeignWord{"openbc", "field.dmi.free_boundary, in SI material.free_boundary"},
    ForeignWord{"addfieldterm", "field.sources"},
    ForeignWord{"ext_centerwall", "lattice.follow"},
    ForeignWord{"ext_centerbubble", "lattice.follow"},
    ForeignWord{"run", "cayspin run, to integrator.end"},
    ForeignWord{"saveas", "cayspin export"},
    ForeignWord{"n_shells_dmi", "field.couplings, each bond with its D"},
    ForeignWord{"dm_chirality", "field.couplings, each bond with its D"},
    ForeignWord{"anisotropy_normal", "material.axis, in reduced units field.anisotropy"},
    ForeignWord{"external_field_normal", "field.applied"},
    ForeignWord{"crystal-structure", "lattice.crystal"},
    ForeignWord{"uniaxial-anisotropy-constant", "material.K, in reduced units field.anisotropy"},
    ForeignWord{"damping-constant", "system.damping, in SI material.alpha"},
    ForeignWord{"applied-field-strength", "field.applied"},
    ForeignWord{"applied-field-unit-vector", "field.applied"},
    ForeignWord{"hfield", "field.applied"},
    ForeignWord{"sdealgh", "integrator.method"}};

constexpr std::array foreign_methods{ForeignWord{"rk45", "dp5"},
                                     ForeignWord{"rkf54", "dp5"},
                                     ForeignWord{"rk23", "bs3"},
                                     ForeignWord{"rk4", "rkmk4 or projected_rk4"},
                                     ForeignWord{"rk56", "tsit5"},
                                     ForeignWord{"depondt", "heun or rkmk4"},
                                     ForeignWord{"sib", "implicit_midpoint"},
                                     ForeignWord{"llg-heun", "projected_heun"},
                                     ForeignWord{"llg-midpoint", "implicit_midpoint"}};

constexpr std::array foreign_commands{
    ForeignWord{"minimize", "cayspin relax"}, ForeignWord{"minimise", "cayspin relax"},
    ForeignWord{"gneb", "cayspin path"},      ForeignWord{"neb", "cayspin path"},
    ForeignWord{"mep", "cayspin path"},       ForeignWord{"eigenmodes", "cayspin modes"},
    ForeignWord{"spectrum", "cayspin modes"}, ForeignWord{"version", "cayspin --version"}};

constexpr std::array names_of_simple_cubic{"sc", "cubic", "simple_cubic", "simple-cubic"};

/// A key of a scene's table. If several tables have a key of this name, hints suggest the first one
/// in the list.
struct OwnKey {
  std::string_view table, name;
};

template <class Section>
void add_keys_of(std::string_view table, std::vector<OwnKey>& all) {
  for (auto const& key : Section::keys()) all.push_back({table, key.name});
}

// Lists keys that hints may suggest. Keys whose meaning depends on the table, such as `axis`, are
// left out.
std::vector<OwnKey> own_keys() {
  std::vector<OwnKey> all;
  add_keys_of<Integrator>("integrator", all);
  auto const add = [&](std::string_view table, std::initializer_list<std::string_view> names) {
    for (auto const name : names) all.push_back({table, name});
  };
  add("lattice", {"shape", "spacing", "boundary", "crystal", "cell", "basis", "moments",
                  "gyromagnetic", "occupied", "frozen", "regions", "follow"});
  add("field", {"exchange", "exchange_between", "interlayer", "couplings", "anisotropy", "dmi",
                "in_time", "applied", "sources", "slab_demag", "demag", "dipoles", "mu0"});
  add("system", {"damping", "precession", "inertia"});
  add("material", {"Ms", "A", "Ku", "Ku2", "mu_s", "J", "K", "K2", "D", "D_bulk", "D2d",
                   "damping_form", "gamma", "free_boundary"});
  add("torque", {"zhang_li", "slonczewski"});
  add("initial", {"uniform", "expression", "random", "state"});
  add("ensemble", {"replicas", "vary"});
  add_keys_of<Thermal>("thermal", all);
  add_keys_of<Output>("output", all);
  return all;
}

std::string lower_case(std::string_view word) {
  std::string lower(word);
  std::ranges::transform(lower, lower.begin(), [](unsigned char c) { return std::tolower(c); });
  return lower;
}

// Returns what another program's word is called in a scene, or "".
std::string_view meaning_of(auto const& words, std::string_view lower) {
  auto const found = std::ranges::find(words, lower, &ForeignWord::of_others);
  return found == words.end() ? std::string_view() : found->here;
}

std::string here_it_is(std::string_view here) {
  return here.empty() ? std::string() : fmt::format(", here it is {}", here);
}

// Scenes in reduced units have no [material], so the hint says to which units its keys belong.
std::string did_you_mean_key(auto const& is_meant) {
  auto const all = own_keys();
  auto const found = std::ranges::find_if(all, is_meant);
  if (found == all.end()) return {};
  return fmt::format(", did you mean \"{}.{}\"{}?", found->table, found->name,
                     found->table == "material" ? " of units = \"SI\"" : "");
}

}  // namespace

std::string without_case(std::string_view word) {
  auto plain = lower_case(word);
  std::erase_if(plain, [](char c) { return c == '_' || c == '-'; });
  return plain;
}

std::string hint_for_other_table(std::string_view key) {
  return did_you_mean_key([&](OwnKey const& own) { return own.name == key; });
}

std::string hint_for_other_case(std::string_view key) {
  if (key.size() < 2) return {};  // a letter such as "a" is rarely meant as material.A
  return did_you_mean_key(
      [plain = without_case(key)](OwnKey const& own) { return without_case(own.name) == plain; });
}

std::string hint_for_word_of_others(std::string_view word) {
  // Vampire writes material[1]:exchange-matrix[2].
  if (auto const colon = word.find(':'); colon != word.npos) word.remove_prefix(colon + 1);
  auto const lower = lower_case(word.substr(0, word.find('[')));
  if (auto const here = meaning_of(foreign_words, lower); !here.empty()) return here_it_is(here);
  if (std::string method(meaning_of(foreign_methods, lower)); !method.empty()) {
    constexpr std::string_view either = " or ";
    if (auto const at = method.find(either); at != method.npos)
      method.replace(at, either.size(), "\" or \"");
    return here_it_is(fmt::format("integrator.method = \"{}\"", method));
  }
  return here_it_is(meaning_of(foreign_commands, lower));
}

std::string hint_for_value_of_others(std::string_view value) {
  auto const lower = lower_case(value);
  if (std::ranges::find(names_of_simple_cubic, lower) != names_of_simple_cubic.end())
    return ", leave the key out: a simple cubic lattice is the default";
  auto const method = meaning_of(foreign_methods, lower);
  return here_it_is(method.empty() ? meaning_of(foreign_commands, lower) : method);
}

}  // namespace cayspin::inline v0_2::io
