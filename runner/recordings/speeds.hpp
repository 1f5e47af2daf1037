#pragma once
#include <string>
#include <vector>
namespace tapstudy::runner {
// The column speed_m_s of a CSV file. Throws InvalidInput with file and line: no such column, a
// value that is not above 0 and below 100.
std::vector<double> read_speeds(const std::string& file);
}  // namespace tapstudy::runner
