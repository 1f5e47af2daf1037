#pragma once
#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "protocols/picture.hpp"
namespace tapstudy::protocols {
inline constexpr std::size_t max_form_text = 5000;  // characters

//   likert  one of so many steps, from 1
//   scale   a mark on a line, from 0 (low) to 1 (high): a visual analogue scale
//   number  from min to max
//   single_choice    one of the options
//   multiple_choice  one or more of the options: their names in the form's order, with ';' between
//   text    anything
enum class ItemKind { likert, scale, number, single_choice, multiple_choice, text };
inline constexpr std::array<std::string_view, 6> item_kind_names{
    "likert", "scale", "number", "single_choice", "multiple_choice", "text"};
static_assert(item_kind_names.size() == static_cast<std::size_t>(ItemKind::text) + 1);
constexpr std::string_view name(ItemKind kind) {
  return item_kind_names.at(static_cast<std::size_t>(kind));
}

// An allowed answer: its name in the data and the label shown to participants.
struct Option {
  std::string name;
  std::string label;
  std::optional<Picture> picture{};
};

inline constexpr char between_choices = ';';

// Met by an answer to this item that is, or chooses, one of these.
struct AnswerCondition {
  std::string form;
  std::string item;  // of kind single_choice, multiple_choice or likert
  std::vector<std::string> answers;
};
// "left or both to 'hand' of form 'about'".
std::string describe(const AnswerCondition& condition);

struct FormItem {
  std::string name;
  ItemKind kind{ItemKind::text};
  std::string question;
  std::optional<Picture> picture{};  // beside the question
  bool is_required{true};
  int steps{7};     // likert
  std::string low;  // likert, scale: what the ends mean
  std::string high;
  double min{};  // number
  double max{};
  std::vector<Option> options;              // single_choice, multiple_choice
  std::optional<AnswerCondition> asked_if;  // on an earlier item; unset: it is always asked
  std::vector<std::string> ends_session;    // answers after which the participant takes no part
  std::string bids;                         // the column of participants.tsv; empty: none
};

// A questionnaire: asked before the first trial, after a block, or at the end of a session.
struct Form {
  std::string name;
  std::string title;
  std::string text;  // paragraphs before the first question; may be empty
  std::vector<FormItem> items;
  std::optional<Picture> picture{};  // after the text
};

// Answers by item, those left out being absent.
using FormAnswers = std::map<std::string, std::string>;
// The same of all forms that were filled in, by form.
using FilledForms = std::map<std::string, FormAnswers>;

// The answers that can be conditions; empty: the item is of another kind.
std::vector<std::string> answers_that_decide(const FormItem& item);
// The form for whom has filled in these, without the items that answers to other forms rule out.
Form form_after(const Form& form, const FilledForms& filled);
// The items that are asked of whom answers so, in their order. What is ruled out has no answer.
std::vector<FormItem> asked_items(const Form& form, const FormAnswers& answers);
// Of the items whose answer ends the session the first.
std::optional<FormItem> item_that_ends(const Form& form, const FormAnswers& answers);
// nullopt: the form was not filled in.
std::optional<bool> is_met(const AnswerCondition& condition, const FilledForms& filled);

// What is wrong with an answer, and what is allowed; empty: nothing. Numbers are written as in C.
std::string wrong_with(const FormItem& item, const std::string& answer);

// The task load index of NASA, six scales without weights ("raw TLX"; Hart and Staveland 1988, Hart
// 2006). The English wording is that of the agency's own form, a work of the United States
// government. The others translate it; they are not validated versions.
Form nasa_tlx(const std::string& language);  // English if it has no other wording
const std::vector<std::string>& nasa_tlx_languages();
// Whether the form asks these six scales and nothing else, in whatever words: its score is then the
// mean of the six.
bool is_raw_tlx(const Form& form);
}  // namespace tapstudy::protocols
