#include "runner/participants/typed_answers.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
namespace tapstudy::runner {
namespace {
// "= B", or "= 3" for an option that is none of the alternatives.
std::optional<std::string> option_after_equals(const std::string& word,
                                               const protocols::Answers& answers) {
  if (!word.starts_with('=')) {
    return std::nullopt;
  }
  const auto& options = answers.options;
  const auto option = std::ranges::find(options, word.substr(1), &protocols::Option::label);
  return option == options.end() ? answer_in(word.substr(1), answers) : std::optional{option->name};
}

std::string further_options(const TrialPrompt& prompt) {
  std::string all;
  for (std::size_t i = prompt.alternative_labels.size(); i < prompt.answers.options.size(); ++i) {
    all += fmt::format("   = {}: {}.", i + 1, prompt.answers.options[i].label);
  }
  return all;
}

// "= C A B": labels of alternatives are single letters.
std::optional<std::string> order_after_equals(const std::string& word,
                                              const protocols::Answers& answers) {
  if (!word.starts_with('=')) {
    return std::nullopt;
  }
  std::string places;
  for (const char letter : word.substr(1)) {
    const auto option =
        std::ranges::find(answers.options, std::string{letter}, &protocols::Option::label);
    places += fmt::format("{} ", option - answers.options.begin() + 1);
  }
  return answer_in(places, answers);
}

bool is_order(const TrialPrompt& prompt) {
  return prompt.answers.kind == protocols::AnswerKind::order;
}

std::optional<std::string> labels_after_equals(const std::string& word,
                                               const protocols::Answers& answers) {
  return answers.kind == protocols::AnswerKind::order ? order_after_equals(word, answers)
                                                      : option_after_equals(word, answers);
}
}  // namespace

std::string upper_case_without_spaces(const std::string& line) {
  std::string word;
  for (const char c : line) {
    if (std::isspace(static_cast<unsigned char>(c)) == 0) {
      word += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    }
  }
  return word;
}

std::optional<std::string> answer_typed(const std::string& line, const TrialPrompt& prompt,
                                        const Exploration& exploration) {
  if (prompt.answers.settings > 0) {
    return upper_case_without_spaces(line) == "="
               ? std::optional{fmt::format("{}", exploration.setting() + 1)}
               : std::nullopt;
  }
  return prompt.answers_name_alternatives()
             ? labels_after_equals(upper_case_without_spaces(line), prompt.answers)
             : answer_in(line, prompt.answers);
}

std::optional<int> settings_moved(const std::string& line) {
  const std::string word = upper_case_without_spaces(line);
  const bool is_up = word.find_first_not_of('+') == std::string::npos;
  const bool is_down = word.find_first_not_of('-') == std::string::npos;
  return word.empty() || !(is_up || is_down)
             ? std::nullopt
             : std::optional{(is_up ? 1 : -1) * static_cast<int>(word.size())};
}

std::string how_to_answer(const TrialPrompt& prompt) {
  if (prompt.answers.settings > 0) {
    return fmt::format("   + or -: change {}, ++ by more.   =: it is set.",
                       prompt.alternative_labels.back());
  }
  if (!prompt.answers_name_alternatives()) {
    return "";
  }
  return is_order(prompt)
             ? fmt::format("   = {}: your order, the first one first.",
                           fmt::join(prompt.alternative_labels, " "))
             : fmt::format("   = {}: choose it.{}", prompt.answers.options.front().label,
                           further_options(prompt));
}

std::string expected_among_alternatives(const TrialPrompt& prompt) {
  if (prompt.answers.settings > 0) {
    return fmt::format("+ or - to change {}, = when it is set", prompt.alternative_labels.back());
  }
  if (!prompt.answers_name_alternatives()) {
    return expected_answer(prompt.answers) + " to answer";
  }
  return is_order(prompt) ? "= and all labels in order" : "= and a label to choose it";
}
}  // namespace tapstudy::runner
