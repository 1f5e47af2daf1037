#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>

#include "core/text/plain_text.hpp"
#include "device/device.hpp"
#include "device/relay/serial_port.hpp"
#include "runner/session/markers/marker_output.hpp"
namespace tapstudy::runner {
namespace {
constexpr std::size_t max_detail_bytes = 1024;  // a line is then written to a pipe whole or not

// A file that holds anything else would be spoiled by what is appended to it.
void check_holds_markers(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    return;
  }
  std::ifstream file{path};
  std::string line;
  if (std::getline(file, line) && !core::number_in<double>(line.substr(0, line.find('\t')))) {
    throw device::DeviceError{
        fmt::format("markers.lines: '{}' holds something other than markers", path)};
  }
}

// A descriptor, or a negative errno.
int opened(const std::string& path) {
  constexpr int flags = O_WRONLY | O_APPEND | O_NOCTTY | O_NONBLOCK | O_CLOEXEC;
  constexpr int mode = 0644;
  const int create = path.starts_with("/dev/") ? 0 : O_CREAT;
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-vararg): the C library's own
  const int descriptor = open(path.c_str(), flags | create, mode);
  if (descriptor < 0) {
    return -errno;
  }
  static_cast<void>(device::set_up_serial_port(descriptor));  // or it is a file or a pipe
  return descriptor;
}

class LineMarkers final : public MarkerOutput {
 public:
  explicit LineMarkers(const std::string& path) : path_{path} {
    check_holds_markers(path);
    descriptor_ = opened(path);
    if (descriptor_ < 0 && descriptor_ != -ENXIO) {
      throw device::DeviceError{fmt::format("markers.lines: '{}' cannot be opened: {}", path,
                                            std::strerror(-descriptor_))};
    }
  }
  ~LineMarkers() override { forget(); }
  LineMarkers(const LineMarkers&) = delete;
  LineMarkers& operator=(const LineMarkers&) = delete;
  LineMarkers(LineMarkers&&) = delete;
  LineMarkers& operator=(LineMarkers&&) = delete;
  std::string name() const override { return "lines to " + path_; }

  Sent send(const Marker& marker) override {
    if (descriptor_ < 0) {
      descriptor_ = opened(path_);
    }
    if (descriptor_ < 0 || !has_written_rest()) {
      return Sent::no;
    }
    rest_ = line_of(marker);
    const std::size_t whole = rest_.size();
    if (has_written_rest() || (descriptor_ >= 0 && rest_.size() < whole)) {
      return Sent::yes;
    }
    rest_.clear();
    return Sent::no;
  }

 private:
  static bool is_full(int error) {
    return error == EAGAIN || error == ENOSPC || error == EDQUOT || error == EFBIG;
  }
  // What a full port, or disk, has not taken of a line goes out before the next one.
  bool has_written_rest() {
    while (!rest_.empty()) {
      const ssize_t written = write(descriptor_, rest_.data(), rest_.size());
      if (written > 0) {
        rest_.erase(0, static_cast<std::size_t>(written));
      } else if (written == 0 || is_full(errno)) {
        return false;
      } else if (errno != EINTR) {
        forget();
        return false;
      }
    }
    return true;
  }
  void forget() {
    if (descriptor_ >= 0) {
      close(descriptor_);
    }
    descriptor_ = -1;
    rest_.clear();
  }

  std::string path_;
  int descriptor_{-1};
  std::string rest_;  // of the line that was begun last
};
}  // namespace

std::string line_of(const Marker& marker) {
  const results::SessionEventRow& change = marker.change;
  std::string detail = core::cut_to(change.detail, max_detail_bytes);
  std::ranges::replace_if(
      detail, [](unsigned char byte) { return byte < ' '; }, ' ');
  constexpr std::int64_t ns_per_s = 1'000'000'000;
  constexpr std::int64_t ns_per_us = 1000;
  const std::time_t second = marker.utc_ns / ns_per_s;
  return fmt::format("{:.6f}\t{}\t{}\t{}\t{:.6f}\t{:%FT%T}.{:06}Z\n", change.t_s, change.state,
                     change.number.value_or(-1), detail,
                     static_cast<double>(marker.monotonic_ns) / static_cast<double>(ns_per_s),
                     fmt::gmtime(second), marker.utc_ns % ns_per_s / ns_per_us);
}

std::unique_ptr<MarkerOutput> open_line_markers(const std::string& path) {
  return std::make_unique<LineMarkers>(path);
}
}  // namespace tapstudy::runner
