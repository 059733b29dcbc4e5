// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "ensemble_on_ranks.hpp"

#include "files/available_memory.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <span>
#include <type_traits>
#include <utility>

namespace cayspin::program {
namespace {

constexpr auto beyond = std::numeric_limits<std::int64_t>::max();

// Returns the numbers of all ranks, in the order of the ranks; nothing on ranks but the first.
template <class Number>
std::vector<Number> gathered(std::vector<Number> const& own, Ranks const& ranks) {
  static_assert(std::is_trivially_copyable_v<Number>);
  auto const bytes = std::as_bytes(std::span(own));
  auto const all_bytes = ranks.gather({bytes.begin(), bytes.end()});
  std::vector<Number> all(all_bytes.size() / sizeof(Number));
  if (!all.empty()) std::memcpy(all.data(), all_bytes.data(), all_bytes.size());
  return all;
}

// Returns the memory available to the replicas on this machine. All ranks look before any of them
// opens its replicas. The first rank keeps room for a frame of all replicas, which it gathers.
std::int64_t memory_for_replicas(io::Scene const& scene, RunSettings const& settings,
                                 Ranks const& ranks) {
  auto const bytes =
      settings.precision == Precision::double_precision ? sizeof(double) : sizeof(float);
  auto const frame =
      scene.ensemble.replicas * io::sites(scene) * 3 * static_cast<std::int64_t>(bytes);
  return std::max<std::int64_t>(0, io::available_memory() - (ranks.is_first() ? frame : 0));
}

}  // namespace

EnsembleOnRanks::EnsembleOnRanks(io::Scene const& scene, RunSettings const& settings, bool relaxes,
                                 Ranks& ranks)
    : ranks_(ranks),
      available_(ranks.together([&] { return memory_for_replicas(scene, settings, ranks); })),
      own_(ranks.together([&] {
        auto share = share_of_rank(scene, ranks.rank(), ranks.count(), ranks.on_this_machine());
        if (ranks.many()) share.available = available_;
        return std::make_unique<EnsembleRun>(scene, settings, relaxes, share);
      })),
      replicas_(scene.ensemble.replicas),
      last_step_(ranks.lowest(ranks.is_first() ? own_->last_step() : beyond)) {}

std::optional<std::string> EnsembleOnRanks::continue_from(std::filesystem::path const& file) {
  auto const warning = ranks_.together([&] { return own_->continue_from(file); });
  steps_ = own_->steps();
  return ranks_.is_first() ? warning : std::nullopt;
}

std::optional<std::string> EnsembleOnRanks::warning() {
  auto const of_own = ranks_.together([&] { return own_->warning(); });
  auto const warned = ranks_.lowest(of_own ? ranks_.rank() : ranks_.count());
  return warned == ranks_.rank() ? of_own : std::nullopt;
}

Advanced EnsembleOnRanks::advance(std::int64_t target, Looks const& looks) {
  auto const advanced =
      ranks_.together([&] { return own_->advance(target - own_->steps(), looks); });
  // A rank asks for an interrupt only now and then, and may reach `target` without doing so.
  bool const asked = target < last_step_ && looks.interrupted && looks.interrupted();
  auto const [interrupted, moves] =
      ranks_.any({advanced == Advanced::interrupted || asked, advanced != Advanced::at_rest});
  if (!interrupted && moves) {
    steps_ = target;
    return Advanced::whole;
  }
  // Replicas that have ended early do not count, unless all have.
  steps_ = moves ? ranks_.lowest(own_->is_at_rest() ? beyond : own_->steps())
                 : -ranks_.lowest(-own_->steps());
  return interrupted ? Advanced::interrupted : Advanced::at_rest;
}

void EnsembleOnRanks::store(std::filesystem::path const& path, io::CheckpointHeader const& header) {
  std::optional<io::EnsembleCheckpointWriter> file;
  ranks_.together([&] {
    if (ranks_.is_first()) file.emplace(path, header, replicas_);
  });
  auto const more = own_->states_at_once();
  auto const has_left = [&](std::size_t begin) {
    return ranks_.any({begin < own_->replicas(), false})[0];
  };
  for (std::size_t begin = 0; has_left(begin); begin += more) {
    std::vector<io::PackedReplica> replicas;
    std::vector<std::byte> bytes;
    ranks_.together([&] {
      if (begin >= own_->replicas()) return;
      auto number = own_->first_number() + static_cast<std::int64_t>(begin);
      for (auto const& state : own_->states(begin)) {
        auto const of_state = io::state_bytes(state);
        replicas.push_back({number++, std::ssize(of_state)});
        bytes.insert(bytes.end(), of_state.begin(), of_state.end());
      }
    });
    auto const of_all = gathered(replicas, ranks_);
    auto const states = ranks_.gather(std::move(bytes));
    ranks_.together([&] {
      if (file) file->add(of_all, states);
    });
  }
  ranks_.together([&] {
    if (file) file->commit();
  });
}

std::vector<Minimum> EnsembleOnRanks::relax(RelaxSettings const& settings) {
  return gathered(ranks_.together([&] { return own_->relax(settings); }), ranks_);
}

std::vector<io::Scalars> EnsembleOnRanks::scalars() {
  return gathered(ranks_.together([&] { return own_->scalars(); }), ranks_);
}

std::vector<std::byte> EnsembleOnRanks::spins() {
  return ranks_.gather(ranks_.together([&] { return own_->spins(); }));
}

io::RunCost EnsembleOnRanks::cost(double wall_seconds) const {
  io::RunCost cost{0, wall_seconds, 0};
  for (auto const evaluations : gathered<std::int64_t>({own_->evaluations()}, ranks_))
    cost.evaluations += evaluations;
  for (auto const seconds : gathered<double>({own_->step_seconds()}, ranks_))
    cost.step_seconds += seconds;
  return cost;
}

}  // namespace cayspin::program
