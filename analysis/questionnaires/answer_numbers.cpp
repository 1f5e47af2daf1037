#include "analysis/questionnaires/answer_numbers.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "core/error.hpp"
namespace tapstudy::analysis {
double number_of(const GivenAnswer& answer) {
  const std::string text = answer.answer.value_or("");
  double number = 0.0;
  const char* const end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc{} || stopped != end || !std::isfinite(number)) {
    throw core::InvalidInput{fmt::format("the answer '{}' of {} to {} of form {} is not a number",
                                         text, answer.participant_id, answer.item, answer.form)};
  }
  return number;
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
