#pragma once
#include <string>
#include <utility>
#include <vector>

#include "core/model/model_cache.hpp"
#include "protocols/protocol.hpp"
#include "results/export/table.hpp"
namespace tapstudy::runner {
// The meanings of the stored answers of a block to those who gave them: stimuli and other answers
// by their labels, the ends of a line by their words. Empty where answers are plain numbers.
std::vector<std::pair<std::string, std::string>> response_meanings(
    const protocols::Block& block, const protocols::Protocol& protocol);

// All blocks', a row a response that has a meaning.
results::Table response_meanings_table(const protocols::Protocol& protocol);

// The stimuli of a protocol as tables of an export: stimuli (a column factor_NAME a factor), their
// modes, the items of questionnaires, and the meanings of answers.
struct StimulusTables {
  std::vector<results::Table> tables;
  // Vibrating stimuli of which no modes are listed, because no model of them is cached.
  std::vector<std::string> without_model;
};
// Computes nothing: modes are listed for stimuli whose bodies are in the cache, up to the band
// limit; for a family, those of its own member.
StimulusTables stimulus_tables(const protocols::Protocol& protocol, const core::ModelCache& cache);
}  // namespace tapstudy::runner
