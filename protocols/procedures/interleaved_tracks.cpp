#include "protocols/procedures/interleaved_tracks.hpp"

#include "core/error.hpp"
#include "core/random/rng.hpp"
namespace tapstudy::protocols {
InterleavedTracks::InterleavedTracks(
    const std::vector<std::shared_ptr<const TrackSettings>>& settings, std::uint64_t seed)
    : seed_{seed} {
  for (const auto& one : settings) {
    tracks_.push_back(
        one->start(core::derived_seed(seed, core::Purpose::procedure, tracks_.size())));
  }
}

std::optional<std::size_t> InterleavedTracks::drawn() const {
  std::vector<std::size_t> unfinished;
  std::uint64_t trials = 0;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    trials += tracks_[i]->trials();
    if (!tracks_[i]->is_finished()) {
      unfinished.push_back(i);
    }
  }
  if (unfinished.empty()) {
    return std::nullopt;
  }
  core::Rng rng{core::derived_seed(seed_, core::Purpose::interleaving, trials)};
  return unfinished[rng.below(static_cast<std::uint32_t>(unfinished.size()))];
}

std::optional<InterleavedTracks::Request> InterleavedTracks::next() const {
  const auto track = drawn();
  if (!track) {
    return std::nullopt;
  }
  return Request{*track, tracks_[*track]->next().value()};
}

std::size_t InterleavedTracks::observe(const std::vector<double>& presented, std::size_t outcome) {
  const auto track = drawn();
  if (!track) {
    throw core::InvalidInput{"all procedures of the block have ended"};
  }
  tracks_[*track]->observe(presented, outcome);
  return *track;
}
}  // namespace tapstudy::protocols
