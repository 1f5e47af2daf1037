#pragma once
#include <optional>
#include <string>

#include "runner/participants/participant.hpp"
namespace tapstudy::runner {
// What a person at the terminal types in a trial.
std::string upper_case_without_spaces(const std::string& line);

// An answer as the trial takes it: "= B" where people see labels to switch among and choose one of
// them, "=" where they set one, as it is set; else what protocols::answer_in takes.
std::optional<std::string> answer_typed(const std::string& line, const TrialPrompt& prompt,
                                        const Exploration& exploration);

// "+++" is 3 settings up, "-" one down.
std::optional<int> settings_moved(const std::string& line);

// How answers are given, to follow the labels that can be felt; and the same where what was typed
// is none.
std::string how_to_answer(const TrialPrompt& prompt);
std::string expected_among_alternatives(const TrialPrompt& prompt);
}  // namespace tapstudy::runner
