#pragma once
#include <optional>
#include <string>
#include <vector>

#include "analysis/report/confusion/confusion_data.hpp"
#include "analysis/statistics/resampling/null_tables.hpp"
namespace tapstudy::analysis {
// What answers are compared with that depend on no stimulus.
struct Randomisation {
  std::optional<NullTables> tables;  // unset: nothing was randomised, or answered
  std::string words;                 // how, or why not
  // The same draws where all answers are right; unset where answers are shuffled.
  std::optional<NullTables> if_all_right{};
};
// By the study's own orders, drawn again; beyond 20 000 answers, and where nobody knows the order,
// by shuffling each participant's answers over the trials.
Randomisation randomisation_of(const BlockDesign& design, const IdentificationData& data);
// Of counts whose participants are not known: all answers shuffled over the trials.
Randomisation randomisation_of(const CountTable& counts);

// So many draws; 0: as many as a report can afford, which it says.
struct Draws {
  int draws{};
  std::uint64_t seed{1};
  int of(const NullTables& tables) const;
};

// Which responses are right for each stimulus.
RightAnswers right_answers(const ConfusionMatrix& matrix);

// The share of right answers of somebody who always gives the one that is right most often; unset
// where that is no more than each other one, or a stimulus has no right answer.
std::optional<double> share_of_constant_answer(const ConfusionMatrix& matrix);

// Accuracy, and agreement in each factor, against chance by randomisation within participants.
struct ChanceTests {
  std::string test;  // how, or why not
  std::optional<PermutationResult> accuracy;
  std::vector<PermutationResult> factors;  // in the order given; empty where not tested
};
ChanceTests chance_tests(const Randomisation& randomisation, const ConfusionMatrix& matrix,
                         const std::vector<std::string>& factors, const Draws& wanted = {});

// Whether no other answers could have had a smaller p for accuracy, by the same draws: few draws of
// a study's orders may differ.
bool is_smallest_p(const Randomisation& randomisation, const ConfusionMatrix& matrix,
                   const PermutationResult& accuracy, const Draws& wanted = {});

// The p that accuracy has in this test if all answers of these participants are right: none can be
// smaller. Below .01 it is only roughly known. Unset where nothing is drawn again.
std::optional<double> smallest_chance_p(const BlockDesign& design,
                                        const std::vector<Place>& participants);

// Draws of the test of one participant: many are tested, and p can fall to .001.
inline constexpr int draws_of_a_participant = 999;

// One participant's accuracy, tested likewise by that participant's answers alone, so that habits
// are no sign of feeling anything; unset where nothing was randomised, or answered.
std::optional<double> chance_p_of(const IdentifyingParticipant& person, const BlockDesign& design,
                                  const IdentificationData& data);
}  // namespace tapstudy::analysis
