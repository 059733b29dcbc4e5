// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "sections.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace cayspin::inline v0_1::io::detail {
namespace {

ZhangLi read_zhang_li(Item const& item, Scene& scene) {
  Table const table(item, scene);
  table.accept_only({"velocity", "nonadiabaticity"});
  constexpr std::string_view accepted = "three numbers or expressions in t";
  ZhangLi read;
  std::ranges::transform(entries(table.required("velocity", accepted), 3, 3, accepted),
                         read.velocity.begin(), read_component_in_time);
  if (auto const xi = table.find("nonadiabaticity")) read.nonadiabaticity = number(*xi);
  return read;
}

Slonczewski read_slonczewski(Item const& item, Scene& scene) {
  Table const table(item, scene);
  table.accept_only({"damping_like", "field_like", "polarization"});
  Slonczewski read;
  auto const damping_like = table.find("damping_like"), field_like = table.find("field_like");
  if (!damping_like && !field_like) item.fail("has no strength", "damping_like, field_like");
  if (damping_like) read.damping_like = read_component_in_time(*damping_like);
  if (field_like) read.field_like = read_component_in_time(*field_like);
  read.polarization = direction(table.required("polarization", "three numbers"));
  return read;
}

}  // namespace

Torque read_torque(Table const& root, SystemKind kind) {
  Torque torque;
  auto const found = root.find("torque");
  if (!found) return torque;
  if (kind == SystemKind::rigid_body)
    found->fail("has no meaning for kind = \"rigid_body\"", "no such table");
  Table const table(*found, root.scene());
  table.accept_only({"zhang_li", "slonczewski"});
  auto const zhang_li = table.find("zhang_li"), slonczewski = table.find("slonczewski");
  if (!zhang_li && !slonczewski) found->fail("is empty", "zhang_li, slonczewski");
  if (zhang_li) torque.zhang_li = read_zhang_li(*zhang_li, root.scene());
  if (slonczewski) torque.slonczewski = read_slonczewski(*slonczewski, root.scene());
  return torque;
}

}  // namespace cayspin::inline v0_1::io::detail
