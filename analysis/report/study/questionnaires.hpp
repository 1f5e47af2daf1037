#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "analysis/report/document/sections.hpp"
namespace tapstudy::analysis {
//   steps   whole numbers from 1: counted, and their quartiles
//   number  a number, or a mark on a line from 0 to 1: quartiles
//   choice  one of the options: counted
//   choices  one or more of them, with ';' between: each counted
//   text    only how many there are
enum class QuestionnaireKind { steps, number, choice, choices, text };
struct QuestionnaireItem {
  std::string name;
  QuestionnaireKind kind{QuestionnaireKind::text};
  std::string question;
  std::vector<std::string> options{};  // of a choice, as stored; of steps "1" to the last
};
struct Questionnaire {
  std::string name;
  std::vector<QuestionnaireItem> items;
  std::vector<std::string> asked;  // where, in the order of a session
  // The score is 100 times the mean of the items, each from 0 to 1: raw task load (Hart 2006).
  bool is_mean_scored{};
};
// An answer as stored.
struct GivenAnswer {
  std::string participant_id;
  std::string form;
  std::string asked;
  std::string item;
  std::optional<std::string> answer;  // unset: left out
};

// One score for each who answered every item, by participant id; how many others were asked.
struct FormScores {
  std::vector<std::pair<std::string, double>> of_participants;
  int incomplete{};
};
// Of a form where it was asked. Throws InvalidInput for an answer that is not from 0 to 1.
FormScores scores_of(const Questionnaire& form, const std::string& asked,
                     const std::vector<GivenAnswer>& answers);

// Tables questionnaire_items, questionnaire_answers (counts of steps and choices),
// questionnaire_scores (means over participants, 95 % t and bootstrap intervals) and
// questionnaire_scores_of_participants. The order of the answers does not matter. Free text is
// counted, never shown. Throws InvalidInput for a stored number that is none.
ReportSection questionnaires_section(const std::vector<Questionnaire>& forms,
                                     const std::vector<GivenAnswer>& answers);

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
