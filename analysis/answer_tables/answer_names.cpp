#include "analysis/answer_tables/answer_names.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>
#include <unordered_set>
#include <utility>

#include "analysis/answer_tables/answer_columns.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
std::string without_spaces(const std::string& text) {
  const auto first = text.find_first_not_of(' ');
  return first == std::string::npos ? ""
                                    : text.substr(first, text.find_last_not_of(' ') - first + 1);
}

// A misspelt name would be one more stimulus, or one more participant.
void check_differ(const std::set<std::string>& names, const std::string& file) {
  std::vector<std::pair<std::string, std::string>> known;  // without spaces, and as given
  for (const std::string& name : names) {
    const std::string bare = without_spaces(name);
    const auto other = std::ranges::find_if(
        known, [&](const auto& each) { return is_same_word(each.first, bare); });
    if (other != known.end()) {
      throw core::InvalidInput{fmt::format("{}: '{}' and '{}' differ only in case or spaces", file,
                                           other->second, name)};
    }
    known.emplace_back(bare, name);
  }
}
}  // namespace

std::set<std::string> distinct(const std::vector<results::AnswerRow>& answers,
                               std::string results::AnswerRow::*column) {
  std::unordered_set<std::string_view> found;
  std::string_view last;
  for (const results::AnswerRow& answer : answers) {
    if (found.empty() || answer.*column != last) {
      last = answer.*column;
      found.insert(last);
    }
  }
  return {found.begin(), found.end()};
}

void check_names(const std::vector<results::AnswerRow>& answers, const std::string& file,
                 const std::set<std::string>& stimuli, const std::set<std::string>& responses) {
  check_differ(responses, file);
  check_differ(distinct(answers, &results::AnswerRow::participant_id), file);
  if (std::ranges::none_of(answers, [&](const results::AnswerRow& answer) {
        return stimuli.contains(answer.response);
      })) {
    throw core::InvalidInput{
        fmt::format("{}: no answer names a stimulus (answers: '{}' and others; stimuli: {}): say "
                    "what answers stand for by --responses GIVEN=STIMULUS",
                    file, answers.front().response, fmt::join(stimuli, ", "))};
  }
}
}  // namespace tapstudy::analysis
