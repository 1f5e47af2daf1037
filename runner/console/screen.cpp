#include "runner/console/screen.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/error.hpp"
#include "core/files/data_url.hpp"
#include "runner/console/page_json.hpp"
namespace tapstudy::runner {
namespace {
Json json_of(const TooEarly& notice) {
  return {{"reason", name(notice.reason)},
          {"contacts", notice.min_contacts},
          {"labels", notice.labels},
          {"seconds", notice.min_seconds}};
}

Json json_of(const IntervalState& intervals) {
  return {{"phase", name(intervals.phase)}, {"replays_left", intervals.replays_left}};
}

Json json_of(const TrialScreen& trial) {
  return {
      {"number", trial.prompt.number},
      {"question", trial.prompt.block->question},
      {"asks_confidence", trial.prompt.block->confidence.has_value()},
      {"answers", answers_json(trial.prompt.answers)},
      {"previous", trial.prompt.previous ? answers_json(trial.prompt.previous->answers) : Json{}},
      {"correction", name(trial.correction)},
      {"alternatives", trial.prompt.alternative_labels},
      {"is_tapped_by_script", trial.prompt.block->explore.scripted_taps.has_value()},
      {"current", trial.current},
      {"setting", trial.setting},
      {"seconds_left", trial.seconds_left ? Json(*trial.seconds_left) : Json{}},
      {"intervals", trial.intervals ? json_of(*trial.intervals) : Json{}},
      {"notice", trial.notice ? json_of(*trial.notice) : Json{}}};
}

Json json_of(const protocols::Confidence& scale) {
  return {{"steps", scale.steps}, {"low", scale.low}, {"high", scale.high}};
}
Json json_of(const FeedbackScreen& feedback) {
  return {{"is_correct", feedback.is_correct}, {"right", feedback.right}};
}
Json picture_json(const std::optional<protocols::Picture>& picture) {
  return picture ? Json{{"url", core::data_url(picture->media_type, *picture->bytes)},
                        {"text", picture->text}}
                 : Json{};
}
Json options_of(const std::vector<protocols::Option>& options) {
  Json all = Json::array();
  for (const protocols::Option& option : options) {
    all.push_back({{"name", option.name},
                   {"label", option.label},
                   {"picture", picture_json(option.picture)}});
  }
  return all;
}
// A condition on another form has been met: the item would not be here.
Json json_of(const protocols::FormItem& item, const std::string& form) {
  Json json{{"name", item.name},
            {"kind", name(item.kind)},
            {"question", item.question},
            {"picture", picture_json(item.picture)},
            {"is_required", item.is_required},
            {"steps", item.steps},
            {"low", item.low},
            {"high", item.high},
            {"min", item.min},
            {"max", item.max},
            {"options", options_of(item.options)},
            {"ends_session", item.ends_session},
            {"asked_if", nullptr}};
  if (item.asked_if && item.asked_if->form == form) {
    json["asked_if"] = {{"item", item.asked_if->item}, {"is", item.asked_if->answers}};
  }
  return json;
}
Json json_of(const protocols::Form& form) {
  Json items = Json::array();
  for (const protocols::FormItem& item : form.items) {
    items.push_back(json_of(item, form.name));
  }
  return {{"title", form.title},
          {"text", form.text},
          {"picture", picture_json(form.picture)},
          {"items", items}};
}
Json json_of(int scene) {
  return scene;
}
template <class Value>
Json or_null(const std::optional<Value>& value) {
  return value ? json_of(*value) : Json{};
}

// An answer that ends the session comes alone.
bool are_accepted(const protocols::Form& form, const protocols::FormAnswers& answers) {
  if (const auto ending = item_that_ends(form, answers)) {
    return answers.size() == 1 && wrong_with(*ending, answers.at(ending->name)).empty();
  }
  std::size_t known = 0;
  const std::vector<protocols::FormItem> asked = asked_items(form, answers);
  const bool are_right = std::ranges::all_of(asked, [&](const protocols::FormItem& item) {
    const auto answer = answers.find(item.name);
    known += answer == answers.end() ? 0 : 1;
    return wrong_with(item, answer == answers.end() ? "" : answer->second).empty();
  });
  return are_right && known == answers.size();
}

// Numbers and texts, by name.
protocols::FormAnswers form_answers(const Json& json) {
  protocols::FormAnswers answers;
  for (const auto& [name, value] : json.get<std::map<std::string, Json>>()) {
    if (!value.is_string() && !value.is_number()) {
      throw core::InvalidInput{name + " is neither a number nor text"};
    }
    answers.emplace(name, value.is_string() ? value.get<std::string>() : value.dump());
  }
  return answers;
}

// A setting is answered as it is, not as it is on its way to be.
bool is_answer(const std::string& text, const TrialScreen& trial) {
  const auto answer = answer_in(text, trial.prompt.answers);
  return answer && (trial.prompt.answers.kind != protocols::AnswerKind::setting ||
                    *answer == std::to_string(trial.setting + 1));
}

bool can_replay(const IntervalState& intervals) {
  return intervals.phase == IntervalState::Phase::over && intervals.replays_left > 0;
}

// A message that only says what happened is read and dismissed.
bool can_be_dismissed(const Screen& screen) {
  return screen.kind == ScreenKind::message && screen.message != Message::operator_is_needed &&
         screen.message != Message::plate_is_mounted;
}
}  // namespace

bool accepts(const Screen& screen, const ScreenInput& input) {
  switch (input.action) {
    case ScreenAction::go_on:
      return screen.kind == ScreenKind::instructions || screen.kind == ScreenKind::rest ||
             screen.kind == ScreenKind::feedback || can_be_dismissed(screen);
    case ScreenAction::switch_to:
      return screen.trial && !screen.trial->intervals &&
             input.value < screen.trial->prompt.alternative_labels.size();
    case ScreenAction::replay:
      return screen.trial && screen.trial->intervals && can_replay(*screen.trial->intervals);
    case ScreenAction::adjust:
      return screen.trial && input.value < screen.trial->prompt.answers.settings;
    case ScreenAction::enter:
      return screen.trial && (input.text.empty() || is_answer(input.text, *screen.trial));
    case ScreenAction::answer:
      return screen.trial && is_answer(input.text, *screen.trial);
    case ScreenAction::correct:
      return screen.trial && screen.trial->prompt.previous &&
             answer_in(input.text, screen.trial->prompt.previous->answers);
    case ScreenAction::confidence:
      return screen.confidence && input.value >= 1 &&
             input.value <= static_cast<std::size_t>(screen.confidence->steps);
    case ScreenAction::form:
      return screen.form && are_accepted(*screen.form, input.answers);
  }
  return false;
}

ScreenInput parse_input(const std::string& text, std::int64_t& screen) {
  static const std::array<std::pair<std::string, ScreenAction>, 9> actions{
      {{"go_on", ScreenAction::go_on},
       {"switch", ScreenAction::switch_to},
       {"replay_intervals", ScreenAction::replay},
       {"adjust", ScreenAction::adjust},
       {"enter", ScreenAction::enter},
       {"answer", ScreenAction::answer},
       {"correct", ScreenAction::correct},
       {"confidence", ScreenAction::confidence},
       {"form", ScreenAction::form}}};
  try {
    const Json json = parse_json(text);
    const std::string action = json.at("action");
    const auto found = std::ranges::find(actions, action, &decltype(actions)::value_type::first);
    if (found == actions.end()) {
      throw core::InvalidInput{"'" + action + "' is not an action"};
    }
    screen = json.at("screen").get<std::int64_t>();
    if (found->second == ScreenAction::form) {
      return {found->second, 0, form_answers(json.at("value"))};
    }
    if (found->second == ScreenAction::enter || found->second == ScreenAction::answer ||
        found->second == ScreenAction::correct) {
      return {found->second, 0, {}, json.at("value").get<std::string>()};
    }
    const bool has_value =
        found->second != ScreenAction::go_on && found->second != ScreenAction::replay;
    const Json value = has_value ? json.at("value") : Json(0U);
    if (!value.is_number_unsigned()) {
      throw core::InvalidInput{"value is not a number"};
    }
    return {found->second, value.get<std::size_t>(), {}};
  } catch (const Json::exception&) {
    throw core::InvalidInput{"not an input of a screen"};
  }
}

std::string to_json(const Screen& screen, const ScreenContext& context) {
  const Json json{{"number", context.number},
                  {"language", context.language},
                  {"kind", name(screen.kind)},
                  {"title", context.title},
                  {"progress", screen.progress ? progress_json(*screen.progress) : Json{}},
                  {"text", screen.text},
                  {"picture", picture_json(screen.picture)},
                  {"message", name(screen.message)},
                  {"min_seconds", screen.min_seconds},
                  {"max_seconds", screen.max_seconds ? Json(*screen.max_seconds) : Json{}},
                  {"can_go_on", accepts(screen, {ScreenAction::go_on, 0, {}})},
                  {"trial", or_null(screen.trial)},
                  {"confidence", or_null(screen.confidence)},
                  {"feedback", or_null(screen.feedback)},
                  {"form", or_null(screen.form)},
                  {"scene", or_null(screen.scene)}};
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

const char* name(ScreenKind value) {
  using enum ScreenKind;
  switch (value) {
    case wait:
      return "wait";
    case instructions:
      return "instructions";
    case rest:
      return "rest";
    case trial:
      return "trial";
    case confidence:
      return "confidence";
    case feedback:
      return "feedback";
    case message:
      return "message";
    case form:
      return "form";
    case paused:
      return "paused";
    case ended:
      return "ended";
  }
  return "";
}

const char* name(Message value) {
  using enum Message;
  switch (value) {
    case none:
      return "";
    case practice_is_over:
      return "practice_is_over";
    case presented_again:
      return "presented_again";
    case skipped:
      return "skipped";
    case time_is_over:
      return "time_is_over";
    case comes_again:
      return "comes_again";
    case operator_is_needed:
      return "operator_is_needed";
    case plate_is_mounted:
      return "plate_is_mounted";
  }
  return "";
}

const char* name(TooEarly::Reason value) {
  using enum TooEarly::Reason;
  switch (value) {
    case intervals:
      return "intervals";
    case plate_untouched:
      return "plate_untouched";
    case alternatives_untouched:
      return "alternatives_untouched";
    case plate_unfelt:
      return "plate_unfelt";
    case alternatives_unfelt:
      return "alternatives_unfelt";
    case time:
      return "time";
  }
  return "";
}

const char* name(IntervalState::Phase value) {
  using enum IntervalState::Phase;
  switch (value) {
    case gap:
      return "gap";
    case leaving:
      return "leaving";
    case open:
      return "open";
    case over:
      return "over";
  }
  return "";
}

const char* name(CorrectionState value) {
  using enum CorrectionState;
  switch (value) {
    case none:
      return "";
    case stored:
      return "stored";
    case failed:
      return "failed";
  }
  return "";
}

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
