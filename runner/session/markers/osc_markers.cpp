#include <fmt/format.h>
#include <lo/lo.h>
#include <netdb.h>
#include <sys/socket.h>

#include <array>
#include <type_traits>

#include "core/error.hpp"
#include "runner/session/markers/marker_output.hpp"
namespace tapstudy::runner {
namespace {
struct Free {
  void operator()(lo_address address) const { lo_address_free(address); }
  void operator()(addrinfo* found) const { freeaddrinfo(found); }
};
using Address = std::unique_ptr<std::remove_pointer_t<lo_address>, Free>;

// A name server that hangs must not hold a trial up.
std::string numeric_host(const std::string& host) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_DGRAM;
  addrinfo* first = nullptr;
  if (const int error = getaddrinfo(host.c_str(), nullptr, &hints, &first); error != 0) {
    throw core::InvalidInput{
        fmt::format("markers.osc.host: '{}' is not found ({})", host, gai_strerror(error))};
  }
  const std::unique_ptr<addrinfo, Free> found{first};
  std::array<char, NI_MAXHOST> numeric{};
  getnameinfo(found->ai_addr, found->ai_addrlen, numeric.data(), numeric.size(), nullptr, 0,
              NI_NUMERICHOST);
  return numeric.data();
}

// OSC has the time of NTP: seconds since 1900 and their fraction in 32 bits each.
lo_timetag timetag_of(std::int64_t utc_ns) {
  constexpr std::int64_t from_1900_to_1970_s = 2'208'988'800;
  constexpr std::int64_t ns_per_s = 1'000'000'000;
  return {static_cast<std::uint32_t>(utc_ns / ns_per_s + from_1900_to_1970_s),
          static_cast<std::uint32_t>((utc_ns % ns_per_s << 32U) / ns_per_s)};
}

class OscMarkers final : public MarkerOutput {
 public:
  explicit OscMarkers(const protocols::OscTarget& target)
      : name_{fmt::format("OSC to {}:{}", target.host, target.port)},
        address_{lo_address_new(numeric_host(target.host).c_str(),
                                std::to_string(target.port).c_str())} {}
  Sent send(const Marker& marker) override {
    const results::SessionEventRow& change = marker.change;
    const lo_message message = lo_message_new();
    lo_message_add_double(message, change.t_s);
    lo_message_add_int32(message, change.number.value_or(-1));
    lo_message_add_string(message, change.detail.c_str());
    constexpr double ns_per_s = 1e9;
    lo_message_add_double(message, static_cast<double>(marker.monotonic_ns) / ns_per_s);
    lo_message_add_timetag(message, timetag_of(marker.utc_ns));
    const int sent =
        lo_send_message(address_.get(), ("/tapstudy/" + change.state).c_str(), message);
    lo_message_free(message);
    return sent > 0 ? Sent::yes : Sent::no;
  }
  std::string name() const override { return name_; }

 private:
  std::string name_;
  Address address_;
};
}  // namespace

std::unique_ptr<MarkerOutput> open_osc_markers(const protocols::OscTarget& target) {
  return std::make_unique<OscMarkers>(target);
}
}  // namespace tapstudy::runner
