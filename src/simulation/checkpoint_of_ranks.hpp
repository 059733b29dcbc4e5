// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/checkpoint.hpp"
#include "ranks.hpp"

#include <algorithm>
#include <exception>
#include <memory>
#include <string>
#include <vector>

namespace cayspin::simulation {

/// Checkpoint collected from the parts of all ranks, and written by the first rank.
class CheckpointFromRanks final : public Checkpoint {
 public:
  /// `writer`: null on all ranks but the first.
  CheckpointFromRanks(Ranks& ranks, cayspin::Lattice const& local, io::CheckpointWriter* writer)
      : ranks_(ranks), local_(local), writer_(writer) {}

  bool restores() const override { return false; }
  void number(std::string const& name, double& value) override {
    on_first([&] { writer_->number(name, value); });
  }
  void field(std::string const& name, std::vector<double>& numbers) override {
    if (!ranks_.many()) return writer_->field(name, numbers);
    auto const of_site = static_cast<std::int64_t>(numbers.size()) / local_.sites();
    auto const& [nx, ny, nz] = whole(local_).shape;
    auto const at_once = ranks_.planes_at_once(local_);
    std::vector<double> planes;
    for (std::int64_t first = 0; first < nz; first += at_once) {
      auto const count = std::min(at_once, nz - first);
      if (writer_) planes.resize(static_cast<std::size_t>(of_site * nx * ny * count));
      ranks_.gather(local_, sizeof(double) * static_cast<std::size_t>(of_site), first, count,
                    numbers.data(), planes.data());
      on_first([&] { writer_->planes(name, of_site, planes); });
    }
  }
  /// If the first rank has failed, throws its error there, and OtherRankFailed on the other ranks.
  void commit() {
    on_first([&] { writer_->commit(); });
    ranks_.together([&] {
      if (error_) std::rethrow_exception(error_);
    });
  }

 private:
  // Keeps an error until commit(), because the first rank has to take part in the later calls even
  // if it cannot write: the other ranks wait for it in these.
  template <class Work>
  void on_first(Work const& work) {
    if (!writer_ || error_) return;
    try {
      work();
    } catch (...) {
      error_ = std::current_exception();
    }
  }

  Ranks& ranks_;
  cayspin::Lattice const& local_;
  io::CheckpointWriter* writer_;
  std::exception_ptr error_;
};

/// Checkpoint from which each rank reads its part.
class CheckpointForRank final : public Checkpoint {
 public:
  CheckpointForRank(cayspin::Lattice const& local, io::CheckpointReader& of_all)
      : local_(local), of_all_(of_all) {}

  bool restores() const override { return true; }
  void number(std::string const& name, double& value) override { of_all_.number(name, value); }
  void field(std::string const& name, std::vector<double>& numbers) override {
    numbers = of_all_.field(name, own_sites(local_));
  }

 private:
  cayspin::Lattice const& local_;
  io::CheckpointReader& of_all_;
};

}  // namespace cayspin::simulation
