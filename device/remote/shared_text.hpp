#pragma once
#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
namespace tapstudy::device {
// A short text that the haptic thread replaces and other threads read: a sequence lock (Boehm, Can
// seqlocks get along with programming language memory models?, MSPC 2012). The writer never waits;
// a reader tries again where the text changed meanwhile.
template <std::size_t Size>
class SharedText {
  static_assert(Size % sizeof(std::uint64_t) == 0);

 public:
  using Characters = std::array<char, Size>;  // ends in a zero
  // By one thread.
  void set(const Characters& text) noexcept {
    if (text == written_) {
      return;
    }
    written_ = text;
    const auto words = std::bit_cast<std::array<std::uint64_t, word_count>>(text);
    const std::uint32_t version = version_.load(std::memory_order_relaxed);
    version_.store(version + 1, std::memory_order_relaxed);  // odd: it is being written
    std::atomic_thread_fence(std::memory_order_release);
    for (std::size_t i = 0; i < word_count; ++i) {
      words_[i].store(words[i], std::memory_order_relaxed);
    }
    version_.store(version + 2, std::memory_order_release);
  }
  // By any.
  std::string get() const {
    std::array<std::uint64_t, word_count> words{};
    std::uint32_t before = 0;
    std::uint32_t after = 0;
    do {
      before = version_.load(std::memory_order_acquire);
      for (std::size_t i = 0; i < word_count; ++i) {
        words[i] = words_[i].load(std::memory_order_relaxed);
      }
      std::atomic_thread_fence(std::memory_order_acquire);
      after = version_.load(std::memory_order_relaxed);
    } while (before != after || before % 2 == 1);
    return std::bit_cast<Characters>(words).data();
  }

 private:
  static constexpr std::size_t word_count = Size / sizeof(std::uint64_t);
  Characters written_{};
  std::array<std::atomic<std::uint64_t>, word_count> words_{};
  std::atomic<std::uint32_t> version_{0};
};
}  // namespace tapstudy::device
