#include "runner/session/operators/operator.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <vector>

#include "core/error.hpp"
#include "core/text/plain_text.hpp"
namespace tapstudy::runner {
namespace {
using enum OperatorAction;
constexpr std::array<ActionInfo, 10> actions{
    {{pause, "pause", ActionText::optional,
      "take the force away; the running trial is presented again"},
     {resume, "resume", ActionText::none, "go on after a pause"},
     {repeat, "repeat", ActionText::optional, "present the running trial again"},
     {skip, "skip", ActionText::optional,
      "end the running trial without an answer; where a procedure chooses levels, it comes again "
      "at the end of the block"},
     {correct, "correct", ActionText::required,
      "ANSWER: the last answer was option N, or that number; the first one stays in the store"},
     {switch_to, "switch", ActionText::required, "N: render alternative N of the running trial"},
     {note, "note", ActionText::required, "TEXT: store a remark with its time"},
     {end, "end", ActionText::required, "REASON: end the session; all answers are kept"},
     {exclude, "exclude", ActionText::required, "REASON: keep this participant out of reports"},
     {include, "include", ActionText::optional, "take back an exclusion"}}};
constexpr std::size_t max_text = 2000;

// "@4" at the beginning, taken away.
std::optional<int> taken_trial(std::string& text) {
  int number = 0;
  const char* const begin = text.data() + 1;
  const char* const end = text.data() + text.size();
  if (!text.starts_with('@')) {
    return std::nullopt;
  }
  const auto [stopped, error] = std::from_chars(begin, end, number);
  if (error != std::errc{} || (stopped != end && *stopped != ' ')) {
    return std::nullopt;
  }
  text = core::trimmed(std::string{stopped, end});
  return number;
}
}  // namespace

std::span<const ActionInfo> operator_actions() {
  return actions;
}

std::string_view name(OperatorAction action) {
  return std::ranges::find(actions, action, &ActionInfo::action)->name;
}

OperatorCommand parse_operator_command(const std::string& line,
                                       std::span<const OperatorAction> offered) {
  const std::string command = core::trimmed(line);
  const std::string word = command.substr(0, command.find_first_of(" \t"));
  const auto found = std::ranges::find(actions, word, &ActionInfo::name);
  if (found == actions.end()) {
    std::vector<std::string_view> names;
    for (const ActionInfo& info : actions) {
      if (offered.empty() || std::ranges::find(offered, info.action) != offered.end()) {
        names.push_back(info.name);
      }
    }
    throw core::InvalidInput{
        fmt::format("'{}' is not a command (one of: {})", word, fmt::join(names, ", "))};
  }
  std::string text = core::trimmed(command.substr(word.size()));
  const std::optional<int> trial = taken_trial(text);
  if (text.empty() && found->text == ActionText::required) {
    throw core::InvalidInput{fmt::format("{} {}", found->name, found->help)};
  }
  if (!text.empty() && found->text == ActionText::none) {
    throw core::InvalidInput{fmt::format("{} takes no argument", found->name)};
  }
  if (!core::is_plain_text(text)) {
    throw core::InvalidInput{"must be UTF-8 text without control characters"};
  }
  if (core::character_count(text) > max_text) {
    throw core::InvalidInput{fmt::format("at most {} characters", max_text)};
  }
  return {found->action, std::move(text), trial};
}
}  // namespace tapstudy::runner
