#pragma once
#include <vector>

#include "protocols/protocol.hpp"
#include "results/rows.hpp"
namespace tapstudy::runner {
// Fills in each answer's place in its block, from the seed and index of its participant's session.
void set_places(const protocols::Protocol& protocol,
                const std::vector<results::SessionRow>& sessions,
                std::vector<results::AnswerRow>& answers);
}  // namespace tapstudy::runner
