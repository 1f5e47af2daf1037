#pragma once
#include <string>
#include <vector>
namespace tapstudy::analysis {
// A figure as a PDF of one page of the figure's size, with its text as text. Throws InvalidInput if
// it is not SVG.
std::string pdf_of_svg(const std::string& svg);
// The same as a PNG, so many pixels wide, 8 bits a colour, what is empty black. Throws likewise.
std::string png_of_svg(const std::string& svg, int width);

// PNG files of one size and format as an animation (PNG, third edition, W3C 2025: chunks acTL,
// fcTL, fdAT), each shown for so many milliseconds, over and over. What reads no animations shows
// the first. Throws InvalidInput for no frames, and for what is no PNG or not of the first one's
// format.
std::string animated_png(const std::vector<std::string>& frames, unsigned milliseconds_each);
}  // namespace tapstudy::analysis
