#pragma once
#include "analysis/blocks/design.hpp"
#include "protocols/protocol.hpp"
namespace tapstudy::runner {
// What a report needs to know of a protocol.
analysis::StudyDesign design_of(const protocols::Protocol& protocol);
}  // namespace tapstudy::runner
