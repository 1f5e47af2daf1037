#pragma once
#include <string>
#include <utility>
#include <vector>

#include "core/model/model_cache.hpp"
#include "protocols/protocol.hpp"
#include "results/export/table.hpp"
namespace tapstudy::runner {
// What the stored answers of a block mean to those who gave them: stimuli and other answers by
// their labels, the ends of a line by their words. Empty where answers are plain numbers.
std::vector<std::pair<std::string, std::string>> response_meanings(
    const protocols::Block& block, const protocols::Protocol& protocol);

// All blocks', a row a response that has a meaning.
results::Table response_meanings_table(const protocols::Protocol& protocol);

// What a protocol says of a study, as tables of an export: stimuli (a column factor_NAME a factor),
// their modes, the items of questionnaires, and what answers mean.
struct StimulusTables {
  std::vector<results::Table> tables;
  // Vibrating stimuli of which no modes are listed, because no model of them is cached.
  std::vector<std::string> without_model;
};
// Nothing is computed: modes are of stimuli whose bodies are in the cache, those below the band
// limit, of a family those of its own member.
StimulusTables stimulus_tables(const protocols::Protocol& protocol, const core::ModelCache& cache);
}  // namespace tapstudy::runner
