#pragma once
#include <vector>

#include "analysis/tables/sections.hpp"
#include "protocols/protocol.hpp"
#include "runner/experiments/done_blocks.hpp"
#include "runner/experiments/study_store.hpp"
namespace tapstudy::runner {
// What a report says of a study besides the results of its blocks, of the participants of one mode.
std::vector<analysis::ReportSection> study_sections(const protocols::Protocol& protocol,
                                                    const std::vector<StudyStore>& stores,
                                                    results::Mode mode, const DoneBlocks& done);
}  // namespace tapstudy::runner
