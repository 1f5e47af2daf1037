#pragma once
#include <set>
#include <string>
#include <vector>

#include "protocols/protocol.hpp"
#include "results/rows.hpp"
#include "runner/studies/stored_study.hpp"
namespace tapstudy::runner {
// How a study was run, as its protocol, its sessions and what was done of its blocks say, in
// sentences for a methods section: apparatus, rendering, blocks and their orders, what an answer
// took, blinding, masking, questionnaires. sessions, participants: those that are reported; at
// least one.
std::string procedure_words(const protocols::Protocol& protocol,
                            const std::vector<results::SessionRow>& sessions,
                            const std::set<std::string>& participants, const DoneBlocks& done);
}  // namespace tapstudy::runner
