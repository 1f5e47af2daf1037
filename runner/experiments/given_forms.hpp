#pragma once
#include <vector>

#include "analysis/questionnaires/questionnaires_section.hpp"
#include "protocols/protocol.hpp"
#include "runner/experiments/study_store.hpp"
namespace tapstudy::runner {
// The forms of a protocol that are asked somewhere, by name, with the places in a session's order.
std::vector<analysis::Questionnaire> questionnaires_of(const protocols::Protocol& protocol);
// What participants of the mode answered; not those who were excluded.
std::vector<analysis::GivenAnswer> given_answers(const std::vector<StudyStore>& stores,
                                                 results::Mode mode);
}  // namespace tapstudy::runner
