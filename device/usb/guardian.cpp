#include "device/usb/guardian.hpp"

#include <fcntl.h>
#include <linux/usbdevice_fs.h>
#include <poll.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <cstring>
#include <ctime>
#include <memory>

#include "device/device.hpp"
namespace tapstudy::device {
bool is_guardian_alive(const WatchdogChannel& channel) noexcept {
  constexpr timespec pause{0, 2'000'000};
  constexpr int max_pauses = 50;
  const std::uint64_t rounds = channel.rounds();
  for (int i = 0; i < max_pauses && channel.rounds() == rounds; ++i) {
    nanosleep(&pause, nullptr);
  }
  return channel.rounds() != rounds;
}

namespace {
constexpr int max_descriptors = 1024;

bool is_named(int descriptor) noexcept {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): the C library's
  if (getsockname(descriptor, reinterpret_cast<sockaddr*>(&address), &size) != 0) {
    return false;  // not a socket
  }
  if (address.ss_family == AF_UNIX) {
    return size > offsetof(sockaddr_un, sun_path);
  }
  int is_listening = 0;
  socklen_t flag_size = sizeof is_listening;
  return getsockopt(descriptor, SOL_SOCKET, SO_ACCEPTCONN, &is_listening, &flag_size) == 0 &&
         is_listening != 0;
}

bool is_file(int descriptor) noexcept {
  struct stat status {};
  return fstat(descriptor, &status) == 0 && (S_ISREG(status.st_mode) || S_ISDIR(status.st_mode));
}
}  // namespace

void close_files_and_named_sockets(std::span<const int> kept) noexcept {
  for (int descriptor = STDERR_FILENO + 1; descriptor < max_descriptors; ++descriptor) {
    const bool is_kept = std::ranges::find(kept, descriptor) != kept.end();
    if (!is_kept && (is_file(descriptor) || is_named(descriptor))) {
      close(descriptor);
    }
  }
}

namespace {
constexpr unsigned packet_time_out_ms = 20;
constexpr unsigned reply_time_out_ms = 5;  // a later one comes in the next round
constexpr int max_left_over_replies = 16;
constexpr int rounds_per_heartbeat = 5;
constexpr int repeat_ms = 5;  // zero force is sent so often, which leaves the bus to the program
constexpr std::chrono::seconds max_final{60};
constexpr int max_wait_for_end_ms = 200;

// Raising one's own score needs no privilege; if it fails, all processes are equally likely to be
// killed when memory runs out.
void set_oom_score(const char* score) noexcept {
  const int file = open("/proc/self/oom_score_adj", O_WRONLY | O_CLOEXEC);
  if (file >= 0) {
    static_cast<void>(!write(file, score, strlen(score)));
    close(file);
  }
}

// Uses only async-signal-safe functions, as required between fork and _exit.
class Watchdog {
 public:
  Watchdog(int life, int node, GuardianSettings& settings, WatchdogChannel& channel) noexcept
      : life_{life},
        node_{node},
        settings_{settings},
        channel_{channel},
        // the last beat may have been up to a round before the first of these
        max_still_rounds_{
            std::max(1, static_cast<int>(1e3 * settings.max_stall_s) / guardian_round_ms - 1)} {}

  [[noreturn]] void run() noexcept {
    for (const int signal : std::array{SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE, SIGTSTP}) {
      struct sigaction ignored {};
      ignored.sa_handler = SIG_IGN;
      sigaction(signal, &ignored, nullptr);
    }
    ask_for_realtime();
    set_oom_score("0");  // not the program's own
    while (is_parent_alive()) {
      poll();
      channel_.complete_round();
    }
    send_final_zero_force();
    _exit(0);
  }

 private:
  enum class Zero { refused, taken, confirmed };

  // Nobody else can say it now. A board that was sent nothing but zeros need not reply.
  void send_final_zero_force() noexcept {
    const auto end = std::chrono::steady_clock::now() + max_final;
    int taken = 0;
    bool is_confirmed = !channel_.is_power_allowed();
    for (int i = 0;
         (taken < zero_force_packets || !is_confirmed) && std::chrono::steady_clock::now() < end;
         ++i) {
      if (i > zero_force_packets) {
        ::poll(nullptr, 0, repeat_ms);
      }
      const Zero zero = zero_force();
      if (zero == Zero::refused && errno == ENODEV) {
        return;
      }
      taken += zero == Zero::refused ? 0 : 1;
      is_confirmed = is_confirmed || zero == Zero::confirmed;
    }
  }
  // What is refused, is done without.
  void ask_for_realtime() const noexcept {
    const sched_param parameters{settings_.fifo_priority};
    if (settings_.fifo_priority > 0) {
      sched_setscheduler(0, SCHED_FIFO, &parameters);
    }
    mlockall(MCL_CURRENT | MCL_ONFAULT);  // only what it touches, not the program's whole image
  }
  // Waits for the next round; false once the pipe is closed.
  bool is_parent_alive() const noexcept {
    pollfd waiting{life_, POLLIN, 0};
    if (::poll(&waiting, 1, is_sending_ ? repeat_ms : guardian_round_ms) <= 0) {
      return true;
    }
    char byte = 0;
    return read(life_, &byte, 1) != 0;
  }
  void poll() noexcept {
    const std::uint64_t beats = channel_.beats();
    still_rounds_ = channel_.is_on() && beats == beats_ ? still_rounds_ + 1 : 0;
    beats_ = beats;
    const bool is_stalled = still_rounds_ >= max_still_rounds_;
    if (is_stalled) {
      channel_.take_output_over();  // first: a resumed program must see it before sending
    }
    is_sending_ = is_stalled || (channel_.must_repeat() && !channel_.is_paused());
    if (settings_.relay >= 0 && (is_sending_ || channel_.must_repeat())) {
      tcflush(settings_.relay, TCOFLUSH);  // bytes not yet sent would keep it closed
    }
    if (!is_sending_) {
      has_read_left_over_ = false;
    } else if (zero_force() == Zero::confirmed) {
      channel_.note_zero_confirmed();
    }
    if (++round_ % rounds_per_heartbeat == 0) {
      send_relay_heartbeat();
    }
  }
  void send_relay_heartbeat() const noexcept {
    if (settings_.relay >= 0 && channel_.may_close_relay()) {
      static_cast<void>(!write(settings_.relay, "\x55", 1));
    }
  }
  // What the board replies to the first packet may be left over from before, and confirms nothing.
  Zero zero_force() noexcept {
    if (!send_zero_force()) {
      return Zero::refused;
    }
    if (!has_read_left_over_) {
      has_read_left_over_ = true;
      for (int i = 0; i < max_left_over_replies && read_reply() >= 0; ++i) {
      }
      return Zero::taken;
    }
    return is_confirmed() ? Zero::confirmed : Zero::taken;
  }
  bool is_confirmed() noexcept {
    ZeroForcePacket& zero = settings_.zero_force_packet;
    if (!zero.request.empty() && !send_packet(zero.request)) {
      return false;
    }
    const auto echo_end = reply_.begin() + static_cast<std::ptrdiff_t>(zero.echo_bytes);
    return read_reply() == static_cast<int>(zero.reply_bytes) &&
           std::all_of(reply_.begin(), echo_end, [](std::uint8_t byte) { return byte == 0; });
  }
  // Its length; negative if none comes.
  int read_reply() noexcept {
    return transfer(settings_.in_endpoint, reply_.data(), settings_.zero_force_packet.reply_bytes,
                    reply_time_out_ms);
  }
  // A halted endpoint takes nothing until its halt is cleared. Only then: clearing waits for the
  // device's control endpoint, and holds up the program meanwhile.
  bool send_zero_force() noexcept {
    if (send_packet(settings_.zero_force_packet.bytes)) {
      return true;
    }
    if (errno != EPIPE) {
      return false;
    }
    for (unsigned endpoint :
         std::array<unsigned, 2>{settings_.out_endpoint, settings_.in_endpoint}) {
      // NOLINTNEXTLINE(cppcoreguidelines-pro-type-vararg)
      ioctl(node_, USBDEVFS_CLEAR_HALT, &endpoint);
    }
    return send_packet(settings_.zero_force_packet.bytes);
  }
  bool send_packet(std::vector<std::uint8_t>& bytes) const noexcept {
    return transfer(settings_.out_endpoint, bytes.data(), bytes.size(), packet_time_out_ms) ==
           static_cast<int>(bytes.size());
  }
  // How many bytes; negative if it fails.
  int transfer(unsigned endpoint, void* bytes, std::size_t size,
               unsigned time_out_ms) const noexcept {
    usbdevfs_bulktransfer packet{endpoint, static_cast<unsigned>(size), time_out_ms, bytes};
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-vararg)
    return ioctl(node_, USBDEVFS_BULK, &packet);
  }

  int life_;
  int node_;
  GuardianSettings& settings_;
  WatchdogChannel& channel_;
  int max_still_rounds_;
  std::uint64_t beats_{0};
  int still_rounds_{0};
  unsigned round_{0};
  bool is_sending_{false};  // zero force, in place of the program
  bool has_read_left_over_{false};
  std::array<std::uint8_t, max_reply_bytes> reply_{};
};

}  // namespace

void Guardian::Unmap::operator()(WatchdogChannel* channel) const noexcept {
  munmap(channel, sizeof(WatchdogChannel));
}

std::unique_ptr<WatchdogChannel, Guardian::Unmap> Guardian::shared_channel() {
  void* const memory = mmap(nullptr, sizeof(WatchdogChannel), PROT_READ | PROT_WRITE,
                            MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) {  // NOLINT(cppcoreguidelines-pro-type-cstyle-cast): the C library's
    throw DeviceError{"cannot share memory with the device's watchdog process"};
  }
  return std::unique_ptr<WatchdogChannel, Unmap>{
      std::construct_at(static_cast<WatchdogChannel*>(memory))};
}

Guardian::Guardian(const UsbNode& node, GuardianSettings settings) : channel_{shared_channel()} {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) {
    throw DeviceError{"cannot create a pipe to the device's watchdog process"};
  }
  child_ = fork();
  if (child_ == 0) {
    setsid();  // detached from Ctrl-C at the terminal
    close(ends[1]);
    close_files_and_named_sockets(std::array{node.descriptor(), settings.relay});
    Watchdog{ends[0], node.descriptor(), settings, *channel_}.run();
  }
  close(ends[0]);
  life_ = ends[1];
  if (child_ < 0) {
    close(life_);
    throw DeviceError{"the device's watchdog process cannot be started"};
  }
  set_oom_score("500");  // the program shall be killed before its guardian
}

// The child ends by itself once zero force was taken, or stays to repeat it.
Guardian::~Guardian() {
  close(life_);
  for (int waited_ms = 0; waited_ms < max_wait_for_end_ms; ++waited_ms) {
    int status = 0;
    const pid_t ended = waitpid(child_, &status, WNOHANG);
    if (ended == child_ || (ended < 0 && errno != EINTR)) {
      return;
    }
    ::poll(nullptr, 0, 1);
  }
}
}  // namespace tapstudy::device
