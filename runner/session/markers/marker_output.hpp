#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "protocols/rig.hpp"
#include "results/rows.hpp"
namespace tapstudy::runner {
enum class Sent : std::uint8_t { yes, no };

// Tells another program or instrument what the session does, at once.
class MarkerOutput {
 public:
  virtual ~MarkerOutput() = default;
  // Never waits: what cannot be sent now is lost.
  virtual Sent send(const results::SessionEventRow& change) = 0;
  // For messages.
  virtual std::string name() const = 0;
};

// Lines of text to a serial port (115 200 baud, 8 data bits, no parity, one stop bit), a named pipe
// or the end of a file, which is made if it is not there, unless it is a device. A pipe without a
// reader, and a port that has gone, are tried again at each marker.
// Throws DeviceError if it cannot be opened for any other cause, and for a file of something else.
std::unique_ptr<MarkerOutput> open_line_markers(const std::string& path);

// time_s<TAB>state<TAB>trial<TAB>detail; the trial is -1 between trials.
std::string line_of(const results::SessionEventRow& change);

// Open Sound Control over UDP: see README.md. Throws InvalidInput if the host's name means nothing;
// it is looked up now, and never again.
std::unique_ptr<MarkerOutput> open_osc_markers(const protocols::OscTarget& target);
}  // namespace tapstudy::runner
