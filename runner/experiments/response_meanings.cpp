#include "runner/experiments/response_meanings.hpp"

#include "protocols/tasks/task.hpp"
#include "results/export/columns.hpp"
namespace tapstudy::runner {
namespace {
using protocols::AnswerKind;

// Blind labels are not: what they stood for in the trial is stored.
std::vector<protocols::Option> stored_as_given(const protocols::Answers& answers,
                                               const protocols::Block& block) {
  const auto trials = block.task->trials(block, {});
  if (answers.kind != AnswerKind::option || trials.empty()) {
    return {};
  }
  std::vector<protocols::Option> options = answers.options;
  std::erase_if(options, [&](const protocols::Option& option) {
    return block.task->response(trials.front(), block, option.name) != option.name;
  });
  return options;
}
}  // namespace

std::vector<std::pair<std::string, std::string>> response_meanings(
    const protocols::Block& block, const protocols::Protocol& protocol) {
  const protocols::Answers answers = block.task->answers(block, protocol);
  if (answers.kind == AnswerKind::line) {
    return {{"0", answers.ends.low}, {"1", answers.ends.high}};
  }
  if (answers.kind == AnswerKind::number || answers.kind == AnswerKind::setting) {
    return {};
  }
  std::vector<std::pair<std::string, std::string>> meanings;
  for (const protocols::Option& option : stored_as_given(answers, block)) {
    meanings.emplace_back(option.name, option.label);
  }
  if (meanings.size() < answers.options.size()) {
    for (const std::string& stimulus : protocols::all_presented(block)) {
      meanings.emplace_back(stimulus, protocol.stimulus(stimulus).label);
    }
  }
  return meanings;
}

results::Table response_meanings_table(const protocols::Protocol& protocol) {
  std::vector<results::Row> rows;
  for (const protocols::Block& block : protocol.blocks) {
    for (const auto& [response, meaning] : response_meanings(block, protocol)) {
      rows.push_back({block.name, response, meaning});
    }
  }
  return results::table_of(
      "response_meanings", "A row an answer of a block that has a meaning of its own.",
      results::known_columns("block response response_meaning"), std::move(rows));
}
}  // namespace tapstudy::runner
