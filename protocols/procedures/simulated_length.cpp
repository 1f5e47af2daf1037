#include "protocols/procedures/simulated_length.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/error.hpp"
#include "core/psychometric_function.hpp"
#include "core/random/rng.hpp"
namespace tapstudy::protocols {
namespace {
constexpr std::size_t people = 40;
constexpr double widths_in_range = 8.0;
constexpr double lapse_rate = 0.02;

// Where levels lie: from 0, the hardest, to 1, the easiest.
class Ease {
 public:
  explicit Ease(const TrackSettings& track)
      : low_{track.ranges().front().first},
        high_{track.ranges().front().second},
        is_logarithmic_{low_ > 0.0},
        is_harder_below_{track.is_harder_below()} {}
  double of(double level) const {
    const double share = is_logarithmic_ ? std::log(level / low_) / std::log(high_ / low_)
                                         : (level - low_) / (high_ - low_);
    return is_harder_below_ ? share : 1.0 - share;
  }

 private:
  double low_;
  double high_;
  bool is_logarithmic_;
  bool is_harder_below_;
};

// A procedure may hold an answer impossible, such as a lapse where it assumes none: then the person
// gives the other one.
void observe(Track& track, const std::vector<double>& level, std::size_t outcome) {
  try {
    track.observe(level, outcome);
  } catch (const core::InvalidInput&) {
    track.observe(level, 1 - outcome);
  }
}

std::size_t trials_of_person(const TrackSettings& settings, const Ease& ease, double guess_rate,
                             std::uint64_t person) {
  core::Rng rng{person};
  const double threshold = rng.uniform();
  const auto track = settings.start(person);
  while (const auto level = track->next()) {
    const double right =
        core::proportion(core::PsychometricShape::cumulative_gaussian, ease.of(level->front()),
                         threshold, widths_in_range, guess_rate, lapse_rate);
    observe(*track, *level, rng.uniform() < right ? 1 : 0);
  }
  return track->trials();
}
}  // namespace

TrackLength simulated_length(const TrackSettings& track, double guess_rate) {
  const auto [low, high] = track.ranges().front();
  if (!track.may_end_early() || track.outcomes() != 2 || !(low < high)) {
    return {track.max_trials(), track.max_trials()};
  }
  const Ease ease{track};
  std::array<std::size_t, people> trials{};
  for (std::size_t i = 0; i < people; ++i) {
    trials[i] = trials_of_person(track, ease, guess_rate, i);
  }
  std::ranges::sort(trials);
  return {trials[people / 2], trials[people * 19 / 20]};
}
}  // namespace tapstudy::protocols
