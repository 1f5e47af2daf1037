#pragma once
#include <string>
#include <utility>
#include <vector>

#include "protocols/protocol.hpp"
#include "results/export/table.hpp"
namespace tapstudy::runner {
// What the stored answers of a block mean to those who gave them: stimuli and other answers by
// their labels, the ends of a line by their words. Empty where answers are plain numbers.
std::vector<std::pair<std::string, std::string>> response_meanings(
    const protocols::Block& block, const protocols::Protocol& protocol);

// All blocks', a row a response that has a meaning.
results::Table response_meanings_table(const protocols::Protocol& protocol);
}  // namespace tapstudy::runner
