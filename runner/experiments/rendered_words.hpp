#pragma once
#include <string>

#include "core/model/plate.hpp"
#include "protocols/protocol.hpp"
namespace tapstudy::runner {
// "600 × 600 × 50 mm", or "surface within ..." of any other shape.
std::string size_words(const core::Shape& shape);
// "2 × vertex on both faces", fixations that are alike taken together; "free" without any.
std::string fixation_words(const std::vector<core::Fixation>& fixations);
// "; touches table of 2.5e+09 Pa, 610 kg/m³ by 4 springs"; empty if it touches nothing.
std::string contact_words(const protocols::Protocol& protocol, const protocols::Stimulus& stimulus);
}  // namespace tapstudy::runner
