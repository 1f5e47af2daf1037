#pragma once
#include <string>
#include <vector>

#include "protocols/protocol.hpp"
#include "results/rows.hpp"
namespace tapstudy::runner {
// How a study was run, as its protocol and its sessions say, in sentences for a methods section:
// apparatus, rendering, blocks and their orders, what an answer took, blinding, masking.
// sessions: those that are reported; at least one.
std::string procedure_words(const protocols::Protocol& protocol,
                            const std::vector<results::SessionRow>& sessions);
}  // namespace tapstudy::runner
