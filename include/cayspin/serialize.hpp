// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/checkpoint.hpp>
#include <cayspin/spin_field.hpp>

#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace cayspin::inline v0_2 {

namespace detail {

/// Visitor that stores members in a checkpoint one by one, or restores them.
class ExchangeMemory {
 public:
  explicit ExchangeMemory(Checkpoint& with, std::string prefix = {})
      : with_(with), prefix_(std::move(prefix)) {}

  template <class Number>
    requires std::integral<Number> || std::floating_point<Number>
  void operator()(std::string const& name, Number& number) const {
    double value = static_cast<double>(number);
    with_.number(prefix_ + name, value);
    if constexpr (std::integral<Number>) require_held<Number>(name, value);
    number = static_cast<Number>(value);
  }
  /// Stores or restores the number of fields that follow. Throws if it is above `most`: in a
  /// damaged checkpoint it could be more than memory can hold.
  template <class Number>
  void count(std::string const& name, Number& number, std::size_t most) const {
    (*this)(name, number);
    if (static_cast<std::size_t>(number) > most) refuse(name);
  }

  template <class Real, int Components, class MemorySpace>
  void operator()(std::string const& name,
                  SiteField<Real, Components, MemorySpace> const& field) const {
    std::vector<double> numbers;
    if (!with_.restores()) {
      auto held = copy_to_host(field);
      if constexpr (std::is_same_v<Real, double>)
        numbers = std::move(held);
      else
        numbers.assign(held.begin(), held.end());
    }
    with_.field(prefix_ + name, numbers);
    if (!with_.restores()) return;
    // copy_from_host would accept the numbers of a single replica and copy them to all.
    if (static_cast<std::int64_t>(numbers.size()) != field.sites() * Components) refuse(name);
    copy_from_host(numbers, field);
  }

 private:
  template <class Number>
  void require_held(std::string const& name, double value) const {
    constexpr double end = static_cast<double>(std::numeric_limits<Number>::max()) + 1;
    bool const is_held = static_cast<double>(std::numeric_limits<Number>::min()) <= value &&
                         value < end && value == std::floor(value);
    if (!is_held) refuse(name);
  }
  [[noreturn]] void refuse(std::string const& name) const {
    throw std::invalid_argument("cayspin::serialize: the checkpoint's " + prefix_ + name +
                                " is not one that the stepper can have");
  }

  Checkpoint& with_;
  std::string prefix_;
};

}  // namespace detail

/// True if a stepper carries something in addition to the spins from one step to the next, as
/// multistep, adaptive and compensated ones do.
template <class Stepper>
inline constexpr bool remembers_steps = requires(Stepper& stepper) { stepper.reset(); };

/// Stores the state of `stepper` (or of an EnergyControl) in a checkpoint, or restores it from one.
/// After a restore, integrate() with times.continues goes on exactly as the stored stepper would
/// have. Names in the checkpoint start with `prefix`. Work on the stepper's fields must have
/// finished; waits. Throws what the checkpoint throws, and std::invalid_argument for fields of
/// another size and counts that the stepper cannot have.
template <class Stepper>
void serialize(Stepper& stepper, Checkpoint& checkpoint, std::string const& prefix = {}) {
  detail::ExchangeMemory const visit(checkpoint, prefix);
  if constexpr (requires { stepper.visit_memory(visit); }) {
    stepper.visit_memory(visit);
  } else {
    static_assert(!remembers_steps<Stepper>,
                  "A stepper with a member reset() remembers steps: it needs visit_memory(visit), "
                  "which calls visit(name, member) for what they are remembered by.");
  }
}

}  // namespace cayspin::inline v0_2
