#pragma once
#include "analysis/blocks/design.hpp"
#include "protocols/protocol.hpp"
namespace tapstudy::runner {
// The part of a protocol that a report needs.
analysis::StudyDesign design_of(const protocols::Protocol& protocol);
}  // namespace tapstudy::runner
