#pragma once
#include <span>
#include <vector>

#include "protocols/procedures/likelihood_table.hpp"
#include "protocols/procedures/procedure.hpp"
namespace tapstudy::protocols {
// The posterior updated by Bayes' rule: prior times likelihood of one outcome, normalised. Throws
// InvalidInput if that is 0 everywhere.
std::vector<double> updated(std::span<const double> posterior, std::span<const double> likelihoods);

// Entropy of the posterior that is to be expected after a trial of each stimulus, in nats (Watson
// 2017, eq. 3 to 6), nuisances summed over (Prins 2013).
std::vector<double> expected_entropies(const LikelihoodTable& table,
                                       std::span<const double> posterior);

// The stimulus of least expected entropy. Of those within `entropy_tie` nats of the least, the
// first in the order of the table, so that rounding, which differs between machines, decides
// nothing.
inline constexpr double entropy_tie = 1e-10;
std::size_t most_informative(std::span<const double> entropies);

// Marginal posterior of each parameter.
std::vector<ParameterPosterior> marginals(const LikelihoodTable& table,
                                          std::span<const double> posterior);
double standard_deviation(const LikelihoodTable& table, std::span<const double> posterior,
                          std::size_t parameter);

struct QuestPlusStop {
  std::size_t trials{};
  // Once the posterior standard deviation of the first parameter is at most this.
  std::optional<double> standard_deviation;
};

// QUEST+ (Watson 2017) of any model: any number of axes, parameters and outcomes.
class QuestPlusTrack final : public Track {
 public:
  QuestPlusTrack(std::shared_ptr<const LikelihoodTable> table, const QuestPlusStop& stop);
  bool is_finished() const override { return trials() >= stop_.trials || is_narrow_; }
  TrackSummary summary() const override;
  // Probability of each combination of parameters, in the order of the table.
  const std::vector<double>& posterior() const { return posterior_; }

 private:
  std::vector<double> request() const override;
  void take(const std::vector<double>& presented, std::size_t outcome) override;

  std::shared_ptr<const LikelihoodTable> table_;
  QuestPlusStop stop_;
  std::vector<double> posterior_;
  bool is_narrow_{false};
  // Computed once for each trial, and only where it is asked for: a replay does not.
  mutable std::optional<std::vector<double>> next_;
};

class QuestPlusSettings final : public TrackSettings {
 public:
  // Throws InvalidInput as LikelihoodTable does, and where the prior is narrow enough to stop.
  struct Method {
    core::CitingText description{
        core::citing("QUEST+ ({})", "Watson 2017"_source)};  // its name and source
    std::optional<core::PsychometricShape> shape{};
  };
  QuestPlusSettings(QuestPlusDesign design, const QuestPlusStop& stop, Method method);

  std::size_t axes() const override { return table_->design().axes.size(); }
  std::size_t outcomes() const override { return table_->design().outcomes; }
  std::size_t max_trials() const override { return stop_.trials; }
  bool may_end_early() const override { return stop_.standard_deviation.has_value(); }
  std::vector<std::pair<double, double>> ranges() const override;
  std::optional<std::pair<double, double>> guess_rates() const override;
  // A QuestPlusTrack. Nothing in it is random.
  std::unique_ptr<Track> start(std::uint64_t seed) const override;
  std::optional<core::PsychometricShape> shape() const override { return method_.shape; }
  core::CitingText describe() const override { return method_.description; }
  const LikelihoodTable& table() const { return *table_; }

 private:
  std::shared_ptr<const LikelihoodTable> table_;
  QuestPlusStop stop_;
  Method method_;
};

// Whether the mode lies at the first or the last of several values of the parameter's grid: beyond
// it the posterior is cut off. False of other procedures than QUEST+ and psi, and of rates of
// guesses and lapses, which end at 0 by themselves.
bool is_at_end_of_grid(const ParameterPosterior& posterior, const TrackSettings& settings);
}  // namespace tapstudy::protocols
