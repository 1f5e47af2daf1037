#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "core/haptics/haptic_state.hpp"
#include "core/tick/actuator_tape.hpp"
namespace tapstudy::results {
inline constexpr const char* trace_codec = "tapstudy-trace/3";

// Measured: the hand's position and velocity are noise in their last bits, which take most of the
// bytes. A tick of an idle device takes far less.
inline constexpr double usual_bytes_per_tick = 47.0;
// Of an actuator's card, silence between taps included; measured on simulated studies.
inline constexpr double usual_bytes_per_actuator_sample = 1.4;

// Lossless encoding of samples, as documented in trace_format.md: the bytes of 168-byte records,
// shuffled, in one Zstandard frame with a checksum. read_trace.py is a reader in Python.
// Measured on simulated and on noisy traces: 1 to 4 % larger than with prior delta coding between
// ticks, read twice as fast; Blosc's shuffle is the same layout without the checksum.
std::vector<std::byte> encode_trace(std::span<const core::TraceSample> samples);
// Throws StoreError, naming `what` they are, if the bytes are not `ticks` encoded samples.
std::vector<core::TraceSample> decode_trace(std::span<const std::byte> bytes, std::size_t ticks,
                                            const std::string& what);

inline constexpr const char* actuator_codec = "tapstudy-actuator/1";

// What an actuator's card was given: periods, and all their samples one after the other, of which
// full scale is from -1 to 1.
struct ActuatorTrace {
  std::vector<core::ActuatorPeriod> periods;
  std::vector<float> samples;
};
// Lossless, as documented in trace_format.md.
std::vector<std::byte> encode_actuator(const ActuatorTrace& trace);
// Throws StoreError, naming `what` it is, if the bytes are not so many periods of so many samples.
ActuatorTrace decode_actuator(std::span<const std::byte> bytes, std::size_t periods,
                              std::size_t samples, const std::string& what);
}  // namespace tapstudy::results
