#pragma once
#include <fcntl.h>
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <deque>
#include <limits>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "support/catch.hpp"
namespace tapstudy::testing {
// CRC-16/CCITT-FALSE by its definition: the remainder of the message's polynomial, bit by bit.
inline std::uint16_t remainder_of(const std::vector<std::uint8_t>& bytes) {
  std::uint32_t rest = 0xFFFF;
  for (const std::uint8_t byte : bytes) {
    for (unsigned bit = 0x80; bit != 0; bit >>= 1U) {
      const bool is_set = ((rest & 0x8000U) != 0) != ((byte & bit) != 0);
      rest = ((rest << 1U) & 0xFFFFU) ^ (is_set ? 0x1021U : 0U);
    }
  }
  return static_cast<std::uint16_t>(rest);
}

// A microcontroller at the other end of a pseudo-terminal. It answers each frame with a sample, so
// that no time is measured.
class MockBoard {
 public:
  MockBoard() : master_{posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC)} {
    REQUIRE(grantpt(master_) == 0);
    REQUIRE(unlockpt(master_) == 0);
    path_ = ptsname(master_);
    slave_ = ::open(path_.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);  // a hang-up is ours to cause
    obeying_ = std::thread{[this] { obey(); }};
  }
  ~MockBoard() { unplug(); }
  MockBoard(const MockBoard&) = delete;
  MockBoard& operator=(const MockBoard&) = delete;
  MockBoard(MockBoard&&) = delete;
  MockBoard& operator=(MockBoard&&) = delete;
  const std::string& path() const { return path_; }
  float force_n() const { return force_n_; }
  // The board lets go by itself 20 ms after the last frame.
  float exerted_n() const {
    return Clock::now().time_since_epoch().count() - heard_at_ > max_silence ? 0.0F
                                                                             : force_n_.load();
  }
  // Of those sent since the last call.
  float largest_force_n() { return largest_n_.exchange(0.0F); }
  void tremble() { tremor_m_ = 1e-4F; }
  void stand_still() { tremor_m_ = 0.0F; }
  // Noise on the line before each frame, and a frame in which one bit is wrong.
  void be_noisy() { is_noisy_ = true; }
  void fall_silent() { is_silent_ = true; }
  void lose_position() { is_lost_ = true; }
  void jump_in_numbers() { stride_ = 1'000'000; }  // with every sample
  void answer_every_other() { answers_every_other_ = true; }
  // Exerts, and tells, what it does now, whatever it is sent.
  void hold() { is_holding_ = true; }
  // Tells what it exerted so many milliseconds ago, which pass as the test says.
  void tell_force_late(std::size_t ms) { told_late_ms_ = ms; }
  void pass_ms() {
    const std::lock_guard lock{of_exerted_};
    exerted_n_.push_front(force_n_);
    exerted_n_.resize(std::min<std::size_t>(exerted_n_.size(), 100));
  }
  float told_force_n() {
    const std::lock_guard lock{of_exerted_};
    const std::size_t late_ms = std::min(told_late_ms_.load(), exerted_n_.size());
    return late_ms == 0 ? force_n_.load() : exerted_n_.at(late_ms - 1);
  }
  void unplug() {
    if (obeying_.joinable()) {
      is_over_ = true;
      const std::array<std::uint8_t, 18> wakes{};
      static_cast<void>(!write(slave_, wakes.data(), wakes.size()));
      obeying_.join();
      close(slave_);
      close(master_);
    }
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr Clock::rep max_silence =
      std::chrono::nanoseconds{std::chrono::milliseconds{20}}.count();
  using Bytes = std::vector<std::uint8_t>;
  static constexpr std::size_t frame_bytes = 18;
  template <class Value>
  static void add(Bytes& frame, Value value) {
    std::array<std::uint8_t, sizeof value> bytes{};
    std::memcpy(bytes.data(), &value, sizeof value);
    frame.insert(frame.end(), bytes.begin(), bytes.end());
  }
  void send(const Bytes& content) {
    Bytes frame{0xA5, 0x5A};
    frame.insert(frame.end(), content.begin(), content.end());
    add(frame, remainder_of(content));
    if (is_noisy_) {
      Bytes spoilt{0x00, 0xA5, 0xA5, 0x5A, 0x07};
      spoilt.insert(spoilt.end(), frame.begin(), frame.end());
      spoilt.back() ^= 0x10U;
      spoilt.at(5 + 14) ^= 0x40U;
      frame.insert(frame.begin(), spoilt.begin(), spoilt.end());
    }
    static_cast<void>(!write(master_, frame.data(), frame.size()));
  }
  void introduce() {
    Bytes content{2, 0, 3, 3};
    add(content, std::uint16_t{1000});
    add(content, std::uint16_t{20});
    for (const float limit : {0.06F, 3.0F, 2000.0F}) {
      add(content, limit);
    }
    for (const char* const text : {"desk arm", "A7"}) {
      Bytes field(16);
      std::memcpy(field.data(), text, std::strlen(text));
      content.insert(content.end(), field.begin(), field.end());
    }
    send(content);
  }
  void send_sample() {
    constexpr float not_measured = std::numeric_limits<float>::quiet_NaN();
    Bytes content{1, heard_number_};
    const std::uint32_t sample = sample_ += stride_;
    add(content, sample);
    const float position_m = is_lost_ ? not_measured : 0.02F;
    const float tremor_m = tremor_m_ * std::sin(0.06F * static_cast<float>(sample));
    for (const float value : {0.01F + tremor_m, position_m, 0.03F, not_measured, not_measured,
                              not_measured, 0.0F, told_force_n(), 0.0F}) {
      add(content, value);
    }
    add(content, std::uint16_t{5});
    add(content, std::uint16_t{1});
    send(content);
  }
  void obey() {
    Bytes received;
    std::array<std::uint8_t, 256> bytes{};
    while (!is_over_) {
      const ssize_t count = read(master_, bytes.data(), bytes.size());
      if (count <= 0) {
        return;
      }
      received.insert(received.end(), bytes.begin(), bytes.begin() + count);
      take_frames(received);
    }
  }
  // Whatever is no whole frame is skipped, a byte at a time: a port that is full takes a part of
  // one.
  void take_frames(Bytes& received) {
    std::size_t at = 0;
    while (at + frame_bytes <= received.size()) {
      const std::uint8_t* const frame = received.data() + at;
      std::uint16_t crc = 0;
      std::memcpy(&crc, frame + 16, sizeof crc);
      if (frame[0] != 0xA5 || frame[1] != 0x5A || crc != remainder_of({frame + 2, frame + 16})) {
        ++at;
        continue;
      }
      if (!is_silent_) {
        take_frame(frame);
      }
      at += frame_bytes;
    }
    received.erase(received.begin(), received.begin() + static_cast<std::ptrdiff_t>(at));
  }
  void take_frame(const std::uint8_t* frame) {
    float force_n = 0.0F;
    std::memcpy(&force_n, frame + 8, sizeof force_n);
    heard_at_ = Clock::now().time_since_epoch().count();
    heard_number_ = frame[3];
    const bool is_force = frame[2] == 1;
    force_n_ = is_force && !is_holding_ ? force_n : force_n_.load();
    largest_n_ = std::max(largest_n_.load(), force_n_.load());
    if (!is_force) {
      introduce();
    } else if (!answers_every_other_ || ++asked_ % 2 == 0) {
      send_sample();
    }
  }

  int master_;
  int slave_{-1};
  std::string path_;
  std::atomic<float> force_n_{0.0F};
  std::atomic<float> largest_n_{0.0F};
  std::atomic<float> tremor_m_{0.0F};
  std::atomic<Clock::rep> heard_at_{0};
  std::atomic<bool> is_noisy_{false};
  std::atomic<bool> is_silent_{false};
  std::atomic<bool> is_over_{false};
  std::atomic<bool> is_lost_{false};
  std::atomic<bool> is_holding_{false};
  std::atomic<bool> answers_every_other_{false};
  int asked_{0};
  std::uint8_t heard_number_{0};
  std::atomic<std::size_t> told_late_ms_{0};
  std::mutex of_exerted_;
  std::deque<float> exerted_n_;  // in the last milliseconds, the newest first
  std::uint32_t sample_{0};
  std::atomic<std::uint32_t> stride_{1};
  std::thread obeying_;
};
}  // namespace tapstudy::testing
