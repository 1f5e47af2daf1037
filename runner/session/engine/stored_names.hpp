#pragma once
#include <string>
#include <vector>

#include "protocols/protocol.hpp"
#include "results/store/store.hpp"
namespace tapstudy::runner {
// What rows of a store name that the protocol, or the order of their session, lacks: blocks and
// their tasks, groups, stimuli, axes, questionnaires and their items. A sentence for each name.
std::vector<std::string> unknown_names(results::Store& store, const protocols::Protocol& protocol);

// For whoever reads a store by its protocol. Throws StoreError with the first of these sentences.
void check_names(results::Store& store, const protocols::Protocol& protocol);
}  // namespace tapstudy::runner
