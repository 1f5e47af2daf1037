#pragma once
#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "runner/console/operator_view.hpp"
#include "runner/console/scenes.hpp"
#include "runner/console/screen.hpp"
#include "runner/session/operators/operator_desk.hpp"
namespace tapstudy::runner {
// A file of the pages, as it is in this program.
struct Page {
  std::string_view name;
  std::string_view content;
  std::string_view media_type;
};
// nullptr if there is none of that name.
const Page* find_page(std::string_view name);
// Whether the pages' own words are given in it (two letters).
bool pages_speak(std::string_view language);

enum class Role { participant, operator_of_session };
inline constexpr std::array roles{Role::participant, Role::operator_of_session};

struct Reply {
  int status{200};
  std::string_view media_type{"application/json"};
  std::string body;
};

// What was last sent to an open page.
struct SentToPage {
  std::int64_t screen{-1};
  std::optional<int> scene{};
  std::int64_t pointer_tick{-1};
  std::int64_t steps{-1};
  std::string state;
  std::chrono::steady_clock::time_point state_at{};
};

// Of a session: what its pages ask for and send, whatever carries it. May be called from any
// thread.
class ConsoleApi {
 public:
  struct Session {
    std::string title;
    std::string participant_id;
    std::string mode;
    std::string device;
    bool is_blind{};                          // for the operator, too
    std::function<std::string()> state;       // of the session, now
    std::function<std::string()> last_fault;  // empty: none
    std::function<std::optional<MaskingInView>()> masking;
  };
  ConsoleApi(Session session, ScreenExchange& screens, OperatorDesk& desk, const LiveView& live,
             const Scenes& scenes)
      : session_{std::move(session)},
        screens_{screens},
        desk_{desk},
        live_{live},
        scenes_{scenes} {}

  // `path` is what follows the token: "", "style.css", "scene/0".
  Reply get(Role role, const std::string& path) const;
  Reply post_input(Role role, const std::string& body);
  Reply post_alive(Role role);
  // Server-sent events of what has changed since; empty if nothing has.
  std::string events(Role role, SentToPage& sent) const;
  // The same for the operator's terminal; the live line is of what has changed since `end`, at most
  // a second of it, and moves `end` on.
  std::string status() const;
  std::string live(std::int64_t& end) const;
  void page_opened(Role role);
  void page_closed(Role role);

 private:
  std::string participant_events(SentToPage& sent) const;
  std::string operator_events(SentToPage& sent) const;
  SessionInView session_in_view() const;
  Session session_;
  ScreenExchange& screens_;
  OperatorDesk& desk_;
  const LiveView& live_;
  const Scenes& scenes_;
};
}  // namespace tapstudy::runner
