#include "protocols/form.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <sstream>

#include "core/text/plain_text.hpp"
namespace tapstudy::protocols {
namespace {
std::vector<std::string> names_of(const std::vector<Option>& options) {
  std::vector<std::string> names;
  std::ranges::transform(options, std::back_inserter(names), &Option::name);
  return names;
}

std::string unless_within(const std::string& text, double low, double high, bool is_whole) {
  const auto number = core::number_in<double>(text);
  const bool is_allowed = number && *number >= low && *number <= high &&
                          (!is_whole || *number == static_cast<double>(static_cast<int>(*number)));
  return is_allowed ? ""
                    : fmt::format("please answer with a {}number from {:.6g} to {:.6g}",
                                  is_whole ? "whole " : "", low, high);
}

std::vector<std::string> choices_of(const std::string& answer) {
  std::vector<std::string> choices;
  std::istringstream parts{answer};
  for (std::string choice; std::getline(parts, choice, between_choices);) {
    choices.push_back(choice);
  }
  return choices;
}

// In the form's order, so that equal choices are equal texts.
std::string unless_chosen(const std::vector<Option>& options, const std::string& answer) {
  const std::vector<std::string> names = names_of(options);
  auto from = names.begin();
  bool is_right = !answer.ends_with(between_choices);
  for (const std::string& choice : choices_of(answer)) {
    from = std::find(from, names.end(), choice);
    is_right = is_right && from != names.end();
    from = from == names.end() ? from : std::next(from);
  }
  return is_right ? ""
                  : fmt::format(
                        "please answer with one or more of, in this order and with '{}' "
                        "between: {}",
                        between_choices, fmt::join(names, ", "));
}

bool is_met(const AnswerCondition& condition, const FormAnswers& answers) {
  const auto answer = answers.find(condition.item);
  if (answer == answers.end()) {
    return false;
  }
  const auto decides = [&](const std::string& given) {
    return std::ranges::find(condition.answers, given) != condition.answers.end();
  };
  return decides(answer->second) || std::ranges::any_of(choices_of(answer->second), decides);
}
}  // namespace

std::string describe(const AnswerCondition& condition) {
  return fmt::format("{} to '{}' of form '{}'", fmt::join(condition.answers, " or "),
                     condition.item, condition.form);
}

std::vector<std::string> answers_that_decide(const FormItem& item) {
  std::vector<std::string> answers = names_of(item.options);
  for (int step = 1; item.kind == ItemKind::likert && step <= item.steps; ++step) {
    answers.push_back(std::to_string(step));
  }
  return answers;
}

std::optional<bool> is_met(const AnswerCondition& condition, const FilledForms& filled) {
  const auto answers = filled.find(condition.form);
  return answers == filled.end() ? std::nullopt : std::optional{is_met(condition, answers->second)};
}

Form form_after(const Form& form, const FilledForms& filled) {
  Form left = form;
  std::erase_if(left.items, [&](const FormItem& item) {
    return item.asked_if && item.asked_if->form != form.name &&
           !is_met(*item.asked_if, filled).value_or(false);
  });
  return left;
}

std::vector<FormItem> asked_items(const Form& form, const FormAnswers& answers) {
  std::vector<FormItem> asked;
  FormAnswers of_asked;
  for (const FormItem& item : form.items) {
    if (item.asked_if && item.asked_if->form == form.name && !is_met(*item.asked_if, of_asked)) {
      continue;
    }
    asked.push_back(item);
    if (const auto answer = answers.find(item.name); answer != answers.end()) {
      of_asked.insert(*answer);
    }
  }
  return asked;
}

std::optional<FormItem> item_that_ends(const Form& form, const FormAnswers& answers) {
  const std::vector<FormItem> asked = asked_items(form, answers);
  const auto ending = std::ranges::find_if(asked, [&](const FormItem& item) {
    return is_met({form.name, item.name, item.ends_session}, answers);
  });
  return ending == asked.end() ? std::nullopt : std::optional{*ending};
}

std::string wrong_with(const FormItem& item, const std::string& answer) {
  if (answer.empty()) {
    return item.is_required ? "please answer this question" : "";
  }
  switch (item.kind) {
    case ItemKind::likert:
      return unless_within(answer, 1.0, item.steps, true);
    case ItemKind::scale:
      return unless_within(answer, 0.0, 1.0, false);
    case ItemKind::number:
      return unless_within(answer, item.min, item.max, false);
    case ItemKind::single_choice:
      return std::ranges::find(item.options, answer, &Option::name) != item.options.end()
                 ? ""
                 : fmt::format("please answer with one of: {}",
                               fmt::join(names_of(item.options), ", "));
    case ItemKind::multiple_choice:
      return unless_chosen(item.options, answer);
    case ItemKind::text:
      break;
  }
  if (!core::is_plain_text(answer)) {
    return "must be UTF-8 text without control characters";
  }
  return core::character_count(answer) <= max_form_text
             ? ""
             : fmt::format("at most {} characters", max_form_text);
}

namespace {
struct Ends {
  const char* low;
  const char* high;
};
struct Wording {
  const char* language;
  const char* title;
  const char* text;
  Ends demand;
  Ends performance;
  std::array<const char*, 6> questions;
};

constexpr std::array<const char*, 6> item_names{
    "mental_demand", "physical_demand", "temporal_demand", "performance", "effort", "frustration"};
constexpr std::string_view of_performance = "performance";

constexpr std::array<Wording, 3> wordings{
    {{"en",
      "Task load",
      "Please mark on each line how the task was for you.",
      {"Very low", "Very high"},
      {"Perfect", "Failure"},
      {"How mentally demanding was the task?", "How physically demanding was the task?",
       "How hurried or rushed was the pace of the task?",
       "How successful were you in accomplishing what you were asked to do?",
       "How hard did you have to work to accomplish your level of performance?",
       "How insecure, discouraged, irritated, stressed, and annoyed were you?"}},
     {"de",
      "Beanspruchung durch die Aufgabe",
      "Bitte markieren Sie auf jeder Linie, wie die Aufgabe für Sie war.",
      {"Sehr gering", "Sehr hoch"},
      {"Perfekt", "Misserfolg"},
      {"Wie hoch war die geistige Anforderung der Aufgabe?",
       "Wie hoch war die körperliche Anforderung der Aufgabe?",
       "Wie gehetzt oder eilig war das Tempo der Aufgabe?",
       "Wie erfolgreich haben Sie ausgeführt, worum Sie gebeten wurden?",
       "Wie sehr mussten Sie sich anstrengen, um Ihre Leistung zu erreichen?",
       "Wie verunsichert, entmutigt, gereizt, gestresst und verärgert waren Sie?"}},
     {"ja",
      "課題の負荷",
      "課題がどうであったか、それぞれの線の上に印を付けてください。",
      {"とても低い", "とても高い"},
      {"完璧", "失敗"},
      {"課題はどのくらい知的・知覚的に負担でしたか？", "課題はどのくらい身体的に負担でしたか？",
       "課題のペースはどのくらい慌ただしいものでしたか？",
       "求められたことをどのくらいうまく達成できましたか？",
       "その成績を達成するために、どのくらい努力が必要でしたか？",
       "どのくらい不安、落胆、いらいら、ストレス、不快を感じましたか？"}}}};

FormItem scale(const Wording& wording, std::size_t index) {
  const Ends& ends = item_names[index] == of_performance ? wording.performance : wording.demand;
  FormItem item;
  item.name = item_names[index];
  item.kind = ItemKind::scale;
  item.question = wording.questions[index];
  item.low = ends.low;
  item.high = ends.high;
  return item;
}
}  // namespace

const std::vector<std::string>& nasa_tlx_languages() {
  static const std::vector<std::string> languages = [] {
    std::vector<std::string> all;
    std::ranges::transform(wordings, std::back_inserter(all), &Wording::language);
    return all;
  }();
  return languages;
}

bool is_raw_tlx(const Form& form) {
  return std::ranges::equal(form.items, item_names, {}, &FormItem::name) &&
         std::ranges::all_of(form.items,
                             [](const FormItem& item) { return item.kind == ItemKind::scale; });
}

Form nasa_tlx(const std::string& language) {
  const auto found = std::ranges::find(wordings, language, &Wording::language);
  const Wording& wording = found == wordings.end() ? wordings.front() : *found;
  Form form{"nasa_tlx", wording.title, wording.text, {}, {}};
  for (std::size_t i = 0; i < item_names.size(); ++i) {
    form.items.push_back(scale(wording, i));
  }
  return form;
}
}  // namespace tapstudy::protocols
