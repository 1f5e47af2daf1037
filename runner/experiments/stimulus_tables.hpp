#pragma once
#include <string>
#include <vector>

#include "core/model/model_cache.hpp"
#include "protocols/protocol.hpp"
#include "results/export/table.hpp"
namespace tapstudy::runner {
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
