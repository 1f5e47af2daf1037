#pragma once
#include <array>
#include <string>
#include <string_view>
#include <vector>
namespace tapstudy::protocols {
inline constexpr std::size_t max_form_text = 5000;  // characters

//   likert  one of so many steps, from 1
//   scale   a mark on a line, from 0 (low) to 1 (high): a visual analogue scale
//   number  from min to max
//   single_choice  one of the options
//   text    anything
enum class ItemKind { likert, scale, number, single_choice, text };
inline constexpr std::array<std::string_view, 5> item_kind_names{"likert", "scale", "number",
                                                                 "single_choice", "text"};
static_assert(item_kind_names.size() == static_cast<std::size_t>(ItemKind::text) + 1);
constexpr std::string_view name(ItemKind kind) {
  return item_kind_names.at(static_cast<std::size_t>(kind));
}

// An allowed answer: its name in the data and the label shown to participants.
struct Option {
  std::string name;
  std::string label;
};

struct FormItem {
  std::string name;
  ItemKind kind{ItemKind::text};
  std::string question;
  bool is_required{true};
  int steps{7};     // likert
  std::string low;  // likert, scale: what the ends mean
  std::string high;
  double min{};  // number
  double max{};
  std::vector<Option> options;  // single_choice
};

// A questionnaire: asked before the first trial, after a block, or at the end of a session.
struct Form {
  std::string name;
  std::string title;
  std::string text;  // paragraphs before the first question; may be empty
  std::vector<FormItem> items;
};

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
