#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "core/haptics/haptic_state.hpp"
#include "device/remote/wire.hpp"
namespace tapstudy::device {
// The datagrams between tapstudy and a program that drives another device, in three versions of
// the protocol (device/remote/README.md); what comes from the wire is checked here. Version 3 is in
// wire.hpp. Versions 1 and 2, UDP on the loopback, little-endian, SI units, device frame:
//
//   to the device, 36 bytes                    from the device, 60 or 88 bytes
//    0  "TAPS"                                  0  "TAPR"
//    4  u32  kind: 1 reply with the position,   4  u32  protocol version: 1, or 2 with the rest
//            2 no reply                         8  u32  number of the request
//    8  u32  number of the request, rising     12  3 × f64  position [m]
//   12  3 × f64  force to exert from now [N]   36  3 × f64  velocity [m/s]
//                                              60  u32  status, bits as in wire.hpp
//                                              64  3 × f64  force exerted now [N]; all NaN: unknown
enum class RequestKind : std::uint32_t { reply = 1, no_reply = 2 };
struct RemoteRequest {
  RequestKind kind{};
  std::uint32_t number{};
  core::Vec3 force_n{core::Vec3::Zero()};
};

// A sample of version 3.
struct RemoteSample {
  std::uint64_t number{};
  double age_s{};
  std::array<char, sizeof(wire::Reply::text)> text{};  // ends in a zero
};
struct RemoteReply {
  int version{};
  std::uint32_t number{};
  core::HandState hand;                 // velocity all NaN: not measured (version 3)
  std::optional<std::uint32_t> status;  // versions 2 and 3
  std::optional<core::Vec3> exerted_n;  // likewise; all NaN: unknown
  std::optional<RemoteSample> sample;   // version 3
};
// What a device of version 3 says of itself.
struct RemoteDescription {
  std::string name;
  std::string serial_number;
  int driven_axes{};
  double workspace_radius_m{};
  double max_force_n{};
  double max_stiffness_n_per_m{};
  double rate_hz{};
  double release_s{};
};
inline constexpr std::size_t request_bytes = 36;
inline constexpr std::size_t reply_bytes = 60;
inline constexpr std::size_t reply_bytes_of_version_2 = 88;
inline constexpr std::size_t max_reply_datagram_bytes = sizeof(wire::Reply);

std::array<std::uint8_t, request_bytes> encoded(const RemoteRequest& request) noexcept;
std::array<std::uint8_t, sizeof(wire::Request)> encoded(const wire::Request& request) noexcept;
// nullopt if the bytes are not a valid reply of one of the versions. Anything may be in the
// position: what is not finite there is a fault of its own in the loop.
std::optional<RemoteReply> decoded_reply(std::span<const std::uint8_t> bytes) noexcept;
// nullopt if the bytes are not an introduction to the request of this number. Its limits are as
// they came.
std::optional<wire::Introduction> decoded_introduction(std::span<const std::uint8_t> bytes,
                                                       std::uint32_t number) noexcept;
// Throws DeviceError if it says of the device what no device is (wire::limits).
RemoteDescription description_in(const wire::Introduction& told);
}  // namespace tapstudy::device
