#pragma once
#include <ostream>
#include <set>
#include <string>

#include "core/settings/spidar_calibration.hpp"
namespace tapstudy::protocols {
// The calibration of one SPIDAR, a file of its own: all rigs on that device share it.

// Throws InvalidInput with every problem of the text, one a line, or if it is for a frame of
// another type.
core::SpidarCalibration parse_calibration(const std::string& text, const std::string& file,
                                          const std::string& type);
void write_calibration(std::ostream& out, const std::string& type,
                       const core::SpidarCalibration& calibration);
// Every key that the reader asked for while reading this text, for the schema's test.
std::set<std::string> calibration_keys_asked_for(const std::string& text, const std::string& file);
}  // namespace tapstudy::protocols
