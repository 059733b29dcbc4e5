// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "io/expression.hpp"
#include "quantity.hpp"
#include "sections.hpp"

#include <cayspin/demagnetization/images.hpp>
#include <cayspin/demagnetization/tensor.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

namespace cayspin::inline v0_1::io::detail {
namespace {

template <class Term>
Term read_term(Item const& item, Scene& scene) {
  Table const table(item, scene);
  table.accept_only(names_of_keys<Term>());
  Term term;
  read_keys(table, term);
  return term;
}

// Such a table, or the number itself where the term has no other key.
template <class Term>
Term read_lattice_term(Item const& item, Scene& scene) {
  if constexpr (Term::keys().size() == 1) {
    Term term;
    term.*std::get<double Term::*>(Term::keys()[0].member) = number(item);
    return term;
  } else {
    return read_term<Term>(item, scene);
  }
}

// Of an interface, or of the bulk of a chiral crystal. free_boundary is read after all sections.
void read_dmi(Item const& item, Scene& scene, Field& field) {
  constexpr std::string_view accepted =
      "{ interfacial = D, normal = [x, y, z] } or { bulk = D }, and free_boundary";
  if (!item.node->is_table()) item.wrong_type(accepted);
  Table const table(item, scene);
  auto const bulk = table.find("bulk");
  table.accept_only({"interfacial", "normal", "bulk", "free_boundary"});
  if (bulk && (table.contains("interfacial") || table.contains("normal")))
    item.fail("is of an interface and of the bulk", accepted);
  if (bulk) {
    field.bulk_dmi = {number_of_sites(*bulk, scene, field.dmi_factors)};
    return;
  }
  auto const interfacial = table.required("interfacial", Limits().accepted);
  double const constant = number_of_sites(interfacial, scene, field.dmi_factors);
  field.dmi = {constant, direction(table.required("normal", "three numbers"))};
}

void read_lattice_terms(Table const& table, Field& field) {
  for_each_lattice_term(field, [&]<class Term>(std::optional<Term>& term) {
    auto const item = table.find(Term::key);
    if (!item) return;
    if (std::is_same_v<Term, InterfacialDmi>) return read_dmi(*item, table.scene(), field);
    if (std::is_same_v<Term, BulkDmi>) return;  // read beside it
    if (std::is_same_v<Term, Exchange> &&
        read_site_numbers(*item, table.scene(), field.exchange_factors)) {
      field.exchange = {1};
      return;
    }
    term = read_lattice_term<Term>(*item, table.scene());
  });
}

std::vector<std::string_view> field_keys() {
  std::vector<std::string_view> keys;
  for_each_lattice_term(Field{}, [&]<class Term>(std::optional<Term> const&) {
    if (keys.empty() || keys.back() != Term::key) keys.push_back(Term::key);
  });
  keys.insert(keys.end(), {"couplings", "anisotropy", "applied", "slab_demag", "demag", "mu0"});
  return keys;
}

// All sites of the cell, or one.
int read_site(Table const& table) {
  auto const item = table.find("site");
  if (!item) return -1;
  auto const sites = table.scene().lattice.basis.size();
  auto const accepted = fmt::format("a site of the cell, 0 to {}", sites - 1);
  auto const site = integer(*item, {accepted, 0});
  if (site >= static_cast<std::int64_t>(sites))
    item->fail(fmt::format("the cell has no site {}", site), accepted);
  return static_cast<int>(site);
}

CubicAnisotropy read_cubic(Table const& table) {
  constexpr std::string_view accepted = "two vectors at right angles, to 1e-4";
  constexpr double most_skew = 1e-4;  // of cayspin::CubicAnisotropy
  CubicAnisotropy term;
  for (auto const* const other : {"constant", "axis"})
    if (auto const item = table.find(other)) item->fail("belongs to a uniaxial one", "no such key");
  auto const [value, unit] =
      in_joules_of_atoms(table.required("cubic", "a finite number"), table.scene());
  term.constant = number(value) * unit;
  auto const axes = table.required("axes", accepted);
  std::ranges::transform(entries(axes, 2, 2, accepted), term.axes.begin(), direction);
  auto const& [a, b] = term.axes;
  double const skew = std::abs(a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
  if (!(skew <= most_skew))
    axes.fail(fmt::format("the axes are not at right angles, by {:.3g}", skew), accepted);
  term.site = read_site(table);
  return term;
}

void read_anisotropy(Item const& item, Scene& scene, Field& field) {
  Table const table(item, scene);
  table.accept_only({"constant", "axis", "cubic", "axes", "site"});
  if (table.contains("cubic")) {
    field.cubic_anisotropies.push_back(read_cubic(table));
    return;
  }
  if (auto const axes = table.find("axes")) axes->fail("belongs to a cubic one", "no such key");
  Anisotropy term;
  term.constant =
      constant_of_sites(table.required("constant", "a finite number"), scene, term.factors);
  term.axis = direction(table.required("axis", "three numbers"));
  term.site = read_site(table);
  field.anisotropies.push_back(std::move(term));
}

void read_anisotropies(Item const& item, Scene& scene, Field& field) {
  constexpr std::string_view accepted =
      "{ constant = K, axis = [x, y, z] }, { cubic = Kc, axes = [[..], [..]] }, or an array of "
      "such tables";
  if (item.node->is_table()) return read_anisotropy(item, scene, field);
  for (auto const& entry : entries(item, 1, std::numeric_limits<std::size_t>::max(), accepted))
    read_anisotropy(entry, scene, field);
}

// Three components, or a list of fields of three numbers each.
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
  if (slab.dear && !slab.on_host)
    table.find("dear")->fail("the field of a slab is of each spin alone, and cheap",
                             "where = \"host\" beside it, or no such key");
  return slab;
}

// Along periodic axes of more than one cell the lattice goes on for ever.
std::array<int, 3> usual_images(Item const& item, Lattice const& lattice) {
  std::array<int, 3> images{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (lattice.boundary[axis] == BoundaryKind::periodic && lattice.shape[axis] > 1)
      images[axis] = infinitely_many_images;
  if (std::ranges::count(images, 0) == 0)
    item.fail(
        "the field of a lattice that is periodic along x, y and z depends on the shape of "
        "the whole",
        "demag = { periodic_images = [nx, ny, nz] }, or an open axis");
  double shortest = std::numeric_limits<double>::infinity(), longest = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (images[axis] == 0) continue;
    double const length = static_cast<double>(lattice.shape[axis]) * lattice.spacing[axis];
    shortest = std::min(shortest, length);
    longest = std::max(longest, length);
  }
  if (longest > largest_period_ratio * shortest)
    item.fail(
        fmt::format("the lengths of the periodic axes differ by {:.3g} : 1", longest / shortest),
        "up to 1e4 : 1, or demag = { periodic_images = [nx, ny, nz] }");
  return images;
}

// `demag = true`, or a table.
std::optional<Demagnetization> read_demag(Item const& item, Scene& scene) {
  auto const [shortest, longest] = std::ranges::minmax(scene.lattice.spacing);
  auto const check_cell = [&, shortest = shortest, longest = longest] {
    if (longest > largest_edge_ratio * shortest)
      item.fail(fmt::format("the edges of a cell differ by {:.3g} : 1", longest / shortest),
                "edges of up to 1e9 : 1");
  };
  if (item.node->is_boolean()) {
    if (!boolean(item)) return std::nullopt;
    check_cell();
    Demagnetization demag;
    demag.periodic_images = usual_images(item, scene.lattice);
    return demag;
  }
  constexpr std::string_view accepted = "true, or { strength, periodic_images, dear }";
  if (!item.node->is_table()) item.wrong_type(accepted);
  check_cell();
  auto demag = read_term<Demagnetization>(item, scene);
  if (auto const images = Table(item, scene).find("periodic_images")) {
    constexpr std::string_view of_images = "three numbers of images, 0 to 1000";
    demag.periodic_images = three(*images, of_images, [&](Item const& each) {
      auto const count = integer(each, {of_images, 0});
      if (count > 1000) each.fail(fmt::format("{} images are too many", count), of_images);
      return static_cast<int>(count);
    });
  } else {
    demag.periodic_images = usual_images(item, scene.lattice);
  }
  return demag;
}

// A material says in SI what these say in reduced units.
void refuse_reduced_keys(Table const& table) {
  constexpr std::pair<std::string_view, std::string_view> replaced[] = {
      {"exchange", "material.A, or material.J of atomistic spins"},
      {"dmi", "material.D with material.normal, or material.D_bulk"},
      {"mu0", "no such key: applied is in T"}};
  for (auto const& [key, accepted] : replaced)
    if (auto const item = table.find(key)) item->fail("belongs to reduced units", accepted);
}

}  // namespace

Field read_field(Table const& root, SystemKind kind) {
  Field field;
  auto const found = table_of_spins(root, "field", kind);
  if (!found) return field;
  auto const& table = *found;
  auto& scene = root.scene();
  table.accept_only(field_keys());
  if (scene.units.si) refuse_reduced_keys(table);
  read_lattice_terms(table, field);
  if (auto const item = table.find("couplings")) read_couplings(*item, scene, field);
  if (auto const item = table.find("anisotropy")) read_anisotropies(*item, scene, field);
  if (auto const item = table.find("applied")) read_applied(*item, field);
  if (auto const item = table.find("slab_demag")) field.slab_demag = read_slab_demag(*item, scene);
  if (auto const item = table.find("demag")) {
    field.demag = read_demag(*item, scene);
    if (field.demag && field.slab_demag)
      item->fail("is the whole demagnetising field, and slab_demag a part of it", "one of the two");
  }
  if (auto const item = table.find("mu0")) field.mu0 = number(*item);
  return field;
}

}  // namespace cayspin::inline v0_1::io::detail

namespace cayspin::inline v0_1::io {

bool depends_on_time(Field const& field) {
  if (field.own.uniform) return true;
  auto const depends = [](AppliedComponent const& component) {
    auto const* const text = std::get_if<std::string>(&component);
    return text != nullptr && Expression(*text, {"t"}).depends_on("t");
  };
  auto const& [zhang_li, slonczewski] = field.torque;
  return (field.applied && std::ranges::any_of(*field.applied, depends)) ||
         (zhang_li && std::ranges::any_of(zhang_li->velocity, depends)) ||
         (slonczewski && (depends(slonczewski->damping_like) || depends(slonczewski->field_like)));
}

Field without_numbers_of_sites(Field field) {
  if (field.exchange_factors.there()) field.exchange.reset();
  if (field.dmi_factors.there()) {
    field.dmi.reset();
    field.bulk_dmi.reset();
  }
  std::erase_if(field.anisotropies, [](Anisotropy const& term) { return term.factors.there(); });
  return field;
}

bool has_torque(Field const& field) { return field.torque.zhang_li || field.torque.slonczewski; }

bool is_nonlocal(Field const& field) {
  return field.own.nonlocal || field.demag || (field.slab_demag && field.slab_demag->on_host);
}

}  // namespace cayspin::inline v0_1::io
