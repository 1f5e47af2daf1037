#include "device/remote/packets.hpp"

#include <bit>
#include <cstring>
namespace tapstudy::device {
namespace {
static_assert(std::endian::native == std::endian::little, "packets are copied byte for byte");
constexpr std::array<char, 4> request_mark{'T', 'A', 'P', 'S'};
constexpr std::array<char, 4> reply_mark{'T', 'A', 'P', 'R'};

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

core::Vec3 taken_vector(std::span<const std::uint8_t> bytes, std::size_t at) noexcept {
  return {taken<double>(bytes, at), taken<double>(bytes, at + 8), taken<double>(bytes, at + 16)};
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

std::optional<RemoteReply> decoded_reply(std::span<const std::uint8_t> bytes) noexcept {
  if (bytes.size() < reply_bytes || taken<std::array<char, 4>>(bytes, 0) != reply_mark) {
    return std::nullopt;
  }
  const auto version = taken<std::uint32_t>(bytes, 4);
  RemoteReply reply{taken<std::uint32_t>(bytes, 8),
                    {taken_vector(bytes, 12), taken_vector(bytes, 36)},
                    std::nullopt,
                    std::nullopt};
  if (version == 1 && bytes.size() == reply_bytes) {
    return reply;
  }
  if (version != 2 || bytes.size() != reply_bytes_of_version_2) {
    return std::nullopt;
  }
  reply.status = taken<std::uint32_t>(bytes, 60);
  reply.exerted_n = taken_vector(bytes, 64);
  const bool is_known = reply.exerted_n->array().isFinite().all();
  const bool is_unknown = reply.exerted_n->array().isNaN().all();
  return is_known || is_unknown ? std::optional{reply} : std::nullopt;
}
}  // namespace tapstudy::device
