#include "protocols/procedures/quest_plus_track.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/error.hpp"
#include "protocols/procedures/posterior.hpp"
namespace tapstudy::protocols {
QuestPlusTrack::QuestPlusTrack(std::shared_ptr<const LikelihoodTable> table,
                               const QuestPlusStop& stop)
    : Track{table->design().axes.size(), table->design().outcomes},
      table_{std::move(table)},
      stop_{stop},
      posterior_{table_->prior()} {}

TrackSummary QuestPlusTrack::summary() const {
  TrackSummary summary;
  summary.trials = trials();
  summary.is_finished = is_finished();
  summary.parameters = marginals(*table_, posterior_);
  summary.estimate = summary.parameters.front().mean;
  return summary;
}

std::vector<double> QuestPlusTrack::request() const {
  if (!next_) {
    next_ = table_->stimulus(most_informative(expected_entropies(*table_, posterior_)));
  }
  return *next_;
}

void QuestPlusTrack::take(const std::vector<double>& presented, std::size_t outcome) {
  posterior_ = updated(posterior_, table_->likelihoods_at(presented, outcome));
  is_narrow_ = stop_.standard_deviation &&
               standard_deviation(*table_, posterior_, 0) <= *stop_.standard_deviation;
  next_.reset();
}

QuestPlusSettings::QuestPlusSettings(QuestPlusDesign design, const QuestPlusStop& stop,
                                     Method method)
    : table_{std::make_shared<const LikelihoodTable>(std::move(design))},
      stop_{stop},
      method_{std::move(method)} {
  const double prior_deviation = standard_deviation(*table_, table_->prior(), 0);
  if (stop_.standard_deviation && prior_deviation <= *stop_.standard_deviation) {
    throw core::InvalidInput{fmt::format(
        "the prior's standard deviation of {}, {:.4g}, is not above that at which to "
        "stop, {:.4g}",
        table_->design().parameters.front().name, prior_deviation, *stop_.standard_deviation)};
  }
}

std::optional<std::pair<double, double>> QuestPlusSettings::guess_rates() const {
  const auto& parameters = table_->design().parameters;
  const auto guess = std::ranges::find(parameters, "guess", &ParameterGrid::name);
  if (guess == parameters.end()) {
    return std::nullopt;
  }
  return std::pair{guess->values.front(), guess->values.back()};
}

std::unique_ptr<Track> QuestPlusSettings::start(std::uint64_t /*seed*/) const {
  return std::make_unique<QuestPlusTrack>(table_, stop_);
}

std::vector<std::pair<double, double>> QuestPlusSettings::ranges() const {
  std::vector<std::pair<double, double>> ranges;
  for (const std::vector<double>& axis : table_->design().axes) {
    const auto [low, high] = std::ranges::minmax(axis);
    ranges.emplace_back(low, high);
  }
  return ranges;
}
}  // namespace tapstudy::protocols
