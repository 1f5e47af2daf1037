#pragma once
#include <chrono>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>

#include "runner/console/screen.hpp"
namespace tapstudy::runner {
// Between the session, which shows screens, and the server's threads, which take what is done with
// them. An input belongs to one screen: what comes for an earlier one, or a second time, is
// refused.
class ScreenExchange {
 public:
  ScreenExchange(std::string language, std::string title)
      : language_{std::move(language)}, title_{std::move(title)} {}

  // The session's thread. Returns the screen's number.
  std::int64_t show(const Screen& screen);
  std::optional<ScreenInput> take(std::int64_t number);
  // What was entered last, and not taken yet: empty if that was withdrawn.
  std::optional<std::string> take_entered();
  // Takes no more input for the screen that is shown; what was accepted already is returned.
  std::optional<ScreenInput> close();

  // Any thread.
  struct Shown {
    std::int64_t number{};
    std::string json;
    std::optional<int> scene;
  };
  Shown shown() const;
  std::int64_t number() const;
  // Empty: accepted; otherwise why not. The same input again, of the same screen, is accepted.
  // What is only entered answers nothing: more of it may follow, and an answer.
  std::string post(std::int64_t number, const ScreenInput& input);
  // A page that says so now and then is gone once it is silent, though its connection is open.
  void page_is_alive(std::chrono::steady_clock::time_point now);
  void page_opened(std::chrono::steady_clock::time_point now);
  void page_closed(std::chrono::steady_clock::time_point now);
  // When there was last a sign of somebody who may be looking: now, if a page is open that never
  // says so.
  std::chrono::steady_clock::time_point last_seen(std::chrono::steady_clock::time_point now) const;
  int open_pages() const;

 private:
  std::string language_;
  std::string title_;
  mutable std::mutex mutex_;
  Screen screen_;
  std::int64_t number_{0};
  std::optional<ScreenInput> input_;
  std::optional<std::string> entered_;
  bool is_taken_{false};
  bool is_closed_{false};
  int open_pages_{0};
  std::optional<std::chrono::steady_clock::time_point> alive_at_;
  std::chrono::steady_clock::time_point closed_at_;
};
}  // namespace tapstudy::runner
