#include "analysis/report/answer_tables/column_words.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <utility>

#include "analysis/report/answer_tables/answer_checks.hpp"
#include "analysis/report/answer_tables/foreign_text.hpp"
#include "core/text/plain_text.hpp"
namespace tapstudy::analysis {
namespace {
// Of a word; most are plain, and reading them as people do takes a hundred times longer.
std::string folded(const std::string& word) {
  const auto is_plain = [](char c) { return static_cast<unsigned char>(c) < 0x80; };
  return std::ranges::all_of(word, is_plain) ? core::lower_case(word) : as_read(word);
}
}  // namespace

std::vector<std::string> words_of_name(const std::string& name) {
  std::vector<std::string> words;
  std::string word;
  const auto end_word = [&] {
    if (!word.empty()) {
      words.push_back(folded(word));
      word.clear();
    }
  };
  bool was_small = false;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_of_word = byte >= 0x80 || std::isalnum(byte) != 0;
    if (!is_of_word || (was_small && std::isupper(byte) != 0)) {
      end_word();
    }
    if (is_of_word) {
      word += c;
    }
    was_small = std::islower(byte) != 0;
  }
  end_word();
  return words;
}

bool has_word(const std::string& name, Words known) {
  return std::ranges::any_of(words_of_name(name), [&](const std::string& word) {
    return std::ranges::find(known, word) != known.end();
  });
}

namespace {
bool begins_with_any(const std::string& word, Words stems) {
  return std::ranges::any_of(stems, [&](std::string_view stem) { return word.starts_with(stem); });
}
}  // namespace

bool has_word_beginning(const std::string& name, Words stems) {
  return std::ranges::any_of(words_of_name(name),
                             [&](const std::string& word) { return begins_with_any(word, stems); });
}

bool tells_runs(const std::string& name) {
  constexpr std::array<std::string_view, 16> known{
      "session", "sessionid", "sitzung",   "run",       "runid",   "visit",     "day",    "tag",
      "date",    "datum",     "startdate", "timestamp", "logfile", "recording", "result", "fecha"};
  return has_word(name, known);
}

bool looks_like_date(const std::string& cell) {
  std::vector<std::size_t> lengths;  // of groups of digits that '-', '.' or '/' join, at the start
  std::size_t digits = 0;
  for (const char c : cell + " ") {
    if (std::isdigit(static_cast<unsigned char>(c)) != 0) {
      ++digits;
      continue;
    }
    lengths.push_back(std::exchange(digits, 0));
    if (c != '-' && c != '.' && c != '/') {
      break;
    }
  }
  constexpr std::size_t parts = 3;
  const auto is_short = [](std::size_t length) { return length == 1 || length == 2; };
  return lengths.size() == parts && is_short(lengths[1]) &&
         ((lengths[0] == 4 && is_short(lengths[2])) ||
          (is_short(lengths[0]) && (lengths[2] == 4 || lengths[2] == 2)));
}

namespace {
// In the languages of the tables that are known.
constexpr std::array<std::string_view, 34> practice_stems{
    "practi",   "prácti",   "práti",      "prati",      "train",    "entrain", "entraîn",
    "entren",   "warmup",   "familiaris", "familiariz", "tutorial", "demo",    "übung",
    "uebung",   "einübung", "probelauf",  "probedurch", "oefen",    "esercit", "allenam",
    "treino",   "övning",   "øvelse",     "øving",      "harjoit",  "trening", "ćwicz",
    "трениров", "упражн",   "練習",       "练习",       "連習",     "연습"};
constexpr std::array<std::string_view, 10> uncounted_stems{
    "exclu", "ausgeschl", "reject", "discard", "invalid",
    "catch", "attention", "filler", "dummy",   "outlier"};
constexpr std::array<std::string_view, 8> counted_stems{"includ", "inclus", "valid",  "keep",
                                                        "usable", "accept", "finish", "complet"};
// What became of somebody, as Prolific, Gorilla and others say it in a column of states.
constexpr std::array<std::string_view, 11> left_stems{"return",  "timed",  "timeout", "live",
                                                      "incompl", "unfini", "partial", "abando",
                                                      "abort",   "withd",  "cancel"};

bool is_practice_word(const std::string& word) {
  return word == "prac" || begins_with_any(word, practice_stems);
}

// A cell that is one of the words, or begins with one.
bool is_called_uncounted(const std::string& cell) {
  const std::vector<std::string> words = words_of_name(cell);
  if (words.empty()) {
    return false;
  }
  const auto begins = [&](std::string_view first, std::string_view second) {
    return words.size() > 1 && words[0] == first && words[1] == second;
  };
  const bool is_of_survey =
      words.size() == 2 && (begins("survey", "preview") || begins("survey", "test"));
  return is_practice_word(words.front()) || begins("warm", "up") || is_of_survey ||
         (words.size() <= 2 && begins_with_any(words.front(), uncounted_stems));
}
}  // namespace

bool is_of_states(const std::string& column) {
  constexpr std::array<std::string_view, 3> known{"status", "state", "submitdate"};
  return has_word(column, known);
}

namespace {
// A survey that LimeSurvey's participant did not send has no such date.
bool says_left(const std::string& column, const std::string& cell) {
  const std::vector<std::string> words = words_of_name(cell);
  return is_of_states(column) &&
         (words.empty() ? words_of_name(column) == std::vector<std::string>{"submitdate"}
                        : begins_with_any(words.front(), left_stems));
}
}  // namespace

bool says_uncounted(const std::string& column, const std::string& cell) {
  const std::vector<std::string> words = words_of_name(column);
  const bool is_of_practice = std::ranges::any_of(words, is_practice_word);
  if (is_of_practice && column.ends_with(".thisN")) {
    return !cell.empty();
  }
  const bool is_of_uncounted = has_word_beginning(column, uncounted_stems);
  const bool is_of_counted = has_word_beginning(column, counted_stems);
  const std::optional<bool> yes = right_or_wrong(cell);
  return is_called_uncounted(cell) || says_left(column, cell) ||
         ((is_of_practice || is_of_uncounted) && yes == true) ||
         (is_of_counted && !is_of_uncounted && yes == false);
}
}  // namespace tapstudy::analysis
