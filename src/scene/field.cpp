// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "free_boundary.hpp"
#include "io/expression.hpp"
#include "sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

namespace cayspin::inline v0_2::io::detail {
namespace {

template <class Term>
Term read_term(Item const& item, Scene& scene) {
  Table const table(item, scene);
  table.accept_only(names_of_keys<Term>());
  Term term;
  read_keys(table, term);
  return term;
}

// Reads the DMI of an interface, of the bulk of a chiral crystal, or of D2d symmetry. free_boundary
// is read later, after all tables.
void read_dmi(Item const& item, Scene& scene, Field& field) {
  constexpr std::string_view accepted =
      "{ interfacial = D, normal = [x, y, z] }, { bulk = D } or { d2d = D }, and free_boundary";
  if (!item.node->is_table()) item.wrong_type(accepted);
  Table const table(item, scene);
  auto const bulk = table.find("bulk"), d2d = table.find("d2d");
  table.accept_only({"interfacial", "normal", "bulk", "d2d", "free_boundary"});
  bool const is_of_interface = table.contains("interfacial") || table.contains("normal");
  if (bulk && is_of_interface) item.fail("has keys of an interface and of the bulk", accepted);
  if (d2d && (bulk || is_of_interface)) item.fail("is of D2d and of another symmetry", accepted);
  if (bulk) {
    field.bulk_dmi = {number_of_sites(*bulk, scene, field.dmi_factors)};
    return;
  }
  if (d2d) {
    field.d2d_dmi = {number_of_sites(*d2d, scene, field.dmi_factors)};
    return;
  }
  auto const interfacial = table.required("interfacial", Limits().accepted);
  double const constant = number_of_sites(interfacial, scene, field.dmi_factors);
  field.dmi = {constant,
               axis_of_sites(table.required("normal", "three numbers"), scene, field.dmi_normals)};
}

std::vector<std::string_view> field_keys() {
  std::vector<std::string_view> keys;
  for_each_lattice_term(Field{}, [&]<class Term>(std::optional<Term> const&) {
    if (keys.empty() || keys.back() != Term::key) keys.push_back(Term::key);
  });
  keys.insert(keys.end(), {"exchange_between", "interlayer", "couplings", "anisotropy", "in_time",
                           "applied", "sources", "slab_demag", "demag", "dipoles", "mu0"});
  return keys;
}

// Reads the key `between`: two regions.
std::array<std::int64_t, 2> read_between(Table const& table) {
  constexpr std::string_view accepted = "two regions";
  auto const item = table.required("between", accepted);
  if (!table.scene().lattice.regions.there())
    item.fail("stands without lattice.regions, which says the region of each site",
              "lattice.regions beside it");
  auto const each = entries(item, 2, 2, accepted);
  constexpr Limits limits{"a whole number >= 0", 0};
  return {integer(each[0], limits), integer(each[1], limits)};
}

template <class Between, class Read>
void read_bonds_between(Item const& item, Scene& scene, std::vector<std::string_view> const& keys,
                        std::vector<Between>& all, Read const& read) {
  constexpr std::string_view accepted = "a list of tables with the key between = [region, region]";
  for (auto const& entry : entries(item, 0, std::numeric_limits<std::size_t>::max(), accepted)) {
    if (!entry.node->is_table()) entry.wrong_type(accepted);
    Table const table(entry, scene);
    table.accept_only(keys);
    auto& one = all.emplace_back();
    one.regions = read_between(table);
    read(table, one);
    auto const is_pair = [&](Between const& other) {
      if constexpr (requires { one.range; })
        if (other.range != one.range) return false;
      return std::ranges::is_permutation(other.regions, one.regions);
    };
    if (std::ranges::count_if(all, is_pair) > 1)
      entry.fail("repeats a pair of regions", "each pair once");
  }
}

void read_exchange_between(Item const& item, Scene& scene, Field& field) {
  read_bonds_between(item, scene, {"between", "factor"}, field.exchange_between,
                     [](Table const& table, ExchangeBetween& one) {
                       one.factor = number(table.required("factor", "a finite number"));
                     });
}

void read_interlayers(Item const& item, Scene& scene, Field& field) {
  constexpr Limits range{"a number of cells without a spin, 0 to 1000", 0, 1000};
  read_bonds_between(item, scene, {"between", "J", "biquadratic", "range"}, field.interlayers,
                     [&](Table const& table, Interlayer& one) {
                       if (auto const J = table.find("J")) one.bilinear = number(*J);
                       if (auto const B = table.find("biquadratic")) one.biquadratic = number(*B);
                       if (auto const n = table.find("range")) one.range = integer(*n, range);
                       if (!table.contains("J") && !table.contains("biquadratic"))
                         table.item().fail("has no constant", "J, biquadratic");
                     });
}

// Reads three components, or a list of fields of three numbers each.
void read_applied(Item const& item, Field& field) {
  auto const* const array = item.node->as_array();
  if (array != nullptr && !array->empty() && array->front().is_array()) {
    constexpr auto any = std::numeric_limits<std::size_t>::max();
    for (auto const& entry : entries(item, 1, any, "three numbers, or a list of such fields"))
      field.applied_in_turn.push_back(triple(entry));
    return;
  }
  field.applied = three(item, "three numbers or expressions in t", component_in_time);
}

void read_sources(Item const& item, Scene& scene, Field& field) {
  constexpr std::string_view accepted =
      "a list of tables { profile = a vector of sites, time = an expression in t }";
  for (auto const& entry : entries(item, 0, std::numeric_limits<std::size_t>::max(), accepted)) {
    if (!entry.node->is_table()) entry.wrong_type(accepted);
    Table const table(entry, scene);
    table.accept_only({"profile", "time"});
    auto& source = field.sources.emplace_back();
    source.profile =
        read_site_vectors(table.required("profile", accepted_site_vectors(scene.lattice)), scene);
    if (auto const time = table.find("time")) source.time = component_in_time(*time);
  }
}

bool is_on_host(Table const& table) {
  constexpr std::string_view accepted = "\"host\", or no such key";
  auto const item = table.find("where");
  if (!item) return false;
  auto const typed = string(*item, accepted);
  if (typed != "host") item->fail(fmt::format("\"{}\" is not known", typed), accepted);
  return true;
}

SlabDemagnetization read_slab_demag(Item const& item, Scene& scene) {
  auto slab = read_term<SlabDemagnetization>(item, scene);
  Table const table(item, scene);
  slab.on_host = is_on_host(table);
  if (slab.multirate && !slab.on_host)
    table.find("multirate")
        ->fail("a slab's field is cheap, because it depends only on the site's own spin",
               "where = \"host\" beside it, or no such key");
  return slab;
}

// With units = "SI", [material] has the exchange and the DMI, and there is no mu0.
void refuse_reduced_keys(Table const& table) {
  constexpr std::pair<std::string_view, std::string_view> replaced[] = {
      {"exchange", "material.A, or material.J of atomistic spins"},
      {"dmi", "material.D with material.normal, material.D_bulk or material.D2d"},
      {"mu0", "no such key: applied is in T"}};
  for (auto const& [key, accepted] : replaced)
    if (auto const item = table.find(key)) item->fail("belongs to reduced units", accepted);
}

}  // namespace

void use_numbers_of_sites(Scene& scene) {
  auto& field = scene.field;
  auto const as_numbers = [](SiteNumbers numbers, double& constant) {
    if (!numbers.there()) numbers.expression = "1", numbers.unit = std::exchange(constant, 1);
    return numbers;
  };
  if (field.d2d_dmi) field.dmi_factors = as_numbers(field.dmi_factors, field.d2d_dmi->constant);
  if (field.dmi_normals.there())
    field.dmi_factors = as_numbers(field.dmi_factors, field.dmi->interfacial);
  bool const is_of_atoms = scene.material && scene.material->atomistic;
  if (!field.interlayers.empty() && field.exchange && !is_of_atoms) {
    double constant = field.exchange->constant;
    field.exchange_at_faces = as_numbers(field.exchange_factors, constant);
  }
  if (field.exchange_between.empty()) return;
  if (!field.exchange)
    refuse(scene, "field.exchange_between", "stands without exchange",
           scene.units.si ? "material.A beside it, or no such key"
                          : "field.exchange beside it, or no such key");
  field.exchange_factors = as_numbers(field.exchange_factors, field.exchange->constant);
}

void check_in_time(Table const& root) {
  auto const& scene = root.scene();
  auto const& field = scene.field;
  auto const& [exchange, anisotropy, dmi] = field.in_time;
  AppliedComponent const none = 1.0;
  auto const refuse_if = [&](bool wrong, std::string_view key, std::string_view what,
                             std::string_view accepted) {
    if (wrong) refuse(scene, fmt::format("field.in_time.{}", key), what, accepted);
  };
  constexpr std::string_view such = "such a term beside it, or no such key";
  refuse_if(exchange != none && !field.exchange, "exchange", "stands without exchange", such);
  refuse_if(dmi != none && !field.has_dmi(), "dmi", "stands without DMI", such);
  refuse_if(anisotropy != none && field.anisotropies.empty() && field.crystal_anisotropies.empty(),
            "anisotropy", "stands without anisotropy", such);
  refuse_if(exchange != none && field.exchange_at_faces.there(), "exchange",
            "does not go with interlayer, whose spins at faces are tied by a constant exchange",
            "no interlayer, or no such key");
  if (field.in_time.there() && has_free_boundary(root))
    refuse(scene, "field.in_time",
           "does not go with free_boundary, whose anisotropy is of constant DMI and exchange",
           "free_boundary = false, or no such table");
}

Field read_field(Table const& root, SystemKind kind) {
  Field field;
  auto const found = table_of_spins(root, "field", kind);
  if (!found) return field;
  auto const& table = *found;
  auto& scene = root.scene();
  table.accept_only(field_keys());
  if (scene.units.si) refuse_reduced_keys(table);
  if (auto const item = table.find("exchange"))
    field.exchange = {number_of_sites(*item, scene, field.exchange_factors)};
  if (auto const item = table.find("dmi")) read_dmi(*item, scene, field);
  if (auto const item = table.find("exchange_between")) read_exchange_between(*item, scene, field);
  if (auto const item = table.find("interlayer")) read_interlayers(*item, scene, field);
  if (auto const item = table.find("couplings")) read_couplings(*item, scene, field);
  if (auto const item = table.find("anisotropy")) read_anisotropies(*item, scene, field);
  if (auto const item = table.find("in_time")) field.in_time = read_term<InTime>(*item, scene);
  if (auto const item = table.find("applied")) read_applied(*item, field);
  if (auto const item = table.find("sources")) read_sources(*item, scene, field);
  if (auto const item = table.find("slab_demag")) field.slab_demag = read_slab_demag(*item, scene);
  read_demag(table, scene, field);
  if (auto const item = table.find("mu0")) field.mu0 = number(*item);
  return field;
}

}  // namespace cayspin::inline v0_2::io::detail

namespace cayspin::inline v0_2::io {

std::string_view key_in_time(Field const& field) {
  if (field.own.uniform) return "field.applied";
  auto const depends = [](AppliedComponent const& component) {
    auto const* const text = std::get_if<std::string>(&component);
    return text != nullptr && Expression(*text, {"t"}).depends_on("t");
  };
  auto const& [zhang_li, slonczewski] = field.torque;
  if (field.applied && std::ranges::any_of(*field.applied, depends)) return "field.applied";
  if (std::ranges::any_of(field.sources, depends, &Source::time)) return "field.sources";
  if (std::ranges::any_of(field.in_time.components(), depends)) return "field.in_time";
  if (zhang_li && std::ranges::any_of(zhang_li->velocity, depends)) return "torque.zhang_li";
  if (slonczewski && (depends(slonczewski->damping_like) || depends(slonczewski->field_like)))
    return "torque.slonczewski";
  return {};
}

Field without_numbers_of_sites(Field field) {
  field.interlayers.clear();
  if (field.exchange_factors.there()) field.exchange.reset();
  if (field.dmi_factors.there()) {
    field.dmi.reset();
    field.bulk_dmi.reset();
    field.d2d_dmi.reset();
  }
  std::erase_if(field.anisotropies, std::not_fn(&Anisotropy::is_plain));
  return field;
}

bool has_torque(Field const& field) { return field.torque.zhang_li || field.torque.slonczewski; }

bool is_nonlocal(Field const& field) {
  return field.own.nonlocal || field.demag || (field.slab_demag && field.slab_demag->on_host);
}

}  // namespace cayspin::inline v0_2::io
