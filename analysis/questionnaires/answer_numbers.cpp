#include "analysis/questionnaires/answer_numbers.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/error.hpp"
#include "core/number_in.hpp"
namespace tapstudy::analysis {
double number_of(const GivenAnswer& answer) {
  const std::string text = answer.answer.value_or("");
  const auto number = core::number_in<double>(text);
  if (!number || !std::isfinite(*number)) {
    throw core::InvalidInput{fmt::format("the answer '{}' of {} to {} of form {} is not a number",
                                         text, answer.participant_id, answer.item, answer.form)};
  }
  return *number;
}

ItemAnswers answers_to(const std::vector<GivenAnswer>& answers, const std::string& form,
                       const std::string& asked, const std::string& item) {
  ItemAnswers found;
  for (const GivenAnswer& answer : answers) {
    if (answer.form == form && answer.asked == asked && answer.item == item) {
      if (answer.answer) {
        found.given.push_back(answer);
      } else {
        ++found.left_out;
      }
    }
  }
  return found;
}
}  // namespace tapstudy::analysis
