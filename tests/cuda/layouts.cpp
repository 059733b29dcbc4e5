// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Structs that kernels take; the test `cuda_layouts` compares their sizes on host and device.
// Nothing is run.
#include <cayspin/cayspin.hpp>

#include <cstddef>

namespace cayspin::test {

template <class Argument>
__global__ void takes(Argument) {}

/// A function whose symbol contains the size of an argument on the host.
template <class Argument, std::size_t OnHost>
void has_size() {}

template <class... Arguments>
void compare() {
  [[maybe_unused]] void const* volatile kernels[] = {
      reinterpret_cast<void const*>(&takes<Arguments>)...};
  [[maybe_unused]] void (*volatile sizes[])() = {&has_size<Arguments, sizeof(Arguments)>...};
}

template <class Member>
struct Before {
  Member member;
  double* next;
};

template <class Tableau, class Real, std::size_t... Stages>
void compare_stages(std::index_sequence<Stages...>) {
  using Update = update::Lie<Cayley>;
  compare<
      Before<detail::DeviceArrays<detail::StageDataFlow<Tableau, Update, int(Stages)>, Real>>...>();
}

template <class Real>
void compare_all() {
  using Field = EffectiveField<Exchange, UniaxialAnisotropy, Zeeman>;
  compare<Before<EffectiveField<>>, Before<EffectiveField<Zeeman>>,
          Before<EffectiveField<UniaxialAnisotropy, Zeeman>>, Before<LandauLifshitz<Field>>,
          Before<Kokkos::View<Real*>>, Before<Kokkos::View<Real* [3], Kokkos::LayoutLeft>>>();
  compare_stages<tableau::Heun, Real>(std::make_index_sequence<2>());
  compare_stages<tableau::Classical4, Real>(std::make_index_sequence<4>());
  compare_stages<tableau::DormandPrince5, Real>(std::make_index_sequence<6>());
}

template void compare_all<float>();
template void compare_all<double>();

}  // namespace cayspin::test
