#pragma once
#include <string>
namespace tapstudy::analysis {
// Arbitrary text, quoted and escaped for gnuplot.
std::string quoted(const std::string& text);

// Runs a script that writes the new file. Throws InvalidInput if the file already exists or cannot
// be written, or if gnuplot is not available.
void draw_with_gnuplot(const std::string& script, const std::string& file);
}  // namespace tapstudy::analysis
