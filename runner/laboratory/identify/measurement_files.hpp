#pragma once
#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "runner/laboratory/identify/tap_identification.hpp"
namespace tapstudy::runner {
// CSV files with a row for each impact, in the order of the recordings. Both throw InvalidInput
// with file and line: no such column, a cell that is no such value.

// The column speed_m_s: above 0, below 100 m/s.
std::vector<double> read_speeds(const std::string& file);
// The columns x_m and y_m, plate frame: within 10 m.
std::vector<Eigen::Vector2d> read_places(const std::string& file);

// A row for each place where motion was measured: the columns place, x_m and y_m. Throws
// InvalidInput likewise, and for a place that is there twice.
struct NamedPlace {
  std::string name;  // "12+Z", or the node alone
  Eigen::Vector2d at_m;
};
std::vector<NamedPlace> read_named_places(const std::string& file);

// One recording: channels that were measured at the same times.
struct MeasuredFile {
  std::vector<analysis::Recording> channels;
  std::optional<analysis::Recording> force;  // [N]
  std::vector<std::size_t> force_rails;      // where it was at its sensor's limit
};
// Throws InvalidInput as read_recording does, and for a column that is asked for twice.
MeasuredFile read_measured_file(const std::string& file, const TapQuestion& question);

// The taps of the channel in which they stand out most from the noise; they are the same in all
// channels. Where a force was recorded, an impact is where it strikes. Throws InvalidInput if no
// channel, or the force, has one.
analysis::FoundTaps find_taps(const MeasuredFile& measured, const analysis::TapFinding& finding);

// The force of an impact, above what it was before, for as long as it acts near the tap's onset.
// Throws InvalidInput with file and time if there is none. The file has a force.
ImpactForce impact_force(const MeasuredFile& measured, const analysis::Tap& tap);
}  // namespace tapstudy::runner
