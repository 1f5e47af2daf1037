#pragma once
#include "core/haptics/haptic_state.hpp"
namespace tapstudy::protocols {
// Whether a triangle's corners lie on one line, or two of them in one point, but for rounding.
bool has_no_area(const core::Vec3& a, const core::Vec3& b, const core::Vec3& c);
// Whether a corner lies on the opposite side, but for rounding to single precision. A needle is not
// flat: its shortest side is as short as it is high.
bool is_flat_cap(const core::Vec3& a, const core::Vec3& b, const core::Vec3& c);
}  // namespace tapstudy::protocols
