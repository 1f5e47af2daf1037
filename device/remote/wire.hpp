#pragma once
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>
// remote/3: the protocol between tapstudy and a program that drives another device. One datagram
// each way in a tick, UDP on the loopback; every struct below is a datagram, byte for byte.
// Integers and doubles (IEEE 754) are little-endian, units SI; vectors are x, y, z in the device
// frame: origin at the middle of the workspace, +x right, +y up, +z towards the participant. Texts
// are printable ASCII, filled up with zeros, the last byte always zero. This header needs the
// standard library only; device/remote/README.md states the rules.
namespace tapstudy::device::wire {
static_assert(std::endian::native == std::endian::little, "datagrams are copied byte for byte");
using Mark = std::array<char, 4>;
using Vector = std::array<double, 3>;

enum class Asked : std::uint32_t { exchange = 1, introduction = 3 };

// From tapstudy. An exchange is answered by a Reply, a request for an introduction by an
// Introduction.
struct Request {
  static constexpr Mark expected_mark{'T', 'A', 'P', '3'};
  Mark mark{expected_mark};
  Asked asked{Asked::exchange};
  std::uint32_t number{0};  // rises with each request
  std::uint32_t reserved{0};
  Vector force_n{};     // to exert from now on; zero in a request for an introduction
  Vector torque_n_m{};  // likewise; always zero today
};
static_assert(sizeof(Request) == 64 && std::is_trivially_copyable_v<Request>);
static_assert(offsetof(Request, asked) == 4 && offsetof(Request, number) == 8 &&
              offsetof(Request, force_n) == 16 && offsetof(Request, torque_n_m) == 40);

// Bits of the status.
inline constexpr std::uint32_t motors_on = 1U;           // else it exerts no force, and says why
inline constexpr std::uint32_t force_was_released = 2U;  // after a silence, before this request
inline constexpr std::uint32_t must_be_homed = 4U;       // its position cannot be relied on

// The newest sample of the device.
struct Reply {
  static constexpr Mark expected_mark{'T', 'A', 'R', '3'};
  Mark mark{expected_mark};
  std::uint32_t request{0};  // its number
  std::uint64_t sample{0};   // number of the sample: one more with each that the device takes
  double age_s{0.0};         // of the sample, when this is sent
  Vector position_m{};
  Vector velocity_m_s{};  // all NaN: not measured
  std::array<double, 4> orientation{1, 0, 0,
                                    0};  // unit quaternion w, x, y, z; all NaN: not measured
  Vector exerted_n{};                    // force exerted now; all NaN: unknown
  Vector exerted_n_m{};                  // torque, likewise
  std::uint32_t buttons{0};              // one bit each
  std::uint32_t status{motors_on};
  std::array<char, 96> text{};  // for the operator; empty: nothing to say
};
static_assert(sizeof(Reply) == 256 && std::is_trivially_copyable_v<Reply>);
static_assert(offsetof(Reply, request) == 4 && offsetof(Reply, sample) == 8 &&
              offsetof(Reply, age_s) == 16 && offsetof(Reply, position_m) == 24 &&
              offsetof(Reply, velocity_m_s) == 48 && offsetof(Reply, orientation) == 72 &&
              offsetof(Reply, exerted_n) == 104 && offsetof(Reply, exerted_n_m) == 128 &&
              offsetof(Reply, buttons) == 152 && offsetof(Reply, status) == 156 &&
              offsetof(Reply, text) == 160);

// What the device is and can do.
struct Introduction {
  static constexpr Mark expected_mark{'T', 'A', 'I', '3'};
  Mark mark{expected_mark};
  std::uint32_t request{0};        // its number
  std::uint32_t measured_axes{3};  // 3: position, 6: orientation as well
  std::uint32_t driven_axes{3};    // 3 or more: 3 of force, the rest of torque
  double workspace_radius_m{0.0};  // a sphere within which the maximum force can be exerted
  double max_force_n{0.0};
  double max_stiffness_n_per_m{0.0};  // of a virtual wall that the device renders without chatter
  double rate_hz{0.0};                // of its samples
  double release_s{0.0};              // without a request for so long, it exerts nothing
  std::array<char, 64> name{};
  std::array<char, 40> serial_number{};
};
static_assert(sizeof(Introduction) == 160 && std::is_trivially_copyable_v<Introduction>);
static_assert(offsetof(Introduction, request) == 4 && offsetof(Introduction, measured_axes) == 8 &&
              offsetof(Introduction, driven_axes) == 12 &&
              offsetof(Introduction, workspace_radius_m) == 16 &&
              offsetof(Introduction, max_force_n) == 24 &&
              offsetof(Introduction, max_stiffness_n_per_m) == 32 &&
              offsetof(Introduction, rate_hz) == 40 && offsetof(Introduction, release_s) == 48 &&
              offsetof(Introduction, name) == 56 && offsetof(Introduction, serial_number) == 120);

// What an introduction may say. Anything else, not finite numbers included, would make the checks
// that rest on it meaningless: example/server.hpp does not begin with it, and tapstudy refuses it.
inline constexpr double max_release_s = 0.15;
struct Limit {
  const char* name;
  const char* unit;
  double Introduction::*value;
  double least;
  double greatest;
  constexpr bool allows(const Introduction& told) const {
    return told.*value >= least && told.*value <= greatest;
  }
};
inline constexpr std::array<Limit, 5> limits{
    {{"radius of the workspace", "m", &Introduction::workspace_radius_m, 1e-3, 10.0},
     {"maximum force", "N", &Introduction::max_force_n, 0.01, 1000.0},
     {"maximum stiffness", "N/m", &Introduction::max_stiffness_n_per_m, 1.0, 1e7},
     {"rate of the samples", "Hz", &Introduction::rate_hz, 20.0, 1e5},
     {"release time", "s", &Introduction::release_s, 1e-3, max_release_s}}};
}  // namespace tapstudy::device::wire
