#pragma once
#include <string>
namespace tapstudy::analysis {
// A text as gnuplot takes it, whatever is in it.
std::string quoted(const std::string& text);

// Runs a script, whose output goes to the new file. Throws InvalidInput if the file exists already
// or cannot be written, or if there is no gnuplot.
void draw_with_gnuplot(const std::string& script, const std::string& file);
}  // namespace tapstudy::analysis
