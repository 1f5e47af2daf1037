#pragma once
#include <string>
namespace tapstudy::analysis {
// A figure as a PDF of one page of the figure's size, with its text as text. Throws InvalidInput if
// it is not SVG.
std::string pdf_of_svg(const std::string& svg);
}  // namespace tapstudy::analysis
