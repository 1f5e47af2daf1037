#include "analysis/report/answer_tables/answer_checks.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "analysis/report/answer_tables/foreign_text.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
using results::AnswerRow;

// The first of the names that read alike, by any of them.
class Renaming {
 public:
  void rename(std::string& name) {
    const auto known = names_.find(name);
    if (known != names_.end()) {
      name = known->second;
      return;
    }
    const std::string& first = spellings_.first_like(name);
    if (first != name) {
      merged.push_back(fmt::format("'{}' is read as '{}'", name, first));
    }
    names_.emplace(name, first);
    name = first;
  }
  std::vector<std::string> merged;

 private:
  std::unordered_map<std::string, std::string> names_;
  Spellings spellings_;
};

double percent_right(const std::vector<bool>& right) {
  return 100.0 * static_cast<double>(std::ranges::count(right, true)) /
         static_cast<double>(right.size());
}

struct Run {
  std::string description;
  std::size_t answers{};
};
using Runs = std::vector<Run>;  // of one participant

void count_run(Runs& runs, const std::string& description) {
  auto found = std::ranges::find(runs, description, &Run::description);
  if (found == runs.end()) {
    found = runs.insert(runs.end(), {description, 0});
  }
  ++found->answers;
}

// A column with another value in each row tells answers apart, not runs.
bool are_runs(const Runs& runs) {
  std::size_t answers = 0;
  for (const Run& run : runs) {
    answers += run.answers;
  }
  return runs.size() > 1 && 2 * runs.size() <= answers;
}

std::string described(const Runs& runs) {
  constexpr std::size_t max_described = 4;
  std::vector<std::string> parts;
  for (const Run& run : runs) {
    if (parts.size() == max_described) {
      parts.emplace_back("…");
      break;
    }
    parts.push_back(fmt::format("{} ({} answers)", run.description, run.answers));
  }
  return fmt::format("{}", fmt::join(parts, "; "));
}
}  // namespace

std::optional<bool> right_or_wrong(const std::string& cell) {
  constexpr std::array right{"1", "1.0", "true", "t", "yes", "y", "right", "correct", "hit"};
  constexpr std::array wrong{"0", "0.0", "false", "f", "no", "n", "wrong", "incorrect", "miss"};
  const auto is_one_of = [&](const auto& words) {
    return std::ranges::any_of(words, [&](const char* word) { return is_same_word(cell, word); });
  };
  return is_one_of(right)   ? std::optional{true}
         : is_one_of(wrong) ? std::optional{false}
                            : std::nullopt;
}

std::string to_text(const AnswerOrigin& origin) {
  return origin.csv->text.place(origin.csv->file, origin.row->line);
}

std::vector<std::string> merge_alike(std::vector<AnswerRow>& answers,
                                     std::map<std::string, std::string>& responses) {
  Renaming labels;
  Renaming people;
  for (AnswerRow& answer : answers) {
    people.rename(answer.participant_id);
    labels.rename(answer.stimulus);
  }
  for (AnswerRow& answer : answers) {
    labels.rename(answer.response);
    answer.is_correct = answer.response == answer.stimulus;
  }
  for (auto& [given, meaning] : responses) {
    labels.rename(meaning);
  }
  std::ranges::move(people.merged, std::back_inserter(labels.merged));
  return labels.merged;
}

void check_right_answers(const std::vector<AnswerRow>& answers, const AnswerOrigins& origins) {
  std::vector<bool> said;
  std::vector<bool> named;
  std::optional<std::size_t> differs;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    if (!origins[i].is_said_right) {
      continue;
    }
    said.push_back(*origins[i].is_said_right);
    named.push_back(*answers[i].is_correct);
    if (said.back() != named.back() && !differs) {
      differs = i;
    }
  }
  if (differs) {
    throw core::InvalidInput{
        fmt::format("{}: by the file's own column {:.0f} % of {} answers are right, by the names "
                    "of stimuli and "
                    "answers {:.0f} % (here '{}' was presented, '{}' answered, and it says {}): "
                    "say what answers "
                    "stand for by --responses GIVEN=STIMULUS, or --correct-column none",
                    to_text(origins[*differs]), percent_right(said), said.size(),
                    percent_right(named), answers[*differs].stimulus, answers[*differs].response,
                    *origins[*differs].is_said_right ? "right" : "wrong")};
  }
}

std::vector<std::string> several_runs(const std::vector<AnswerRow>& answers,
                                      const AnswerOrigins& origins, bool pools_runs) {
  std::map<std::string, Runs> runs_of;
  const bool are_several_files = std::ranges::any_of(
      origins, [&](const AnswerOrigin& origin) { return origin.csv != origins.front().csv; });
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const AnswerOrigin& origin = origins[i];
    const std::string file = are_several_files ? origin.csv->file : "";
    count_run(runs_of[answers[i].participant_id],
              file + (file.empty() || origin.run.empty() ? "" : ": ") + origin.run);
  }
  std::vector<std::string> found;
  for (const auto& [participant, runs] : runs_of) {
    if (!are_runs(runs)) {
      continue;
    }
    found.push_back(participant);
    if (!pools_runs) {
      throw core::InvalidInput{fmt::format(
          "participant '{}' took part {} times: {}: leave all but one out (its file, or "
          "--where COLUMN=VALUE), or pool them by --pool-runs",
          participant, runs.size(), described(runs))};
    }
  }
  return found;
}

}  // namespace tapstudy::analysis
