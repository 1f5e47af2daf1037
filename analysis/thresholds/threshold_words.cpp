#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "analysis/detection/decision_model.hpp"
#include "analysis/thresholds/threshold_tables.hpp"
namespace tapstudy::analysis {
std::string level_words(const VariedAxis& axis) {
  const std::string side = axis.is_below ? "below" : "above";
  return axis.is_fraction ? fmt::format("{} {} the standard of {:.4g}, as a fraction of it",
                                        axis.name.with_unit(), side, axis.standard)
                          : fmt::format("{} {} the standard of {:.4g}", axis.name.with_unit(), side,
                                        axis.standard);
}

namespace {
// Empty: there is none.
std::string d_prime_words(const BlockDesign& design) {
  if (design.has_own_guess_rate) {
    return "d' at a level: same-different of a differencing observer, because levels change from "
           "trial to trial (Macmillan & Creelman 2005, ch. 9), by hits there and all false alarms, "
           "k + 1/2 in n + 1 (Hautus 1995).";
  }
  return design.decision_model.empty()
             ? ""
             : fmt::format("d' at a level by the decision model '{}' ({}).", design.decision_model,
                           find_decision_model(design.decision_model)->summary);
}

// Catch trials, at 0, aside.
bool is_beyond_levels(double threshold, const std::vector<Level>& levels) {
  const auto lowest =
      std::ranges::find_if(levels, [](const Level& one) { return one.value != 0.0; });
  return lowest != levels.end() && (threshold < lowest->value || threshold > levels.back().value);
}

std::vector<std::string> remarks_on_people(const std::vector<ParticipantThreshold>& people) {
  std::vector<std::string> remarks;
  for (const ParticipantThreshold& person : people) {
    if (!person.estimate) {
      remarks.push_back(
          fmt::format("{} has no threshold: {}.", person.participant_id, person.no_threshold));
    }
  }
  for (const ParticipantThreshold& person : people) {
    if (person.estimate && !person.no_posterior.empty()) {
      remarks.push_back(fmt::format("{} has a threshold but no posterior: {}.",
                                    person.participant_id, person.no_posterior));
    }
  }
  for (const ParticipantThreshold& person : people) {
    if (person.posterior && is_beyond_levels(person.posterior->threshold, person.levels)) {
      remarks.push_back(
          fmt::format("The median of {}'s posterior lies beyond the levels that were presented: it "
                      "rests on the prior.",
                      person.participant_id));
    }
  }
  if (std::ranges::any_of(people, [](const ParticipantThreshold& person) {
        return person.estimate && person.estimate->is_step;
      })) {
    remarks.emplace_back(
        "A slope that is only known to be above a limit: the answers change within one step "
        "between levels. The threshold is then the middle of those that are equally likely.");
  }
  return remarks;
}

std::vector<std::string> remarks_on_mean(const ThresholdResults& results) {
  if (!results.mean_log) {
    return {"No mean over participants: it takes two with a threshold."};
  }
  std::vector<std::string> remarks{
      "Mean over participants: of the logarithms of their thresholds, each counting the same, "
      "interval by t. The standard deviation is that between participants and of their "
      "estimates' errors together. Answers of participants are not put together as if of one."};
  if (results.population) {
    remarks.emplace_back(
        "Random-effects mean (Paule & Mandel 1982, interval of Hartung & Knapp 2001): each "
        "posterior "
        "counts as well as it is known; its standard deviation is that of participants alone.");
  }
  const int without =
      static_cast<int>(results.participants.size()) - results.mean_log->participants;
  if (without > 0) {
    remarks.push_back(fmt::format(
        "It leaves out {} without a threshold, which biases it.",
        without == 1 ? "the participant" : fmt::format("the {} participants", without)));
  }
  return remarks;
}
}  // namespace

std::vector<std::string> threshold_remarks(const BlockDesign& design,
                                           const ThresholdResults& results) {
  if (results.participants.empty()) {
    return {"There are no answers."};
  }
  std::vector<std::string> remarks{
      "Levels: " + level_words(*design.axis) + ".",
      fmt::format("Thresholds: maximum likelihood of a {} function of the level, {}, lapse rate "
                  "from 0 to 0.1; intervals by profile likelihood. At the threshold the function "
                  "without guesses and lapses is at {:.0f} %.",
                  core::row_of(design.shape).name,
                  design.has_own_guess_rate
                      ? "guess rate free, with the false alarms as answers at the level 0"
                      : fmt::format("guess rate {:.3g} fixed", design.guess_rate),
                  100.0 * core::shape_value(design.shape, 1.0, 1.0, 1.0))};
  std::ranges::copy(remarks_on_people(results.participants), std::back_inserter(remarks));
  std::ranges::copy(remarks_on_mean(results), std::back_inserter(remarks));
  remarks.push_back(
      results.draws > 0
          ? fmt::format("Deviance test: {} parametric bootstrap draws; a small p says that the "
                        "function does not fit.",
                        results.draws)
          : "Deviance tests are not made for so many levels.");
  remarks.emplace_back(results.has_posteriors
                           ? "Posteriors: beta-binomial answers and the priors of Schütt et al. "
                             "2016, which limit the slope where the answers alone do not."
                           : "Posteriors are not computed for so many levels.");
  if (const std::string words = d_prime_words(design); !words.empty()) {
    remarks.push_back(words);
  }
  return remarks;
}
}  // namespace tapstudy::analysis
