#include "protocols/procedures/quest_plus_track.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/error.hpp"
namespace tapstudy::protocols {
namespace {
// -p ln p, 0 at p = 0.
double entropy_term(double p) {
  return p > 0.0 ? -p * std::log(p) : 0.0;
}

// P(value) on the grid of one parameter.
std::vector<double> marginal(const LikelihoodTable& table, std::span<const double> posterior,
                             std::size_t parameter) {
  const std::vector<double>& values = table.design().parameters.at(parameter).values;
  std::vector<double> sums(values.size(), 0.0);
  for (std::size_t i = 0; i < posterior.size(); ++i) {
    const auto place = std::ranges::lower_bound(values, table.combination(i)[parameter]);
    sums[static_cast<std::size_t>(place - values.begin())] += posterior[i];
  }
  return sums;
}

double mean_of(const std::vector<double>& values, const std::vector<double>& probabilities) {
  return std::inner_product(values.begin(), values.end(), probabilities.begin(), 0.0);
}

double deviation_of(const std::vector<double>& values, const std::vector<double>& probabilities) {
  const double mean = mean_of(values, probabilities);
  double variance = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    variance += probabilities[i] * (values[i] - mean) * (values[i] - mean);
  }
  return std::sqrt(variance);
}

// Sums that are equal but for rounding reach the same level.
double quantile_of(const std::vector<double>& values, const std::vector<double>& probabilities,
                   double level) {
  double sum = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    sum += probabilities[i];
    if (sum >= level - 1e-12) {
      return values[i];
    }
  }
  return values.back();
}
}  // namespace

std::vector<double> updated(std::span<const double> posterior,
                            std::span<const double> likelihoods) {
  std::vector<double> product(posterior.size());
  std::ranges::transform(posterior, likelihoods, product.begin(), std::multiplies{});
  const double sum = std::accumulate(product.begin(), product.end(), 0.0);
  if (!(sum > 0.0)) {
    throw core::InvalidInput{
        "the outcome is impossible at this stimulus under every combination of the parameters that "
        "the earlier answers left"};
  }
  std::ranges::for_each(product, [&](double& p) { p /= sum; });
  return product;
}

// With m = posterior times likelihood, nuisances summed over, and P = sum of m, the entropy after
// an outcome is -sum (m/P) ln(m/P); weighted by P it is -sum m ln m + P ln P. Loops run over
// stimuli innermost, so that sums are formed in one order whatever the machine's vector width.
std::vector<double> expected_entropies(const LikelihoodTable& table,
                                       std::span<const double> posterior) {
  const std::size_t stimuli = table.stimuli();
  const std::size_t nuisances = table.nuisance_combinations();
  std::vector<double> entropies(stimuli, 0.0);
  for (std::size_t outcome = 0; outcome < table.design().outcomes; ++outcome) {
    std::vector<double> total(stimuli, 0.0);
    for (std::size_t first = 0; first < table.combinations(); first += nuisances) {
      std::vector<double> mass(stimuli, 0.0);
      for (std::size_t i = first; i < first + nuisances; ++i) {
        const std::span<const double> likelihoods = table.likelihoods(i, outcome);
        for (std::size_t s = 0; s < stimuli; ++s) {
          mass[s] += posterior[i] * likelihoods[s];
        }
      }
      for (std::size_t s = 0; s < stimuli; ++s) {
        total[s] += mass[s];
        entropies[s] += entropy_term(mass[s]);
      }
    }
    for (std::size_t s = 0; s < stimuli; ++s) {
      entropies[s] -= entropy_term(total[s]);
    }
  }
  return entropies;
}

std::size_t most_informative(std::span<const double> entropies) {
  const double least = std::ranges::min(entropies);
  const auto first = std::ranges::find_if(
      entropies, [&](double entropy) { return entropy <= least + entropy_tie; });
  return static_cast<std::size_t>(first - entropies.begin());
}

double standard_deviation(const LikelihoodTable& table, std::span<const double> posterior,
                          std::size_t parameter) {
  return deviation_of(table.design().parameters.at(parameter).values,
                      marginal(table, posterior, parameter));
}

std::vector<ParameterPosterior> marginals(const LikelihoodTable& table,
                                          std::span<const double> posterior) {
  const auto peak =
      static_cast<std::size_t>(std::ranges::max_element(posterior) - posterior.begin());
  std::vector<ParameterPosterior> all;
  for (std::size_t parameter = 0; parameter < table.design().parameters.size(); ++parameter) {
    const ParameterGrid& grid = table.design().parameters[parameter];
    const std::vector<double> probabilities = marginal(table, posterior, parameter);
    ParameterPosterior own{grid.name,
                           mean_of(grid.values, probabilities),
                           table.combination(peak)[parameter],
                           deviation_of(grid.values, probabilities),
                           {}};
    for (const double level : std::array{0.025, 0.25, 0.5, 0.75, 0.975}) {
      own.quantiles.push_back({level, quantile_of(grid.values, probabilities, level)});
    }
    all.push_back(own);
  }
  return all;
}

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

bool is_at_end_of_grid(const ParameterPosterior& posterior, const TrackSettings& settings) {
  const auto* const quest = dynamic_cast<const QuestPlusSettings*>(&settings);
  if (quest == nullptr || posterior.name == "guess" || posterior.name == "lapse") {
    return false;
  }
  const std::vector<ParameterGrid>& parameters = quest->table().design().parameters;
  const auto own = std::ranges::find(parameters, posterior.name, &ParameterGrid::name);
  if (own == parameters.end() || own->values.size() < 2) {
    return false;
  }
  const auto [low, high] = std::ranges::minmax(own->values);
  return posterior.mode <= low || posterior.mode >= high;
}
}  // namespace tapstudy::protocols
