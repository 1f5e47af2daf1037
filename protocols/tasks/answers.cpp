#include "protocols/tasks/answers.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "core/text/plain_text.hpp"
namespace tapstudy::protocols {
namespace {
constexpr std::size_t max_characters = 20;  // of a number

// "1,000" may be a thousand.
bool may_have_thousands(const std::string& text) {
  const auto comma = text.find(',');
  return comma != std::string::npos && comma <= 3 && text.size() == comma + 4 && text[0] != '0';
}

// Digits with at most one point or decimal comma: no sign, no exponent, no "inf".
std::optional<double> plain_number(const std::string& typed) {
  const std::string text = with_decimal_point(typed);
  if (text.size() > max_characters || text.find_first_not_of("0123456789.") != std::string::npos) {
    return std::nullopt;
  }
  return core::number_in<double>(text);
}

std::optional<std::string> number_above_0(const std::string& text) {
  const auto number = plain_number(text);
  return number && *number > 0.0 && std::isfinite(*number)
             ? std::optional{fmt::format("{}", *number)}
             : std::nullopt;
}

std::optional<std::string> mark_on_line(const std::string& text) {
  const auto mark = plain_number(text);
  return mark && *mark <= 1.0 ? std::optional{fmt::format("{}", *mark)} : std::nullopt;
}

// From 1.
std::optional<std::size_t> place_in(const std::string& text, std::size_t count) {
  const auto place = core::number_in<std::size_t>(text);
  return place && *place >= 1 && *place <= count ? place : std::nullopt;
}

std::optional<std::string> option_at(const std::string& text, const std::vector<Option>& options) {
  const auto place = place_in(text, options.size());
  return place ? std::optional{options[*place - 1].name} : std::nullopt;
}

std::vector<std::string> words_in(const std::string& text, const char* separators) {
  std::vector<std::string> words;
  for (auto from = text.find_first_not_of(separators); from != std::string::npos;) {
    const auto to = std::min(text.find_first_of(separators, from), text.size());
    words.push_back(text.substr(from, to - from));
    from = text.find_first_not_of(separators, to);
  }
  return words;
}

std::optional<std::string> order_of(const std::string& text, const std::vector<Option>& options) {
  std::vector<std::string> names;
  for (const std::string& word : words_in(text, " ,")) {
    const auto name = option_at(word, options);
    if (!name || std::ranges::find(names, *name) != names.end()) {
      return std::nullopt;
    }
    names.push_back(*name);
  }
  return names.size() == options.size() ? std::optional{fmt::format("{}", fmt::join(names, " "))}
                                        : std::nullopt;
}

std::optional<std::string> setting_at(const std::string& text, std::size_t settings) {
  const auto place = place_in(text, settings);
  return place ? std::optional{std::to_string(*place)} : std::nullopt;
}
}  // namespace

std::string with_decimal_point(std::string text) {
  if (!may_have_thousands(text)) {
    std::ranges::replace(text, ',', '.');
  }
  return text;
}

std::optional<std::string> option_of_key(const std::string& text, const Answers& answers) {
  const std::string key = core::lower_case(core::trimmed(text));
  const auto found = std::ranges::find(answers.keys, key);
  const auto option = static_cast<std::size_t>(found - answers.keys.begin());
  return found == answers.keys.end() || option >= answers.options.size()
             ? std::nullopt
             : std::optional{answers.options[option].name};
}

std::string key_of_option(std::size_t option, const Answers& answers) {
  return option < answers.keys.size() ? answers.keys[option] : std::to_string(option + 1);
}

std::optional<std::string> answer_in(const std::string& text, const Answers& answers) {
  const std::string word = core::trimmed(text);
  switch (answers.kind) {
    case AnswerKind::option: {
      const auto by_key = option_of_key(word, answers);
      return by_key ? by_key : option_at(word, answers.options);
    }
    case AnswerKind::number:
      return number_above_0(word);
    case AnswerKind::setting:
      return setting_at(word, answers.settings);
    case AnswerKind::order:
      return order_of(word, answers.options);
    case AnswerKind::line:
      return mark_on_line(word);
  }
  return std::nullopt;
}

std::string expected_answer(const Answers& answers) {
  switch (answers.kind) {
    case AnswerKind::option:
      return answers.keys.empty()
                 ? fmt::format("a number from 1 to {}", answers.options.size())
                 : fmt::format("one of the keys {}", fmt::join(answers.keys, ", "));
    case AnswerKind::number:
      return fmt::format("a number above 0, such as 12 or 0.5, of at most {} characters",
                         max_characters);
    case AnswerKind::setting:
      return fmt::format("a number from 1 to {}", answers.settings);
    case AnswerKind::order:
      return fmt::format("all numbers from 1 to {} in order, with spaces between",
                         answers.options.size());
    case AnswerKind::line:
      return fmt::format("a number from 0 ({}) to 1 ({})", answers.ends.low, answers.ends.high);
  }
  return {};
}

std::vector<std::string> names_in_order(const std::string& answer) {
  return words_in(answer, " ");
}

std::string label_of_answer(const std::string& answer, const Answers& answers) {
  const auto label = [&](const std::string& name) {
    const auto option = std::ranges::find(answers.options, name, &Option::name);
    return option == answers.options.end() ? name : option->label;
  };
  if (answers.kind != AnswerKind::order) {
    return label(answer);
  }
  std::vector<std::string> labels;
  std::ranges::transform(names_in_order(answer), std::back_inserter(labels), label);
  return fmt::format("{}", fmt::join(labels, " "));
}
}  // namespace tapstudy::protocols
