// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/execution.hpp>
#include <cayspin/part.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>

namespace cayspin::inline v0_2::detail {

template <class Field>
FieldNumbers field_numbers(Field const& field) {
  auto const& layout = field.layout();
  return {field.array().data, sizeof(typename Field::value_type),
          Field::components,  layout.pitch,
          layout.plane,       layout.component_stride,
          layout.nx,          layout.ny,
          layout.nz,          !is_host_execution<typename Field::memory_space::execution_space>};
}

/// Waits for the work on `exec`, updates the ghosts of the fields, and waits until this is done.
/// Does nothing on a whole lattice.
template <class Exec, class... Fields>
void update_ghosts(Exec const& exec, Lattice const& lattice, Fields const&... fields) {
  if (lattice.part == nullptr) [[likely]]
    return;
  exec.fence("cayspin::update_ghosts");
  std::array<FieldNumbers, sizeof...(Fields)> const numbers{field_numbers(fields)...};
  lattice.part->update_ghosts(numbers);
}

/// Throws std::invalid_argument for a part of a lattice.
CAYSPIN_DETAIL_NOINLINE inline void require_whole(char const* who, Lattice const& lattice) {
  if (lattice.part != nullptr)
    throw std::invalid_argument(std::string(who) + ": does not work on a part of a lattice");
}

/// Throws std::invalid_argument for a lattice of several replicas.
CAYSPIN_DETAIL_NOINLINE inline void require_one_replica(char const* who, Lattice const& lattice) {
  if (lattice.replicas > 1)
    throw std::invalid_argument(std::string(who) + ": does not work on replicas of a lattice");
}

/// Throws std::invalid_argument for a part of a lattice that has fewer ghosts than `needed` at an
/// inner end, or for any part if `needed` is 0.
CAYSPIN_DETAIL_NOINLINE inline void require_ghosts(std::string const& who, Lattice const& lattice,
                                                   int needed) {
  if (lattice.part != nullptr && needed == 0)
    throw std::invalid_argument(who + ": does not run on a part of a lattice");
  for (auto const& [before, after] : lattice.ghosts)
    for (std::int64_t const ghosts : {before, after})
      if (ghosts != 0 && ghosts < needed)
        throw std::invalid_argument(who + ": a step needs " + std::to_string(needed) +
                                    " ghosts at each inner end, and the part has " +
                                    std::to_string(ghosts));
}

}  // namespace cayspin::inline v0_2::detail
