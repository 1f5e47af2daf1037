#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>
namespace tapstudy::runner {
// CSV files with a row for each impact, in the order of the recordings. Both throw InvalidInput
// with file and line: no such column, a cell that is no such value.

// The column speed_m_s: above 0, below 100 m/s.
std::vector<double> read_speeds(const std::string& file);
// The columns x_m and y_m, plate frame: within 10 m.
std::vector<Eigen::Vector2d> read_places(const std::string& file);
}  // namespace tapstudy::runner
