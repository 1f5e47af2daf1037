#pragma once
#include "protocols/procedures/procedure.hpp"
namespace tapstudy::protocols {
// Several tracks in one block, so that a participant cannot follow any one of them (Cornsweet
// 1962). Before each trial one of the unfinished tracks is drawn, all equally likely. The draw
// depends on the seed and on how many trials were observed; tracks have seeds of their own, derived
// from it.
class InterleavedTracks {
 public:
  struct Request {
    std::size_t track{};  // its place in the list, from 0
    std::vector<double> values;
  };
  // At least one, none null.
  InterleavedTracks(const std::vector<std::shared_ptr<const TrackSettings>>& settings,
                    std::uint64_t seed);

  bool are_finished() const { return !drawn(); }
  // nullopt: all are finished.
  std::optional<Request> next() const;
  // Of the track drawn by next(), as Track::observe; which that was. Throws InvalidInput, also if
  // all are finished.
  std::size_t observe(const std::vector<double>& presented, std::size_t outcome);
  std::size_t size() const { return tracks_.size(); }
  const Track& track(std::size_t place) const { return *tracks_.at(place); }

 private:
  std::optional<std::size_t> drawn() const;

  std::vector<std::unique_ptr<Track>> tracks_;
  std::uint64_t seed_;
};
}  // namespace tapstudy::protocols
