// A microcontroller at a serial port as a device of tapstudy: ../README.md has the line protocol.
//
//   serial_board PORT DEVICE    and in the rig   device: remote   remote: {port: PORT}
#include <fcntl.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <termios.h>

#include <string>
#include <vector>

#include "server.hpp"
namespace {
constexpr std::array<std::uint8_t, 2> sync{0xA5, 0x5A};
constexpr std::size_t sample_bytes = 50;
constexpr std::size_t introduction_bytes = 56;
constexpr std::size_t crc_bytes = 2;
enum class Frame : std::uint8_t { force_or_sample = 1, introduction = 2 };

// CRC-16/CCITT-FALSE.
std::uint16_t crc_of(const std::uint8_t* bytes, std::size_t count) {
  constexpr unsigned polynomial = 0x1021;
  unsigned crc = 0xFFFF;
  for (std::size_t i = 0; i < count; ++i) {
    crc ^= static_cast<unsigned>(bytes[i]) << 8U;
    for (int bit = 0; bit < 8; ++bit) {
      crc = (crc << 1U) ^ ((crc & 0x8000U) != 0 ? polynomial : 0U);
    }
  }
  return static_cast<std::uint16_t>(crc);
}

template <class Value>
Value taken(const std::uint8_t* frame, std::size_t at) {
  Value value{};
  std::memcpy(&value, frame + at, sizeof value);
  return value;
}

bridge::wire::Vector vector_at(const std::uint8_t* frame, std::size_t at) {
  return {static_cast<double>(taken<float>(frame, at)),
          static_cast<double>(taken<float>(frame, at + 4)),
          static_cast<double>(taken<float>(frame, at + 8))};
}

class SerialBoard final : public bridge::Device {
 public:
  // Ends the program if there is no board.
  explicit SerialBoard(const char* path)
      : port_{open(path, O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)} {
    termios settings{};
    if (port_ < 0 || tcgetattr(port_, &settings) != 0) {
      std::perror(path);
      std::exit(1);
    }
    keep_others_out(path);
    cfmakeraw(&settings);
    tcsetattr(port_, TCSANOW, &settings);
    constexpr int attempts = 100;
    for (int i = 0; i < attempts && told_.max_force_n == 0.0; ++i) {
      send(Frame::introduction, {});
      pollfd waiting{port_, POLLIN, 0};
      poll(&waiting, 1, static_cast<int>(bridge::max_silence.count()));
      take_input();
    }
    if (told_.max_force_n == 0.0) {
      std::fprintf(stderr, "%s: no board introduces itself\n", path);
      std::exit(1);
    }
    if (told_.release_s == 0.0) {
      std::fprintf(stderr, "%s: the board does not release the force by itself\n", path);
      std::exit(1);
    }
  }
  ~SerialBoard() override { close(port_); }

  bridge::wire::Introduction introduction() override { return told_; }
  void exert(const bridge::wire::Vector& force_n) override {
    send(Frame::force_or_sample, force_n);
  }
  void sample(bridge::wire::Reply& reply) override {
    reply = newest_;
    reply.age_s = bridge::seconds_since(taken_at_);
    if (is_gone_) {
      reply.status &= ~bridge::wire::motors_on;
      bridge::put_text(reply.text, "the serial port of the board is gone");
    }
  }
  int descriptor() const override { return is_gone_ ? -1 : port_; }
  void take_input() override {
    std::array<std::uint8_t, 512> bytes{};
    ssize_t count = 0;
    while ((count = read(port_, bytes.data(), bytes.size())) > 0) {
      received_.insert(received_.end(), bytes.begin(), bytes.begin() + count);
      take_frames();
    }
    is_gone_ = is_gone_ || count == 0 || (errno != EAGAIN && errno != EINTR);
  }

 private:
  // Two programs that drive one board would exert each other's forces. The lock keeps out those
  // that ask for it, as a second bridge does whoever runs it, the terminal's mode all that open the
  // port but the superuser's.
  void keep_others_out(const char* path) {
    if (flock(port_, LOCK_EX | LOCK_NB) != 0) {
      std::fprintf(stderr, "%s: the serial port is in use by another program\n", path);
      std::exit(1);
    }
    ioctl(port_, TIOCEXCL);
  }
  void send(Frame kind, const bridge::wire::Vector& force_n) {
    std::array<std::uint8_t, 18> frame{sync[0], sync[1], static_cast<std::uint8_t>(kind),
                                       ++number_};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto part_n = static_cast<float>(force_n[i]);
      std::memcpy(frame.data() + 4 + 4 * i, &part_n, sizeof part_n);
    }
    const std::uint16_t crc = crc_of(frame.data() + 2, frame.size() - 4);
    std::memcpy(frame.data() + 16, &crc, sizeof crc);
    // a full port means a board that does not read: it releases the force by itself
    const ssize_t written = write(port_, frame.data(), frame.size());
    is_gone_ = is_gone_ || (written < 0 && errno != EAGAIN && errno != EINTR);
  }
  // Whatever is no whole frame is skipped, a byte at a time.
  void take_frames() {
    std::size_t at = 0;
    while (at + 3 <= received_.size()) {
      const std::uint8_t* const frame = received_.data() + at;
      const bool is_sample = frame[2] == static_cast<std::uint8_t>(Frame::force_or_sample);
      const std::size_t size = is_sample ? sample_bytes : introduction_bytes;
      if (frame[0] != sync[0] || frame[1] != sync[1] ||
          (!is_sample && frame[2] != static_cast<std::uint8_t>(Frame::introduction))) {
        ++at;
      } else if (at + size > received_.size()) {
        break;
      } else if (crc_of(frame + 2, size - 4) != taken<std::uint16_t>(frame, size - crc_bytes)) {
        ++at;
      } else {
        is_sample ? take_sample(frame) : take_introduction(frame);
        at += size;
      }
    }
    received_.erase(received_.begin(), received_.begin() + static_cast<std::ptrdiff_t>(at));
  }
  void take_sample(const std::uint8_t* frame) {
    newest_.sample = taken<std::uint32_t>(frame, 4);
    newest_.position_m = vector_at(frame, 8);
    newest_.velocity_m_s = vector_at(frame, 20);
    newest_.exerted_n = vector_at(frame, 32);
    newest_.buttons = taken<std::uint16_t>(frame, 44);
    newest_.status = taken<std::uint16_t>(frame, 46);
    newest_.orientation.fill(std::nan(""));
    newest_.exerted_n_m.fill(std::nan(""));
    // No newer than the first frame that the board had not heard: of one that is on its way still
    // it tells nothing.
    const std::uint8_t heard = frame[3];
    taken_at_ = bridge::Clock::now();
    if (heard != number_) {
      taken_at_ = std::min(taken_at_, sent_at_[static_cast<std::uint8_t>(heard + 1)]);
    }
  }
  void take_introduction(const std::uint8_t* frame) {
    told_.measured_axes = frame[4];
    told_.driven_axes = frame[5];
    told_.rate_hz = taken<std::uint16_t>(frame, 6);
    told_.release_s = 1e-3 * taken<std::uint16_t>(frame, 8);
    const bridge::wire::Vector limits = vector_at(frame, 10);
    told_.workspace_radius_m = limits[0];
    told_.max_force_n = limits[1];
    told_.max_stiffness_n_per_m = limits[2];
    bridge::put_text(told_.name, std::string{frame + 22, std::find(frame + 22, frame + 38, 0)});
    bridge::put_text(told_.serial_number,
                     std::string{frame + 38, std::find(frame + 38, frame + 54, 0)});
  }

  int port_;
  bool is_gone_ = false;
  std::uint8_t number_ = 0;                               // of the last frame
  std::array<bridge::Clock::time_point, 256> sent_at_{};  // by its number
  std::vector<std::uint8_t> received_;
  bridge::wire::Introduction told_;
  bridge::wire::Reply newest_;
  bridge::Clock::time_point taken_at_{};
};
}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fputs("usage: serial_board PORT DEVICE\n", stderr);
    return 2;
  }
  SerialBoard board{argv[2]};
  bridge::Server{std::atoi(argv[1]), board}.run();
}
