// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cstddef>
#include <vector>

// Probes show how fast a step can be on one core with the data in its second-level cache: each
// method is written out for one kind of scene, with packs, rows with ghost sites, and nothing
// generic. Probes share no code with cayspin. Before the benchmark times a probe, it checks that
// the probe takes the same steps as cayspin.
namespace probes {

struct Scene {
  int nx, ny, nz;  // sites, with open ends; nx is a multiple of the pack width
  double exchange, anisotropy, applied, damping;
};

/// The spins of a scene, work memory, and steps by each method.
template <class Real>
class Probe {
 public:
  explicit Probe(Scene const& scene);

  void euler(Real dt);
  void heun(Real dt);
  void rkmk4(Real dt);
  void chart_heun(Real dt);
  void chart_rk4(Real dt);
  void projected_rk4(Real dt);

  /// Set or return the spins as an array (sites, 3); among the sites, x varies fastest.
  void set(std::vector<double> const& spins);
  std::vector<double> get() const;

 private:
  static constexpr int margin = 64 / static_cast<int>(sizeof(Real));

  auto read(int field, std::ptrdiff_t at) const;
  template <class Vector>
  void write(Vector const& v, int field, std::ptrdiff_t at);
  template <bool Whole, class Body>
  void for_each_pack(int level, int out, Body const& body);
  template <class Work>
  void for_each_site(Work const& work) const;

  Scene scene_;
  std::ptrdiff_t pitch_, stride_;
  std::vector<Real> fields_[7];  // fields_[0] holds the spins
};

}  // namespace probes
