// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/integrate.hpp>
#include <cayspin/observer/scalars.hpp>

#include <utility>
#include <vector>

namespace cayspin {

/// Energy, norm defect and magnetization at one step.
struct Sample {
  std::int64_t step = 0;
  double time = 0;
  Energy energy;
  double norm_defect = 0;
  Vec3<double> magnetization{0, 0, 0};
};

template <class Exec, class Source, class Spins>
Sample sample(Exec const& exec, Source const& source, Step const& step, Spins const& spins) {
  return {step.number, step.time, energy(exec, source, spins, step.time), norm_defect(exec, spins),
          magnetization(exec, spins)};
}

/// An observer that keeps a Sample for each call; wrap it in Every to thin it out.
/// `source`: what the energy is taken from (an EffectiveField or a generator).
template <class Source>
class Record {
 public:
  Record(Source source, std::vector<Sample>& samples)
      : source_(std::move(source)), samples_(samples) {}

  template <class Exec, class Spins>
  void operator()(Exec const& exec, Step const& step, Spins const& spins) {
    samples_.push_back(sample(exec, source_, step, spins));
  }

 private:
  Source source_;
  std::vector<Sample>& samples_;
};

}  // namespace cayspin
