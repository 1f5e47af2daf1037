#include "analysis/statistics/response_times.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
std::vector<double> standardised(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  double mean = 0.0;
  for (const double value : values) {
    mean += value / n;
  }
  double variance = 0.0;
  for (const double value : values) {
    variance += (value - mean) * (value - mean) / n;
  }
  std::vector<double> z;
  for (const double value : values) {
    z.push_back(variance > 0.0 ? (value - mean) / std::sqrt(variance) : 0.0);
  }
  return z;
}

void check_times(const TimedAnswers& answers) {
  if (!std::ranges::all_of(answers,
                           [](const TimedAnswer& of) { return std::isfinite(of.time_s); })) {
    throw core::InvalidInput{"response times are finite"};
  }
}

// Adds the means of each part of a participant's answers in order of their times.
void add_parts(TimedAnswers answers, std::vector<ConditionalAccuracyBin>& sums) {
  std::ranges::stable_sort(answers, {}, &TimedAnswer::time_s);
  for (std::size_t bin = 0; bin < sums.size(); ++bin) {
    const std::size_t begin = bin * answers.size() / sums.size();
    const std::size_t end = (bin + 1) * answers.size() / sums.size();
    const auto size = static_cast<double>(end - begin);
    for (std::size_t i = begin; i < end; ++i) {
      sums[bin].mean_time_s += answers[i].time_s / size;
      sums[bin].share_right += answers[i].is_right ? 1.0 / size : 0.0;
    }
  }
}
}  // namespace

std::vector<ConditionalAccuracyBin> conditional_accuracy(
    const std::vector<TimedAnswers>& participants, std::size_t bins) {
  if (bins < 1) {
    throw core::InvalidInput{"a conditional accuracy function has one bin or more"};
  }
  std::vector<ConditionalAccuracyBin> sums(bins);
  double people = 0.0;
  for (const TimedAnswers& answers : participants) {
    check_times(answers);
    if (answers.size() >= bins) {
      people += 1.0;
      add_parts(answers, sums);
    }
  }
  if (people == 0.0) {
    return {};
  }
  for (ConditionalAccuracyBin& bin : sums) {
    bin.mean_time_s /= people;
    bin.share_right /= people;
  }
  return sums;
}

std::vector<double> balanced_integration_scores(const std::vector<SpeedAndAccuracy>& entries) {
  if (entries.size() < 2) {
    return {};
  }
  std::vector<double> shares;
  std::vector<double> times;
  for (const SpeedAndAccuracy& entry : entries) {
    shares.push_back(entry.share_right);
    times.push_back(entry.mean_time_s);
  }
  const std::vector<double> of_share = standardised(shares);
  const std::vector<double> of_time = standardised(times);
  std::vector<double> scores;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    scores.push_back(of_share[i] - of_time[i]);
  }
  return scores;
}
}  // namespace tapstudy::analysis
