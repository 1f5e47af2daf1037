#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/report/document/block_design.hpp"
#include "analysis/report/document/block_summary.hpp"
#include "analysis/report/document/cells.hpp"
#include "analysis/statistics/detection/decision_model.hpp"
#include "analysis/statistics/detection/rates.hpp"
#include "analysis/statistics/resampling/null_tables.hpp"
#include "results/rows.hpp"
namespace tapstudy::analysis {
// How often each participant gave each answer: one that is preferred whatever is presented is a
// bias. All are right equally often.
ReportTable answer_counts_table(const std::vector<results::AnswerRow>& answers);

// The block's decision model with the alternatives that its guess rate stands for; unset if it has
// none. Throws InvalidInput where there is no such model, or it has no such guess rate.
std::optional<DecisionTask> decision_task(const BlockDesign& design);

// Answers that are right or wrong, of trials whose alternatives differ or, in same-different, may
// be alike.

// "different" to alternatives that differ (hits) and to alternatives that are alike (false alarms).
struct DifferentRates {
  Proportion hits;
  Proportion false_alarms;
  RatesSensitivity differencing;  // both of rates with the log-linear correction
  RatesSensitivity independent;
  std::optional<Interval> differencing_interval;  // of the d' above; unset where it is 0
  std::optional<Interval> independent_interval;
  YesNoSensitivity criterion;  // its c: above 0, "same" is preferred
};

struct ParticipantDiscrimination {
  std::string participant_id;
  Proportion correct;
  std::optional<double> p;                 // by the same test as all; unset where nothing is tested
  std::optional<Sensitivity> sensitivity;  // by the block's decision model, if it has one
  std::optional<DifferentRates> rates;     // where there are trials of both kinds
};

struct DPrimeOfMean {
  double d_prime{};   // 0 where the proportion is at chance or below
  Interval interval;  // 95 %; high may be infinity
};

// Whether pairs of the same are presented as well, so that there are false alarms.
bool are_same_presented(const std::vector<ParticipantDiscrimination>& people);
// In the same order.
std::vector<Proportion> correct_of(const std::vector<ParticipantDiscrimination>& people);

struct DiscriminationResults {
  std::vector<ParticipantDiscrimination> participants;  // by name
  struct Pair {
    std::string stimuli;              // names, joined
    std::vector<Proportion> correct;  // of each participant
    // Of the mean proportion, as d_prime_of_mean; unset also where pairs of the same are presented,
    // whose answers belong to it.
    std::optional<DPrimeOfMean> d_prime{};
  };
  std::vector<Pair> pairs;  // by name
  Proportion correct;       // of all answers
  // Of the mean proportion over participants and its interval (mean_share), mapped through
  // d'. Not the mean of the participants' d': each is 0 or above, so that guessing gave more than
  // 0. Of three participants with answers or more.
  std::optional<DPrimeOfMean> d_prime_of_mean;
  // Of all answers, one-sided: by the places' own randomisation where it is known what was right in
  // each trial (places_redrawn), else exact binomial. Unset where nothing is tested or answered.
  std::optional<double> p;
  double p_floor{};                 // where no draw was as good: p is only known to be no larger
  int draws{};                      // of places; 0: exact binomial
  const DecisionModelRow* model{};  // nullptr: none
};

// What would be right, and was answered, in each repetition of each participant's trials: of those
// who feel no difference the places of answers might as well have been in any other order within a
// repetition, in which each is right equally often. Binomial counts vary more than that, and less
// where participants prefer an answer. Unset where not every answer says what was right: it is that
// which was given, or the other of two, or the alternative that alone differs, or is as the last
// one, X.
std::optional<NullTables> places_redrawn(const BlockDesign& design,
                                         const std::vector<results::AnswerRow>& answers);

// Throws InvalidInput for answers that are neither right nor wrong, a guess rate that is not in (0,
// 1), and a decision model that there is not or that does not have this guess rate.
DiscriminationResults discrimination_results(const BlockDesign& design,
                                             const std::vector<results::AnswerRow>& answers);

// Discrimination of stimuli without a procedure (odd one out, ABX, same-different): proportions
// correct against design.guess_rate, d' by design.decision_model, and where some trials hold no
// difference the rates of answering that there is one. Throws InvalidInput as
// discrimination_results does.
std::shared_ptr<BlockSummary> summarise_discrimination(const BlockDesign& design,
                                                       const BlockRows& rows);
}  // namespace tapstudy::analysis
