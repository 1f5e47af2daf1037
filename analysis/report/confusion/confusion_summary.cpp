#include "analysis/report/confusion/confusion_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <utility>

#include "analysis/report/confusion/chance_tests.hpp"
#include "analysis/report/confusion/confusion_sections.hpp"
#include "analysis/report/document/wording.hpp"
namespace tapstudy::analysis {
namespace {
std::vector<FactorResult> factor_results(const ConfusionMatrix& matrix) {
  std::vector<FactorResult> found;
  if (std::ranges::any_of(matrix.stimuli, [](const Item& stimulus) {
        return !stimulus.is_answered_by(stimulus.name);
      })) {
    return found;  // a factor's levels were asked for: there is no more in an answer
  }
  const std::vector<std::string> factors = factors_of(matrix);
  for (const std::string& factor : factors) {
    found.push_back(
        {factor, "", factor_accuracy(matrix, factor), factor_chance(matrix, factor, "")});
  }
  for (const std::string& factor : factors) {
    for (const std::string& given : factors) {
      if (factor != given) {
        found.push_back({factor, given, conditional_accuracy(matrix, factor, given),
                         factor_chance(matrix, factor, given)});
      }
    }
  }
  return found;
}

ConfusionMatrix matrix_of(const IdentificationData& data) {
  ConfusionMatrix matrix{data.stimuli, data.responses};
  for (const IdentifyingParticipant& person : data.participants) {
    for (const IdentifiedTrial& trial : person.trials) {
      ++matrix.counts[trial.stimulus][trial.response];
    }
  }
  return matrix;
}

MatrixOfParticipants counted_by(const BlockDesign& design, const IdentificationData& data,
                                const ConfusionMatrix& matrix) {
  MatrixOfParticipants counted{matrix, {}, randomisation_of(design, data)};
  for (const IdentifyingParticipant& person : data.participants) {
    counted.participants.push_back({person.id, counts_of(data, person)});
  }
  return counted;
}

using AccuracyOf = std::function<Proportion(const ConfusionMatrix& matrix)>;
std::optional<MeanProportion> over_participants(const MatrixOfParticipants& counted,
                                                const AccuracyOf& accuracy_of) {
  std::vector<Proportion> people;
  ConfusionMatrix own = counted.matrix;
  for (const ParticipantCounts& person : counted.participants) {
    own.counts = person.counts;
    people.push_back(accuracy_of(own));
  }
  return mean_proportion(people);
}

void add_matrix_sections(const MatrixOfParticipants& counted, IdentificationSummary& summary) {
  if (summary.accuracy.trials == 0) {
    return;
  }
  InformationSection information = information_section(counted);
  summary.information = information.sentence;
  summary.sections.push_back(std::move(information.section));
  summary.sections.push_back(sensitivity_section(counted));
  summary.sections.push_back(similarity_section(counted));
  summary.sections.push_back(dependence_section(counted));
}

void add_over_participants(const MatrixOfParticipants& counted, IdentificationSummary& summary) {
  summary.accuracy_over_participants = over_participants(counted, overall_accuracy);
  for (FactorResult& result : summary.factors) {
    result.over_participants = over_participants(counted, [&](const ConfusionMatrix& matrix) {
      return result.given.empty() ? factor_accuracy(matrix, result.factor)
                                  : conditional_accuracy(matrix, result.factor, result.given);
    });
  }
}

void add_tests(const BlockDesign& design, const Randomisation& randomisation,
               IdentificationSummary& summary) {
  std::vector<std::string> factors;
  for (const FactorResult& result : summary.factors) {
    if (result.given.empty()) {
      factors.push_back(result.factor);
    }
  }
  const ChanceTests tests = chance_tests(randomisation, summary.matrix, factors);
  summary.chance_test = tests.test;
  if (tests.accuracy) {
    summary.chance_p = tests.accuracy->p;
    if (!design.is_for_main_results &&
        is_smallest_p(randomisation, summary.matrix, *tests.accuracy)) {
      summary.chance_test += "; the smallest p that this design allows";
    }
  }
  for (std::size_t i = 0; i < tests.factors.size(); ++i) {
    summary.factors[i].p = tests.factors[i].p;  // those without condition come first
  }
  for (const PlannedHypothesis& planned : design.hypotheses) {
    HypothesisResult result{
        planned, summary.chance_test, summary.accuracy, summary.matrix.chance(), std::nullopt, 0.0};
    if (tests.accuracy) {
      result.p = tests.accuracy->p;
      result.p_floor = tests.accuracy->as_good == 0 ? tests.accuracy->p : 0.0;
    }
    summary.hypotheses.push_back(result);
  }
}

PersonalValues shares_right(const IdentificationSummary& summary) {
  return personal_shares(
      fmt::format("share of right answers, chance {:.3g}", summary.matrix.chance()),
      summary.participants,
      [](const ParticipantAccuracy& person) { return share_of(person.accuracy); });
}
}  // namespace

IdentificationSummary::IdentificationSummary(const BlockDesign& design, ConfusionMatrix counted)
    : BlockSummary{design},
      matrix{std::move(counted)},
      accuracy{overall_accuracy(matrix)},
      factors{factor_results(matrix)} {
  if (accuracy.trials > 0) {
    sections.push_back(independent_accuracy_section(*this));
  }
  add_matrix_sections({matrix, {{"", matrix.counts}}, randomisation_of(matrix.counts)}, *this);
  if (accuracy.trials > 0) {  // all answers are taken as independent
    main_results = {
        {"accuracy", accuracy.value(), wilson_interval(accuracy), std::nullopt, matrix.chance()}};
  }
  add_results();
}

IdentificationSummary::IdentificationSummary(const BlockDesign& design,
                                             const IdentificationData& data)
    : BlockSummary{design},
      matrix{matrix_of(data)},
      accuracy{overall_accuracy(matrix)},
      factors{factor_results(matrix)} {
  const MatrixOfParticipants counted = counted_by(design, data, matrix);
  for (const IdentifyingParticipant& person : data.participants) {
    ConfusionMatrix own = matrix;
    own.counts = counts_of(data, person);
    participants.push_back({person.id, overall_accuracy(own), chance_p_of(person, design, data)});
  }
  add_over_participants(counted, *this);
  personal = shares_right(*this);
  add_tests(design, counted.randomisation, *this);
  smallest_p_of_one = 1.0 / (draws_of_a_participant + 1);
  if (!design.is_for_main_results) {
    smallest_p_of_one = smallest_chance_p(design, {Place{}}).value_or(smallest_p_of_one);
  }
  if (chance_p) {
    methods = "Accuracy of identification against chance: " + chance_test + ".";
  }
  if (accuracy_over_participants && accuracy_over_participants->interval) {
    main_results = {{"accuracy", accuracy_over_participants->mean,
                     *accuracy_over_participants->interval, chance_p, matrix.chance(), false,
                     accuracy_over_participants->participants}};
  }
  if (accuracy.trials > 0) {
    sections.push_back(accuracy_section(*this));
    add_matrix_sections(counted, *this);
    for (const auto section :
         {counts_section, contrasts_section, order_section, times_section, exploration_section}) {
      sections.push_back(section(data));
    }
  }
  add_results();
}

std::shared_ptr<BlockSummary> summarise_identification(const BlockDesign& design,
                                                       const BlockRows& rows) {
  return std::make_shared<IdentificationSummary>(design, identification_data(design, rows.answers));
}

std::string title_of(const FactorResult& result) {
  return result.given.empty() ? result.factor
                              : fmt::format("{}, given {} is right", result.factor, result.given);
}

std::string with_interval(const Proportion& pooled, const std::optional<MeanProportion>& over) {
  if (pooled.trials == 0) {
    return "no answers";
  }
  const std::string counted = fraction_and_percent(pooled);
  return over ? counted + " " + over_participants(pooled, *over)
              : fmt::format("{} ({} if answers are independent)", counted,
                            percent_range(wilson_interval(pooled)));
}
}  // namespace tapstudy::analysis
