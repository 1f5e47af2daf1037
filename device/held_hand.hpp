#pragma once
#include <optional>

#include "core/haptic_state.hpp"
namespace tapstudy::device {
// So many replies in a row may be missing before it is a fault; the loop lets force fade meanwhile.
inline constexpr int max_missed_replies = 3;
// In the long run a tenth may be missing: each counts for ten, and 20 at once are too many.
inline constexpr int replies_for_a_missed_one = 10;
inline constexpr int max_missed_in_debt = 20;

// The hand as last read, which stands in for a reply that is missing.
class HeldHand {
 public:
  void forget() noexcept {
    hand_.reset();
    missed_replies_ = 0;
    debt_ = 0;
  }
  void keep(const core::HandState& hand) noexcept {
    hand_ = hand;
    missed_replies_ = 0;
    debt_ -= debt_ > 0 ? 1 : 0;
  }
  // False where nothing is known, or has stood in for too long.
  bool use_last_reading(core::HandState& hand) noexcept {
    if (!hand_ || missed_replies_ == max_missed_replies ||
        debt_ >= replies_for_a_missed_one * max_missed_in_debt) {
      return false;
    }
    ++missed_replies_;
    debt_ += replies_for_a_missed_one;
    hand = *hand_;
    return true;
  }
  bool is_known() const noexcept { return hand_.has_value(); }
  int missed_replies() const noexcept { return missed_replies_; }

 private:
  std::optional<core::HandState> hand_;
  int missed_replies_{0};
  int debt_{0};  // in replies
};
}  // namespace tapstudy::device
