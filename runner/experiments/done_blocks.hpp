#pragma once
#include <map>
#include <set>
#include <string>
#include <vector>

#include "protocols/protocol.hpp"
#include "results/rows.hpp"
#include "runner/experiments/study_store.hpp"
namespace tapstudy::runner {
// What was done of each block by participants of a mode, of all stores together.
using DoneBlocks = std::map<std::string, results::BlockCourseRow>;
DoneBlocks done_blocks(const std::vector<StudyStore>& stores, results::Mode mode);
// Names of the stimuli that the device rendered in these blocks.
std::set<std::string> rendered_stimuli(const protocols::Protocol& protocol, const DoneBlocks& done);
}  // namespace tapstudy::runner
