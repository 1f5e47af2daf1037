#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <string>

#include "protocols/rig.hpp"
#include "results/rows.hpp"
namespace tapstudy::runner {
enum class Sent : std::uint8_t { yes, no };

// A change of the session, with the clocks by which other recordings are put beside it.
struct Marker {
  results::SessionEventRow change;  // its time counts from the session's begin
  std::int64_t monotonic_ns{};      // CLOCK_MONOTONIC then
  std::int64_t utc_ns{};            // since 1970, then, as the system's clock says now
};

// The force that a tick commanded.
struct ForceSample {
  std::array<double, 3> force_n{};  // device frame
  std::int64_t monotonic_ns{};
};

// Tells another program or instrument what the session does, at once.
class MarkerOutput {
 public:
  virtual ~MarkerOutput() = default;
  // Never waits: what cannot be sent now is lost.
  virtual Sent send(const Marker& marker) = 0;
  // Every tick's, where it is asked for. Likewise.
  virtual void send_force(const ForceSample& /*sample*/) {}
  // For messages.
  virtual std::string name() const = 0;
};

// Lines of text to a serial port (115 200 baud, 8 data bits, no parity, one stop bit), a named pipe
// or the end of a file, which is made if it is not there, unless it is a device. A pipe without a
// reader, and a port that has gone, are tried again at each marker.
// Throws DeviceError if it cannot be opened for any other cause, and for a file of something else.
std::unique_ptr<MarkerOutput> open_line_markers(const std::string& path);

// time_s<TAB>state<TAB>trial<TAB>detail<TAB>monotonic_s<TAB>utc; the trial is -1 between trials.
std::string line_of(const Marker& marker);

// Open Sound Control over UDP: see README.md. Throws InvalidInput if the host's name means nothing;
// it is looked up now, and never again.
std::unique_ptr<MarkerOutput> open_osc_markers(const protocols::OscTarget& target);

// A stream of the Lab Streaming Layer, by liblsl 1.10 or later, which is loaded now: see README.md.
// Throws DeviceError if it is not installed or refuses.
std::unique_ptr<MarkerOutput> open_lsl_markers(const protocols::LslStreams& streams);
}  // namespace tapstudy::runner
