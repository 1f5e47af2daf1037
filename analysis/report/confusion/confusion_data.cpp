#include "analysis/report/confusion/confusion_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <unordered_map>

#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
using results::AnswerRow;

void check_correctness(const BlockDesign& design, const Item& stimulus, const AnswerRow& answer) {
  if (!answer.is_correct) {
    throw core::InvalidInput{
        fmt::format("block '{}': the answer of {} to trial {} is neither right nor wrong",
                    design.name, answer.participant_id, answer.number)};
  }
  if (*answer.is_correct != stimulus.is_answered_by(answer.response)) {
    throw core::InvalidInput{fmt::format(
        "block '{}': the answer of {} to trial {} is stored as {}, which a confusion matrix of "
        "'{}' answered '{}' contradicts",
        design.name, answer.participant_id, answer.number,
        *answer.is_correct ? "correct" : "incorrect", answer.stimulus, answer.response)};
  }
}

class Places {
 public:
  Places(const std::vector<Item>& items, const char* kind) : kind_{kind} {
    for (std::size_t i = 0; i < items.size(); ++i) {
      place_of_.emplace(items[i].name, i);
    }
  }
  std::size_t of(const std::string& name) const {
    const auto found = place_of_.find(name);
    if (found == place_of_.end()) {
      throw core::InvalidInput{fmt::format("{} '{}' is not part of this matrix", kind_, name)};
    }
    return found->second;
  }

 private:
  const char* kind_;
  std::unordered_map<std::string, std::size_t> place_of_;
};

std::optional<double> known(double time_s) {
  return std::isnan(time_s) ? std::nullopt : std::optional{time_s};
}

// Rows in the order of time.
std::vector<const AnswerRow*> in_time(const std::vector<AnswerRow>& answers) {
  std::vector<const AnswerRow*> rows;
  rows.reserve(answers.size());
  for (const AnswerRow& answer : answers) {
    rows.push_back(&answer);
  }
  const auto trial_id = [](const AnswerRow* row) { return row->trial_id; };
  if (!std::ranges::is_sorted(rows, {}, trial_id)) {
    std::ranges::stable_sort(rows, {}, trial_id);
  }
  return rows;
}
}  // namespace

IdentificationData identification_data(const BlockDesign& design,
                                       const std::vector<AnswerRow>& answers) {
  IdentificationData data{design.stimuli, design.responses, {}};
  const Places stimuli{data.stimuli, "stimulus"};
  const Places responses{data.responses, "response"};
  std::unordered_map<std::string, std::size_t> place_of_person;
  for (const AnswerRow& answer : answers) {
    if (place_of_person.try_emplace(answer.participant_id, data.participants.size()).second) {
      data.participants.push_back(
          {answer.participant_id, {answer.participant_index, answer.order_index}, {}});
    }
  }
  for (const AnswerRow* row : in_time(answers)) {
    const AnswerRow& answer = *row;
    const std::size_t stimulus = stimuli.of(answer.stimulus);
    check_correctness(design, data.stimuli[stimulus], answer);
    data.participants[place_of_person.at(answer.participant_id)].trials.push_back(
        {stimulus, responses.of(answer.response), *answer.is_correct,
         static_cast<std::size_t>(answer.place_in_block), answer.repetition,
         known(answer.response_time_s), answer.time_from_first_contact_s, answer.impacts,
         answer.mean_impact_speed_m_s, answer.contact_s});
  }
  return data;
}

CountTable counts_of(const IdentificationData& data, const IdentifyingParticipant& participant) {
  CountTable counts(data.stimuli.size(), std::vector<std::int64_t>(data.responses.size(), 0));
  for (const IdentifiedTrial& trial : participant.trials) {
    ++counts[trial.stimulus][trial.response];
  }
  return counts;
}

std::vector<CountTable> tables_of(const std::vector<ParticipantCounts>& participants) {
  std::vector<CountTable> tables;
  std::ranges::transform(participants, std::back_inserter(tables), &ParticipantCounts::counts);
  return tables;
}

std::optional<CountTable> by_right_response(const std::vector<Item>& stimuli,
                                            const std::vector<Item>& responses,
                                            const CountTable& counts) {
  CountTable square(responses.size(), std::vector<std::int64_t>(responses.size(), 0));
  for (std::size_t i = 0; i < stimuli.size(); ++i) {
    const auto right = std::ranges::find_if(
        responses, [&](const Item& response) { return stimuli[i].is_answered_by(response.name); });
    if (right == responses.end()) {
      return std::nullopt;
    }
    auto& row = square[static_cast<std::size_t>(right - responses.begin())];
    std::ranges::transform(row, counts[i], row.begin(), std::plus{});
  }
  return square;
}

std::optional<LevelCounts> by_level(const ConfusionMatrix& matrix, const std::string& factor) {
  LevelCounts by;
  const auto place = [&](const Item& item) {
    const auto level = item.factors.find(factor);
    const auto found =
        level == item.factors.end() ? by.levels.end() : std::ranges::find(by.levels, level->second);
    return static_cast<std::size_t>(found - by.levels.begin());
  };
  for (const Item& stimulus : matrix.stimuli) {
    const auto level = stimulus.factors.find(factor);
    if (level != stimulus.factors.end() && place(stimulus) == by.levels.size()) {
      by.levels.push_back(level->second);
    }
  }
  by.counts.assign(by.levels.size(), std::vector<std::int64_t>(by.levels.size(), 0));
  for (std::size_t i = 0; i < matrix.stimuli.size(); ++i) {
    for (std::size_t j = 0; j < matrix.responses.size(); ++j) {
      const std::size_t row = place(matrix.stimuli[i]);
      const std::size_t column = place(matrix.responses[j]);
      if (row == by.levels.size() || column == by.levels.size()) {
        return std::nullopt;
      }
      by.counts[row][column] += matrix.counts[i][j];
    }
  }
  return by;
}
}  // namespace tapstudy::analysis
