#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "core/haptics/haptic_state.hpp"
namespace tapstudy::device {
// The protocol between tapstudy and a program that drives another device: UDP datagrams on the
// loopback. Integers and doubles (IEEE 754) are little-endian; vectors are x, y, z in the device
// frame (core/haptics/haptic_state.hpp), SI units.
//
//   to the device, 36 bytes                    from the device, 60 or 88 bytes
//    0  "TAPS"                                  0  "TAPR"
//    4  u32  kind: 1 reply with the position,   4  u32  protocol version: 1, or 2 with the rest
//            2 no reply                         8  u32  number of the request
//    8  u32  number of the request, rising     12  3 × f64  position [m]
//   12  3 × f64  force to exert from now [N]   36  3 × f64  velocity [m/s]
//                                              60  u32  status, below
//                                              64  3 × f64  force exerted now [N]; all NaN: unknown
//
// The velocity must be the change of the position (remote_hand.hpp): the strength of an impact
// rests on it.
//
// The other program holds the last force, and must release it after 20 ms without a request. From
// its first request on it should listen to that sender only, until it has been silent for a second,
// and only to numbers that rise.
enum class RequestKind : std::uint32_t { reply = 1, no_reply = 2 };
struct RemoteRequest {
  RequestKind kind{};
  std::uint32_t number{};
  core::Vec3 force_n{core::Vec3::Zero()};
};
struct RemoteReply {
  std::uint32_t number{};
  core::HandState hand;
  std::optional<std::uint32_t> status;  // version 2
  std::optional<core::Vec3> exerted_n;  // version 2
};
// Bits of the status.
inline constexpr std::uint32_t motors_on = 1U;
inline constexpr std::uint32_t force_was_released = 2U;  // after a silence, before this request
inline constexpr std::size_t request_bytes = 36;
inline constexpr std::size_t reply_bytes = 60;
inline constexpr std::size_t reply_bytes_of_version_2 = 88;

std::array<std::uint8_t, request_bytes> encoded(const RemoteRequest& request) noexcept;
// nullopt if the bytes are not a valid reply.
std::optional<RemoteReply> decoded_reply(std::span<const std::uint8_t> bytes) noexcept;
}  // namespace tapstudy::device
