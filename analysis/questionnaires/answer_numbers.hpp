#pragma once
#include <string>
#include <vector>

#include "analysis/questionnaires/questionnaires_section.hpp"
namespace tapstudy::analysis {
// As stored by C's rules. Throws InvalidInput, naming the item, for what is no finite number.
double number_of(const GivenAnswer& answer);

// The answers to an item where it was asked; `left_out` of those who were asked gave none.
struct ItemAnswers {
  std::vector<GivenAnswer> given;
  int left_out{};
};
ItemAnswers answers_to(const std::vector<GivenAnswer>& answers, const std::string& form,
                       const std::string& asked, const std::string& item);
}  // namespace tapstudy::analysis
