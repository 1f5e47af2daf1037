#pragma once
#include <string>
#include <vector>
namespace tapstudy::analysis {
// PNG files of one size and format as an animation (PNG, third edition, W3C 2025: chunks acTL,
// fcTL, fdAT), each shown for so many milliseconds, over and over. What reads no animations shows
// the first. Throws InvalidInput for no frames, and for what is no PNG or not of the first one's
// format.
std::string animated_png(const std::vector<std::string>& frames, unsigned milliseconds_each);
}  // namespace tapstudy::analysis
