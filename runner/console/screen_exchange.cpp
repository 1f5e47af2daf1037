#include "runner/console/screen_exchange.hpp"

#include <algorithm>
#include <utility>
namespace tapstudy::runner {
std::int64_t ScreenExchange::show(const Screen& screen) {
  const std::lock_guard lock{mutex_};
  screen_ = screen;
  input_.reset();
  is_taken_ = false;
  is_closed_ = false;
  return ++number_;
}

std::optional<ScreenInput> ScreenExchange::take(std::int64_t number) {
  const std::lock_guard lock{mutex_};
  if (number != number_ || !input_ || is_taken_) {
    return std::nullopt;
  }
  is_taken_ = true;
  return input_;
}

std::optional<std::string> ScreenExchange::take_entered() {
  const std::lock_guard lock{mutex_};
  return std::exchange(entered_, {});
}

std::optional<ScreenInput> ScreenExchange::close() {
  const std::lock_guard lock{mutex_};
  is_closed_ = true;
  const bool is_pending = input_ && !is_taken_;
  is_taken_ = true;
  return is_pending ? input_ : std::nullopt;
}

ScreenExchange::Shown ScreenExchange::shown() const {
  const std::lock_guard lock{mutex_};
  return {number_, to_json(screen_, {number_, language_, title_}), screen_.scene};
}

std::int64_t ScreenExchange::number() const {
  const std::lock_guard lock{mutex_};
  return number_;
}

std::string ScreenExchange::post(std::int64_t number, const ScreenInput& input) {
  const std::lock_guard lock{mutex_};
  if (number != number_ || (is_closed_ && !input_)) {
    return "the screen has changed";
  }
  if (!accepts(screen_, input)) {
    return "this screen has no such answer";
  }
  if (input.action == ScreenAction::enter && !input_) {
    entered_ = input.text;
    return "";
  }
  if (input_) {
    return *input_ == input ? "" : "this screen is answered already";
  }
  input_ = input;
  return "";
}

void ScreenExchange::page_is_alive(std::chrono::steady_clock::time_point now) {
  const std::lock_guard lock{mutex_};
  alive_at_ = now;
}

void ScreenExchange::page_opened(std::chrono::steady_clock::time_point now) {
  const std::lock_guard lock{mutex_};
  ++open_pages_;
  if (alive_at_) {
    alive_at_ = now;
  }
}

void ScreenExchange::page_closed(std::chrono::steady_clock::time_point now) {
  const std::lock_guard lock{mutex_};
  --open_pages_;
  closed_at_ = now;
}

std::chrono::steady_clock::time_point ScreenExchange::last_seen(
    std::chrono::steady_clock::time_point now) const {
  const std::lock_guard lock{mutex_};
  const auto sign = alive_at_.value_or(now);
  return open_pages_ > 0 ? sign : std::min(sign, closed_at_);
}

int ScreenExchange::open_pages() const {
  const std::lock_guard lock{mutex_};
  return open_pages_;
}
}  // namespace tapstudy::runner
