#pragma once
#include <set>
#include <string>
#include <vector>

#include "protocols/protocol.hpp"
#include "results/rows.hpp"
#include "runner/studies/stored_study.hpp"
namespace tapstudy::runner {
// The procedure of a study in sentences for a methods section, from its protocol, its sessions and
// the answers in its blocks: apparatus, rendering, blocks and their orders, requirements of an
// answer, blinding, masking, questionnaires. sessions, participants: those that are reported; at
// least one.
std::string describe_procedure(const protocols::Protocol& protocol,
                               const std::vector<results::SessionRow>& sessions,
                               const std::set<std::string>& participants, const DoneBlocks& done);
}  // namespace tapstudy::runner
