#pragma once
#include <string>

#include "core/model/plate.hpp"
namespace tapstudy::runner {
// "600 × 600 × 50 mm", or "surface within ..." of any other shape.
std::string size_words(const core::Shape& shape);
// "2 × vertex on both faces", fixations that are alike taken together; "free" without any.
std::string fixation_words(const std::vector<core::Fixation>& fixations);
}  // namespace tapstudy::runner
