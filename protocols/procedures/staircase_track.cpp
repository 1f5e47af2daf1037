#include "protocols/procedures/staircase_track.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
namespace tapstudy::protocols {
namespace {
// P(n successes in a row come before m failures in a row), success of probability p each
// (Feller 1968, XIII.7).
double run_probability(double p, int n, int m) {
  const double q = 1.0 - p;
  const double successes = std::pow(p, n - 1);
  const double failures = std::pow(q, m - 1);
  return successes * (1.0 - std::pow(q, m)) / (successes + failures - successes * failures);
}

class StaircaseTrack final : public Track {
 public:
  explicit StaircaseTrack(const StaircaseSettings& settings)
      : Track{1, 2}, settings_{settings}, step_{settings.first_step} {}

  bool is_finished() const override {
    return trials() >= settings_.max_trials ||
           (settings_.max_reversals && reversals_.size() >= *settings_.max_reversals);
  }

  TrackSummary summary() const override {
    TrackSummary summary;
    summary.trials = trials();
    summary.is_finished = is_finished();
    summary.target = staircase_target(settings_);
    summary.trials_at_limit = trials_at_limit_;
    summary.reversals = reversals_;
    const std::size_t n = settings_.estimate_reversals;
    if (n > 0 && turns_.size() >= n) {
      const double sum =
          std::accumulate(turns_.end() - static_cast<std::ptrdiff_t>(n), turns_.end(), 0.0);
      summary.estimate = value_at(settings_, sum / static_cast<double>(n));
    }
    return summary;
  }

 private:
  std::vector<double> request() const override { return {value_at(settings_, offset_)}; }

  void take(const std::vector<double>& /*presented*/, std::size_t outcome) override {
    const bool is_correct = outcome == 1;
    trials_at_limit_ += is_at_limit() ? 1 : 0;
    in_a_row_ = is_correct == was_correct_ ? in_a_row_ + 1 : 1;
    was_correct_ = is_correct;
    if (in_a_row_ < (is_correct ? settings_.n_down : settings_.n_up)) {
      return;
    }
    in_a_row_ = 0;
    if (was_harder_ && *was_harder_ != is_correct) {
      reversals_.push_back({trials() + 1, value_at(settings_, offset_)});
      turns_.push_back(offset_);
      step_ = std::max(step_ / 2.0, settings_.min_step);
    }
    was_harder_ = is_correct;
    move(is_correct);
  }

  void move(bool is_harder) {
    const double step = is_harder ? step_ : step_ * settings_.easier_per_harder;
    const double signed_step = is_harder == settings_.is_harder_below ? -step : step;
    offset_ = std::clamp(offset_ + signed_step, offset_of(settings_, settings_.min),
                         offset_of(settings_, settings_.max));
  }

  bool is_at_limit() const {
    const double value = value_at(settings_, offset_);
    return value <= settings_.min || value >= settings_.max;
  }

  StaircaseSettings settings_;
  double step_;
  double offset_{0.0};
  int in_a_row_{0};
  bool was_correct_{false};
  std::optional<bool> was_harder_;  // the last step
  std::vector<Reversal> reversals_;
  std::vector<double> turns_;  // their offsets
  std::size_t trials_at_limit_{0};
};
}  // namespace

double staircase_target(const StaircaseSettings& settings) {
  // P(harder) 1 = P(easier) easier_per_harder
  const double balance = settings.easier_per_harder / (1.0 + settings.easier_per_harder);
  double low = 0.0;
  double high = 1.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (run_probability(middle, settings.n_down, settings.n_up) < balance ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double offset_of(const StaircaseSettings& settings, double value) {
  return settings.is_in_db ? 20.0 * std::log10(value / settings.start) : value - settings.start;
}

// Rounding does not lead beyond the limits.
double value_at(const StaircaseSettings& settings, double offset) {
  const double value =
      settings.is_in_db ? settings.start * std::pow(10.0, offset / 20.0) : settings.start + offset;
  return std::clamp(value, settings.min, settings.max);
}

std::unique_ptr<Track> start_staircase(const StaircaseSettings& settings) {
  return std::make_unique<StaircaseTrack>(settings);
}
}  // namespace tapstudy::protocols
