// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

// How fast a step can be on one core, out of its second cache: each method written out for one
// lattice and one scene, with packs, rows that carry ghost sites, and nothing generic. The probes
// share no code with cayspin; the benchmarks hold their spins against its own after each run.
namespace probes {

struct Scene {
  int nx, ny, nz;  // open; nx is a multiple of a pack
  double exchange, anisotropy, applied, damping;
};

/// One method and its work memory.
template <class Real>
class Probe {
 public:
  virtual ~Probe() = default;
  virtual void step(Real dt) = 0;
  /// Spins as (sites, 3), x fastest.
  virtual void set(std::vector<double> const& spins) = 0;
  virtual std::vector<double> get() const = 0;
};

template <class Real>
using Made = std::unique_ptr<Probe<Real>>;

template <class Real>
Made<Real> euler(Scene const& scene);
template <class Real>
Made<Real> heun(Scene const& scene);
template <class Real>
Made<Real> rkmk4(Scene const& scene);
template <class Real>
Made<Real> chart_heun(Scene const& scene);
template <class Real>
Made<Real> chart_rk4(Scene const& scene);
template <class Real>
Made<Real> projected_rk4(Scene const& scene);

}  // namespace probes
