#pragma once
#include "analysis/blocks/design.hpp"
#include "protocols/protocol.hpp"
#include "results/rows.hpp"
namespace tapstudy::runner {
// The part of a protocol that a report of these participants needs.
analysis::StudyDesign design_of(const protocols::Protocol& protocol, results::Mode mode);
}  // namespace tapstudy::runner
