#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "analysis/questionnaires/answer_numbers.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
struct PartialScore {
  double sum{};
  std::size_t items{};
};

double share_of(const GivenAnswer& answer) {
  const double share = number_of(answer);
  if (share < 0.0 || share > 1.0) {
    throw core::InvalidInput{fmt::format("the answer {} of {} to {} of form {} is not from 0 to 1",
                                         share, answer.participant_id, answer.item, answer.form)};
  }
  return share;
}

// Adds what everybody answered to one item.
void add_item(const std::string& item, const Questionnaire& form, const std::string& asked,
              const std::vector<GivenAnswer>& answers, std::map<std::string, PartialScore>& sums) {
  for (const GivenAnswer& answer : answers) {
    if (answer.form == form.name && answer.asked == asked && answer.item == item) {
      PartialScore& own = sums[answer.participant_id];
      own.sum += answer.answer ? share_of(answer) : 0.0;
      own.items += answer.answer ? 1 : 0;
    }
  }
}
}  // namespace

FormScores scores_of(const Questionnaire& form, const std::string& asked,
                     const std::vector<GivenAnswer>& answers) {
  std::map<std::string, PartialScore> sums;
  for (const QuestionnaireItem& item : form.items) {  // in their order: sums are rounded
    add_item(item.name, form, asked, answers, sums);
  }
  FormScores scores;
  for (const auto& [participant, own] : sums) {
    if (own.items == form.items.size()) {
      scores.of_participants.emplace_back(participant,
                                          100.0 * own.sum / static_cast<double>(own.items));
    } else {
      ++scores.incomplete;
    }
  }
  return scores;
}
}  // namespace tapstudy::analysis
