#pragma once
#include <cstdint>
#include <ranges>
#include <utility>
namespace tapstudy::core {

// PCG32 (O'Neill 2014). Engine and distributions are our own, because std::shuffle and the std
// distributions may differ between standard libraries, and a study must be reproducible from its
// seed anywhere.
class Rng {
 public:
  explicit Rng(std::uint64_t seed) noexcept {
    (*this)();
    state_ += seed;
    (*this)();
  }
  std::uint32_t operator()() noexcept {
    const std::uint64_t old = state_;
    state_ = old * 6364136223846793005ULL + 1442695040888963407ULL;
    const auto xorshifted = static_cast<std::uint32_t>(((old >> 18U) ^ old) >> 27U);
    const auto rot = static_cast<std::uint32_t>(old >> 59U);
    return (xorshifted >> rot) | (xorshifted << ((32U - rot) & 31U));
  }
  // uniform in [0, n), n > 0; unbiased (by rejection)
  std::uint32_t below(std::uint32_t n) noexcept {
    const std::uint32_t threshold = (0U - n) % n;
    for (;;) {
      const std::uint32_t r = (*this)();
      if (r >= threshold) {
        return r % n;
      }
    }
  }
  // uniform in [0, 1), 53 random bits
  double uniform() noexcept;
  // standard normal (Box & Muller 1958, polar form of Marsaglia & Bray 1964; the second of each
  // pair is discarded so that a draw depends on the engine's state alone)
  double normal() noexcept;
  // log-normal with the given median; spread is the standard deviation of its logarithm
  double log_normal(double median, double spread) noexcept;

  template <std::ranges::random_access_range Items>
  void shuffle(Items&& items) noexcept {
    for (auto i = std::ranges::size(items); i > 1; --i) {
      std::swap(items[i - 1], items[below(static_cast<std::uint32_t>(i))]);
    }
  }

 private:
  std::uint64_t state_{0};
};

// The purpose of a random stream: streams of different purposes are independent, so that a change
// in one (a longer schedule) leaves the others (the hand's taps) unchanged.
enum class Purpose : std::uint64_t {
  schedule = 1,
  labels,
  hand,
  observer,
  memory,
  participant,
  counterbalancing,
  person,
  masking,
  catch_trials,
  procedure,
  interleaving,
  study,
  resampling,
  block_order,
  square_order,
  groups,
  mixed_blocks
};

// The seed of one stream of a study. Mixes by the finaliser of SplitMix64 (Steele et al. 2014).
std::uint64_t derived_seed(std::uint64_t seed, Purpose purpose, std::uint64_t index = 0) noexcept;
}  // namespace tapstudy::core
