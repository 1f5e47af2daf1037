#pragma once
#include <string>
namespace tapstudy::runner {
// "correct FORM.ITEM ANSWER", or "correct FORM.ITEM@PLACE ANSWER" where the form was asked at
// several places: an answer to a questionnaire, not to a trial ("correct @12 ANSWER").
bool corrects_form(const std::string& action);
// Stores it, and returns what was done. Throws InvalidInput, before anything is written, for what
// was not asked of the participant, an answer that the item does not take, and an item on which it
// depends what is presented or asked: what followed from the answer cannot be undone.
std::string amend_form(const std::string& directory, const std::string& participant,
                       const std::string& action);
}  // namespace tapstudy::runner
