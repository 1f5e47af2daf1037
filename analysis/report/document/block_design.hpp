#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "analysis/statistics/confusion_matrix.hpp"
#include "core/model/progress.hpp"
#include "core/psychometric_function.hpp"
namespace tapstudy::analysis {
// The part of a study's design that its report needs.
struct PlannedHypothesis {
  std::string name;
  std::string statement;
  std::string stimulus;  // expected choice; empty if the claim is not about one stimulus
};
// A declared hypothesis about means over participants of what each of them answered.
struct PlannedComparison {
  PlannedHypothesis hypothesis;
  std::vector<std::string> factors{};  // an interaction of two; empty: another claim
  std::string other_stimulus{};        // to this, or …
  std::string other_block{};           // … to this block
  double within{};  // the largest difference that is none; of ratios the largest ratio; 0: the
                    // claim is that the blocks differ
  std::optional<double> below{};      // the claim is that what the block measures lies below this
  std::vector<std::string> groups{};  // the claim is that what it measures of these two differs
};
// The choice that counts of a participant who chose several times: the most frequent (of equals the
// earliest), or the first.
enum class Vote { majority, first };
// A participant's place in the study, from 0: among the participants, and among the balanced
// orders.
struct Place {
  int participant_index{};
  int order_index{};
};
// A property of stimuli: "youngs_modulus_pa" in data, for readers "Young's modulus" in "Pa".
struct AxisName {
  std::string key;
  std::string quantity;
  std::string unit;                // empty for a ratio
  std::string with_unit() const {  // "Young's modulus (Pa)"
    return unit.empty() ? quantity : quantity + " (" + unit + ")";
  }
};
// The axis along which a comparison differs from its standard. Levels, which psychometric functions
// are of, are how far it does: a difference in the axis's unit, or a fraction of the standard.
struct VariedAxis {
  AxisName name;
  double standard{};  // not 0 where levels are fractions
  bool is_fraction{true};
  bool is_below{};          // comparisons lie below the standard; their levels are positive too
  bool is_smaller_asked{};  // the answer names the alternative that has less of it
  double level_of(double value) const {
    const double difference = is_below ? standard - value : value - standard;
    return is_fraction ? difference / standard : difference;
  }
};
// The axis along which participants adjust a stimulus.
struct AdjustedAxis {
  AxisName name;
  bool is_logarithmic{};
  double middle{};                 // runs start below or above it
  std::optional<double> standard;  // unset: what it is adjusted to has no value on the axis
};
struct BlockDesign {
  std::string name;
  std::string task;
  std::string question;
  std::string statistic;  // that summarises it: a row of report/statistic.cpp
  std::vector<Item> stimuli;
  std::vector<Item> responses;
  std::vector<PlannedHypothesis> hypotheses;
  // The stimuli (places in the list above) that a participant's trials of this block would have had
  // in another draw of its order; empty where the order is not random.
  using Redraw = std::function<std::vector<int>(const Place& place, std::uint64_t draw)>;
  Redraw redraw;
  // Where the participants' answers follow from an assumption of the simulation: which. Nothing is
  // tested then.
  std::string premise;
  Vote vote{Vote::majority};
  // Tasks that discriminate a comparison from a standard.
  std::optional<VariedAxis> axis{};
  std::string decision_model{};  // of d': a row of detection/decision_model.hpp; empty: none
  int alternatives{};            // presented in a trial
  double guess_rate{};           // of right answers
  std::optional<AdjustedAxis> adjusted{};
  // Of a presentation in `redraw`: of a constrained order more than of a shuffled one.
  std::size_t redraw_cost{1};
  std::string part_of{};  // the whole block's name, where this is a part; empty: it is whole
  // Ratings: from 1 to this; 0: marks on a line, from 0 to 1.
  int steps{};
  // Pairs: "tie" is an answer.
  bool has_ties{};
  // False: answers without a protocol, which nobody says the order of.
  bool is_order_known{true};
  // On which all alternatives of a trial have the same values; the block is summarised at each.
  std::vector<AxisName> further_axes{};
  // Of psychometric functions.
  core::PsychometricShape shape{core::PsychometricShape::weibull};
  // Answers are "there is a difference": how often by a guess is the participant's own affair, and
  // shows where there is none.
  bool has_own_guess_rate{};
  // Main results only: what takes long and they do not depend on is left out.
  bool is_for_main_results{};
  std::vector<PlannedComparison> comparisons{};  // hypotheses, too
};
// Of different people, in the order of the protocol.
struct ParticipantGroup {
  std::string label;
  std::set<std::string> participants;
};
struct StudyDesign {
  std::string title;
  std::string notes;
  std::vector<BlockDesign> blocks;  // practice left out
  core::CountHook count{};          // of blocks summarised
  std::vector<ParticipantGroup> groups{};
};
}  // namespace tapstudy::analysis
