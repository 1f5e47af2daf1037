#pragma once
#include "protocols/protocol.hpp"
#include "results/rows.hpp"
namespace tapstudy::runner {
// The protocol of a study, from its store alone: the files named by it may no longer exist. Throws
// InvalidInput where it cannot be read.
protocols::Protocol stored_protocol(const results::StudyRow& study);
}  // namespace tapstudy::runner
