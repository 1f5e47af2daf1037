#include "device/remote/packets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "device/device.hpp"
namespace tapstudy::device {
namespace {
constexpr wire::Mark request_mark{'T', 'A', 'P', 'S'};
constexpr wire::Mark reply_mark{'T', 'A', 'P', 'R'};
constexpr double max_unit_error = 1e-3;  // of a quaternion's length: of single precision and more

template <class Value>
void put(std::span<std::uint8_t> bytes, std::size_t at, const Value& value) noexcept {
  std::memcpy(bytes.data() + at, &value, sizeof value);
}

template <class Value>
Value taken(std::span<const std::uint8_t> bytes, std::size_t at) noexcept {
  Value value{};
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

core::Vec3 as_vector(const wire::Vector& wire) noexcept {
  return {wire[0], wire[1], wire[2]};
}

template <std::size_t Size>
bool is_known_or_unknown(const std::array<double, Size>& values) noexcept {
  return std::ranges::all_of(values, [](double value) { return std::isfinite(value); }) ||
         std::ranges::all_of(values, [](double value) { return std::isnan(value); });
}

bool is_rotation(const std::array<double, 4>& q) noexcept {
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  return is_known_or_unknown(q) && !(std::abs(length - 1.0) > max_unit_error);
}

// It is printed on a terminal, which obeys other characters.
template <std::size_t Size>
bool is_text(const std::array<char, Size>& text) noexcept {
  const auto end = std::ranges::find(text, '\0');
  return end != text.end() &&
         std::all_of(text.begin(), end, [](char c) { return c >= ' ' && c <= '~'; }) &&
         std::all_of(end, text.end(), [](char c) { return c == '\0'; });
}

template <class Datagram>
std::optional<Datagram> datagram_in(std::span<const std::uint8_t> bytes) noexcept {
  if (bytes.size() != sizeof(Datagram)) {
    return std::nullopt;
  }
  const auto datagram = taken<Datagram>(bytes, 0);
  return datagram.mark == Datagram::expected_mark ? std::optional{datagram} : std::nullopt;
}

std::optional<RemoteReply> reply_of_version_3(std::span<const std::uint8_t> bytes) noexcept {
  const auto reply = datagram_in<wire::Reply>(bytes);
  const bool is_valid = reply && std::isfinite(reply->age_s) && reply->age_s >= 0.0 &&
                        is_known_or_unknown(reply->velocity_m_s) &&
                        is_rotation(reply->orientation) && is_known_or_unknown(reply->exerted_n) &&
                        is_known_or_unknown(reply->exerted_n_m) && is_text(reply->text);
  if (!is_valid) {
    return std::nullopt;
  }
  return RemoteReply{3,
                     reply->request,
                     {as_vector(reply->position_m), as_vector(reply->velocity_m_s)},
                     reply->status,
                     as_vector(reply->exerted_n),
                     RemoteSample{reply->sample, reply->age_s, reply->text}};
}
}  // namespace

std::array<std::uint8_t, request_bytes> encoded(const RemoteRequest& request) noexcept {
  std::array<std::uint8_t, request_bytes> bytes{};
  put(bytes, 0, request_mark);
  put(bytes, 4, static_cast<std::uint32_t>(request.kind));
  put(bytes, 8, request.number);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    put(bytes, 12 + 8 * axis, request.force_n[static_cast<Eigen::Index>(axis)]);
  }
  return bytes;
}

std::array<std::uint8_t, sizeof(wire::Request)> encoded(const wire::Request& request) noexcept {
  return std::bit_cast<std::array<std::uint8_t, sizeof(wire::Request)>>(request);
}

std::optional<RemoteReply> decoded_reply(std::span<const std::uint8_t> bytes) noexcept {
  if (bytes.size() == sizeof(wire::Reply)) {
    return reply_of_version_3(bytes);
  }
  if (bytes.size() < reply_bytes || taken<wire::Mark>(bytes, 0) != reply_mark) {
    return std::nullopt;
  }
  const auto version = taken<std::uint32_t>(bytes, 4);
  RemoteReply reply{
      static_cast<int>(version),
      taken<std::uint32_t>(bytes, 8),
      {as_vector(taken<wire::Vector>(bytes, 12)), as_vector(taken<wire::Vector>(bytes, 36))},
      std::nullopt,
      std::nullopt,
      std::nullopt};
  if (version == 1 && bytes.size() == reply_bytes) {
    return reply;
  }
  if (version != 2 || bytes.size() != reply_bytes_of_version_2) {
    return std::nullopt;
  }
  const auto exerted_n = taken<wire::Vector>(bytes, 64);
  reply.status = taken<std::uint32_t>(bytes, 60);
  reply.exerted_n = as_vector(exerted_n);
  return is_known_or_unknown(exerted_n) ? std::optional{reply} : std::nullopt;
}

std::optional<wire::Introduction> decoded_introduction(std::span<const std::uint8_t> bytes,
                                                       std::uint32_t number) noexcept {
  const auto told = datagram_in<wire::Introduction>(bytes);
  constexpr std::uint32_t all_axes = 6;
  const bool is_valid =
      told && told->request == number && (told->measured_axes == 3 || told->measured_axes == 6) &&
      told->driven_axes <= all_axes && is_text(told->name) && is_text(told->serial_number);
  return is_valid ? told : std::nullopt;
}

RemoteDescription description_in(const wire::Introduction& told) {
  for (const wire::Limit& limit : wire::limits) {
    if (!limit.allows(told)) {
      throw DeviceError{fmt::format(
          "remote: '{}' introduces itself with a {} of {:.6g} {}: only {:.6g} to {:.6g} {} are "
          "believed",
          told.name.data(), limit.name, told.*limit.value, limit.unit, limit.least, limit.greatest,
          limit.unit)};
    }
  }
  return {told.name.data(),
          told.serial_number.data(),
          static_cast<int>(told.driven_axes),
          told.workspace_radius_m,
          told.max_force_n,
          told.max_stiffness_n_per_m,
          told.rate_hz,
          told.release_s};
}
}  // namespace tapstudy::device
