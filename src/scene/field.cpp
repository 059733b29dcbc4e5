// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "sections.hpp"

#include <cayspin/io/expression.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace cayspin::inline v0_1::io::detail {
namespace {

// A table with every parameter of the term.
template <class Term>
Term read_term(Item const& item, Scene& scene) {
  Table const table(item, scene);
  std::vector<std::string_view> keys;
  for (auto const& parameter : Term::parameters) keys.push_back(parameter.name);
  table.accept_only(keys);
  Term term;
  for (auto const& [name, member] : Term::parameters) {
    if (auto const* const value = std::get_if<double Term::*>(&member))
      term.** value = number(table.required(name, "a finite number"));
    else
      term.*std::get<Triple Term::*>(member) = direction(table.required(name, "three numbers"));
  }
  return term;
}

// Such a table, or the number itself where the term has no other parameter.
template <class Term>
Term read_lattice_term(Item const& item, Scene& scene) {
  if constexpr (Term::parameters.size() == 1) {
    Term term;
    term.*std::get<double Term::*>(Term::parameters[0].member) = number(item);
    return term;
  } else {
    return read_term<Term>(item, scene);
  }
}

void read_lattice_terms(Table const& table, Field& field) {
  for_each_lattice_term(field, [&]<class Term>(std::optional<Term>& term) {
    if (auto const item = table.find(Term::key))
      term = read_lattice_term<Term>(*item, table.scene());
  });
}

std::vector<std::string_view> field_keys() {
  std::vector<std::string_view> keys;
  for_each_lattice_term(Field{},
                        [&]<class Term>(std::optional<Term> const&) { keys.push_back(Term::key); });
  keys.insert(keys.end(), {"anisotropy", "applied", "slab_demag", "mu0"});
  return keys;
}

std::vector<Anisotropy> read_anisotropies(Item const& item, Scene& scene) {
  constexpr std::string_view accepted =
      "{ constant = K, axis = [x, y, z] }, or an array of such tables";
  if (item.node->is_table()) return {read_term<Anisotropy>(item, scene)};
  std::vector<Anisotropy> all;
  for (auto const& entry : entries(item, 1, std::numeric_limits<std::size_t>::max(), accepted)) {
    all.push_back(read_term<Anisotropy>(entry, scene));
  }
  return all;
}

AppliedComponent read_applied_component(Item const& item) {
  constexpr std::string_view accepted = "a finite number, or a string with an expression in t";
  if (!item.node->is_string()) return number(item, accepted);
  auto text = string(item, accepted);
  try {
    double const start = 0;
    Expression(text, {"t"})(&start);
  } catch (std::exception const& error) {
    item.fail(error.what());
  }
  return text;
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
  auto const three = entries(item, 3, 3, "three numbers or expressions in t");
  field.applied.emplace();
  std::ranges::transform(three, field.applied->begin(), read_applied_component);
}

// Whether the scene's one word stands there.
bool option(Table const& table, std::string_view name, std::string_view only) {
  auto const item = table.find(name);
  if (!item) return false;
  auto const accepted = fmt::format("\"{}\", or no such key", only);
  auto const typed = string(*item, accepted);
  if (typed != only) item->fail(fmt::format("\"{}\" is not known", typed), accepted);
  return true;
}

SlabDemagnetization read_slab_demag(Item const& item, Scene& scene) {
  Table const table(item, scene);
  table.accept_only({"normal", "strength", "average", "where", "dear"});
  SlabDemagnetization slab;
  auto const normal = table.required("normal", "three numbers");
  slab.normal = direction(normal);
  if (auto const strength = table.find("strength")) slab.strength = number(*strength);
  slab.average_layer = option(table, "average", "layer");
  slab.on_host = option(table, "where", "host");
  if (auto const dear = table.find("dear")) {
    slab.dear = boolean(*dear);
    if (slab.dear && !slab.average_layer && !slab.on_host)
      dear->fail("site by site the field is of each spin alone, and cheap",
                 "average = \"layer\" or where = \"host\" beside it, or no such key");
  }
  if (slab.average_layer && std::ranges::count(slab.normal, 0.0) != 2) {
    normal.fail("average = \"layer\" needs a normal along an axis",
                "[1, 0, 0], [0, 1, 0] or [0, 0, 1]");
  }
  return slab;
}

// A material says in SI what these say in reduced units.
void refuse_reduced_keys(Table const& table) {
  constexpr std::pair<std::string_view, std::string_view> replaced[] = {
      {"exchange", "material.A, or material.J of atomistic spins"},
      {"dmi", "material.D with material.normal"},
      {"anisotropy", "material.Ku, or material.K of atomistic spins, with material.axis"},
      {"mu0", "no such key: applied is in T"}};
  for (auto const& [key, accepted] : replaced)
    if (auto const item = table.find(key)) item->fail("belongs to reduced units", accepted);
}

}  // namespace

Field read_field(Table const& root, SystemKind kind) {
  Field field;
  auto const found = root.find("field");
  if (!found) return field;
  if (kind == SystemKind::rigid_body) {
    found->fail("has no meaning for kind = \"rigid_body\"", "no such table");
  }
  Table const table(*found, root.scene());
  table.accept_only(field_keys());
  if (root.scene().units.si) refuse_reduced_keys(table);
  read_lattice_terms(table, field);
  if (auto const item = table.find("anisotropy")) {
    field.anisotropies = read_anisotropies(*item, root.scene());
  }
  if (auto const item = table.find("applied")) read_applied(*item, field);
  if (auto const item = table.find("slab_demag")) {
    field.slab_demag = read_slab_demag(*item, root.scene());
  }
  if (auto const item = table.find("mu0")) field.mu0 = number(*item);
  return field;
}

}  // namespace cayspin::inline v0_1::io::detail

namespace cayspin::inline v0_1::io {

bool depends_on_time(Field const& field) {
  if (field.own.uniform) return true;
  if (!field.applied) return false;
  for (auto const& component : *field.applied) {
    auto const* const text = std::get_if<std::string>(&component);
    if (text != nullptr && Expression(*text, {"t"}).depends_on("t")) return true;
  }
  return false;
}

bool is_nonlocal(Field const& field) {
  auto const& slab = field.slab_demag;
  return field.own.nonlocal || (slab && (slab->average_layer || slab->on_host));
}

}  // namespace cayspin::inline v0_1::io
