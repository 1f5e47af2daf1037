#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/report/document/block_summary.hpp"
#include "analysis/statistics/population/means.hpp"
namespace tapstudy::analysis {
// The method of adjustment (method of average error: Fechner 1860; Gescheider 1997, ch. 3): in each
// run one alternative is moved along an axis until it feels equal to the standard. Where the axis
// is spaced logarithmically, means and deviations are of natural logarithms: means are geometric,
// a constant error is the ratio of mean and standard, and a standard deviation is near to a Weber
// fraction.

struct Setting {
  double start{};  // NaN: not known
  double value{};
};

struct ParticipantSettings {
  std::string participant_id;
  std::vector<Setting> settings;       // in the order of the trials
  double mean{};                       // the participant's point of subjective equality
  double standard_deviation{};         // of the settings, with n - 1; NaN of one
  std::optional<double> error{};       // constant error; unset without a standard on the axis
  std::optional<double> ascending{};   // mean of the runs that started below the middle
  std::optional<double> descending{};  // of those that started above
};

struct MeanOfSettings {
  double mean{};
  // 95 % over participants, by t or, of what is not below 0, positive_interval; unset for fewer
  // than two
  std::optional<Interval> interval;
  std::optional<Interval>
      bootstrap;  // 95 %, by bootstrap_interval; unset likewise, and of equal values
  int participants{};
};

struct AdjustmentResults {
  std::vector<ParticipantSettings> participants;  // by name
  std::optional<MeanOfSettings> equality;         // mean over participants of their means
  std::optional<MeanOfSettings> error;            // constant error
  std::optional<MeanOfSettings> deviation;        // of participants' standard deviations
  std::optional<MeanOfSettings> hysteresis;       // ascending less descending, or their ratio
  std::optional<SignFlipTest> error_test;         // of no constant error
  std::optional<SignFlipTest> hysteresis_test;    // of equal means of both kinds of runs
};

// Throws InvalidInput for a design without an adjusted axis, answers that are no finite number, and
// on a logarithmic axis numbers that are not above 0.
AdjustmentResults adjustment_results(const BlockDesign& design,
                                     const std::vector<results::AnswerRow>& answers);

// Settings of the method of adjustment: the point of subjective equality, constant error, standard
// deviation, and runs from below against runs from above, of each participant and over
// participants. Throws InvalidInput as adjustment_results does.
std::shared_ptr<BlockSummary> summarise_adjustments(const BlockDesign& design,
                                                    const BlockRows& rows);
}  // namespace tapstudy::analysis
