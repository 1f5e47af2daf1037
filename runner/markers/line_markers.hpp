#pragma once
#include <memory>
#include <string>

#include "runner/markers/marker_output.hpp"
namespace tapstudy::runner {
// Lines of text to a serial port (115 200 baud, 8 data bits, no parity, one stop bit), a named pipe
// or the end of a file, which is made if it is not there, unless it is a device. A pipe without a
// reader, and a port that has gone, are tried again at each marker.
// Throws DeviceError if it cannot be opened for any other cause, and for a file of something else.
std::unique_ptr<MarkerOutput> open_line_markers(const std::string& path);

// time_s<TAB>state<TAB>trial<TAB>detail; the trial is -1 between trials.
std::string line_of(const results::SessionEventRow& change);
}  // namespace tapstudy::runner
