#pragma once
#include <string>
namespace tapstudy::analysis {
// A figure as a PDF of one page of the figure's size, with its text as text. Throws InvalidInput if
// it is not SVG.
std::string pdf_of_svg(const std::string& svg);
// The same as a PNG, so many pixels wide, 8 bits a colour, what is empty black. Throws likewise.
std::string png_of_svg(const std::string& svg, int width);
// "data:image/png;base64,…", to be embedded in a page.
std::string png_data_uri(const std::string& png);
}  // namespace tapstudy::analysis
