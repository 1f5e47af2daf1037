#include "runner/console/console_api.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "results/store_error.hpp"
#include "runner/console/operator_view.hpp"
#include "runner/terminal/typed_input.hpp"
namespace tapstudy::runner {
namespace {
struct Embedded {
  const char* name;
  const char* begin;
  const char* end;
};
#include "embedded_pages.inc"

std::string_view media_type(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 5> types{
      {{".html", "text/html; charset=utf-8"},
       {".css", "text/css; charset=utf-8"},
       {".js", "text/javascript; charset=utf-8"},
       {".json", "application/json"},
       {".svg", "image/svg+xml"}}};
  const auto found =
      std::ranges::find_if(types, [&](const auto& type) { return name.ends_with(type.first); });
  return found == types.end() ? "application/octet-stream" : found->second;
}
}  // namespace

const Page* find_page(std::string_view name) {
  static const std::vector<Page> pages = [] {
    std::vector<Page> all;
    for (const Embedded& file : embedded) {
      all.push_back({file.name, {file.begin, file.end}, media_type(file.name)});
    }
    return all;
  }();
  const auto found = std::ranges::find(pages, name, &Page::name);
  return found == pages.end() ? nullptr : &*found;
}

bool pages_speak(std::string_view language) {
  const std::string_view words = find_page("messages.json")->content;
  return words.find("\"" + std::string{language} + "\": {") != std::string_view::npos;
}

namespace {
Reply not_found() {
  return {404, "text/plain; charset=utf-8", "There is nothing here.\n"};
}

Reply outcome(const std::string& why_not) {
  return why_not.empty() ? Reply{200, "application/json", R"({"accepted":true})"}
                         : Reply{409, "application/json", refusal_json(why_not)};
}

std::string event(const char* name, const std::string& data) {
  return fmt::format("event: {}\ndata: {}\n\n", name, data);
}
}  // namespace

Reply ConsoleApi::get(Role role, const std::string& path) const {
  constexpr std::string_view scene = "scene/";
  if (path.starts_with(scene)) {
    const auto number = whole_number(path.substr(scene.size()), 0, scenes_.count() - 1);
    return number ? Reply{200, "application/json", scenes_.json(*number)} : not_found();
  }
  const char* const own = role == Role::participant ? "participant.html" : "operator.html";
  const Page* const page = find_page(path.empty() ? own : path);
  return page == nullptr ? not_found() : Reply{200, page->media_type, std::string{page->content}};
}

Reply ConsoleApi::post_input(Role role, const std::string& body) {
  try {
    if (role == Role::participant) {
      std::int64_t screen = -1;
      const ScreenInput input = parse_input(body, screen);
      return outcome(screens_.post(screen, input));
    }
    desk_.post(parse_operator_command(command_in(body))).stored.get();
    return outcome("");
  } catch (const core::InvalidInput& error) {
    return outcome(error.what());
  } catch (const results::StoreError& error) {
    return outcome(fmt::format("not stored: {}", error.what()));
  }
}

Reply ConsoleApi::post_alive(Role role) {
  if (role == Role::participant) {
    screens_.page_is_alive(std::chrono::steady_clock::now());
  }
  return outcome("");
}

void ConsoleApi::page_opened(Role role) {
  if (role == Role::participant) {
    screens_.page_opened(std::chrono::steady_clock::now());
  }
}

void ConsoleApi::page_closed(Role role) {
  if (role == Role::participant) {
    screens_.page_closed(std::chrono::steady_clock::now());
  }
}

std::string ConsoleApi::events(Role role, SentToPage& sent) const {
  return role == Role::participant ? participant_events(sent) : operator_events(sent);
}

std::string ConsoleApi::participant_events(SentToPage& sent) const {
  std::string text;
  if (screens_.number() != sent.screen) {
    const ScreenExchange::Shown shown = screens_.shown();
    sent.screen = shown.number;
    sent.scene = shown.scene;
    text += event("screen", shown.json);
  }
  const LiveView::Pointer pointer = live_.pointer();
  if (sent.scene && pointer.tick != sent.pointer_tick) {
    sent.pointer_tick = pointer.tick;
    const core::Vec3 at = scenes_.to_scene(*sent.scene, pointer.position_m);
    text += event("hand", fmt::format(R"({{"p":[{:.5f},{:.5f},{:.5f}],"t":{}}})", at.x(), at.y(),
                                      at.z(), pointer.is_touching));
  }
  return text;
}

std::string ConsoleApi::operator_events(SentToPage& sent) const {
  std::string text;
  constexpr std::chrono::milliseconds state_interval{200};
  const auto now = std::chrono::steady_clock::now();
  if (now - sent.state_at >= state_interval) {
    sent.state_at = now;
    if (std::string state = state_json(session_in_view(), desk_.view(), live_.totals());
        state != sent.state) {
      text += event("state", state);
      sent.state = std::move(state);
    }
  }
  const LiveView::Steps steps = live_.since(sent.steps);
  if (!steps.steps.empty()) {
    sent.steps = steps.end;
    text += event("live", live_json(steps, live_.totals(), scenes_.surface_along_normal_m(),
                                    scenes_.placement()));
  }
  return text;
}

SessionInView ConsoleApi::session_in_view() const {
  return {session_.title,        session_.participant_id,   session_.mode,
          session_.device,       session_.is_blind,         session_.state(),
          session_.last_fault(), screens_.open_pages() > 0, session_.masking()};
}

std::string ConsoleApi::status() const {
  return status_text(session_in_view(), desk_.view(), live_.totals());
}

std::string ConsoleApi::live(std::int64_t& end) const {
  constexpr std::int64_t second = static_cast<std::int64_t>(1.0 / LiveView::step_s);
  const std::int64_t newest = live_.since(end).end;
  const LiveView::Steps steps = live_.since(std::max(end, newest - second));
  end = newest;
  return live_line(steps, live_.totals(), scenes_.surface_along_normal_m());
}
}  // namespace tapstudy::runner
