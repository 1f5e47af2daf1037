#pragma once
#include <memory>

#include "protocols/rig.hpp"
#include "runner/markers/marker_output.hpp"
namespace tapstudy::runner {
// Open Sound Control over UDP: see README.md. Throws InvalidInput if the host's name means nothing;
// it is looked up now, and never again.
std::unique_ptr<MarkerOutput> open_osc_markers(const protocols::OscTarget& target);
}  // namespace tapstudy::runner
