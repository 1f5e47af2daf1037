#include "runner/commands/amend_form.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <ctime>
#include <optional>
#include <set>
#include <vector>

#include "core/error.hpp"
#include "core/text/plain_text.hpp"
#include "protocols/form.hpp"
#include "results/store/form_amendments.hpp"
#include "runner/session/engine/session_row.hpp"
#include "runner/studies/stored_study.hpp"
#include "runner/terminal/session_lock.hpp"
namespace tapstudy::runner {
namespace {
constexpr std::string_view correct_word{"correct "};

struct FormCorrection {
  std::string form;
  std::string item;
  std::string asked;  // empty: where it was asked
  std::string answer;
};

// "about.age@session begin" is cut at the point that has a form before it and its item behind it,
// because names may hold points; a place may hold spaces, so the answer begins after the place that
// is one.
const protocols::FormItem* item_named(const protocols::Protocol& protocol, const std::string& name,
                                      FormCorrection& correction) {
  for (const auto& [form_name, form] : protocol.forms) {
    if (!name.starts_with(form_name + ".")) {
      continue;
    }
    const std::string item = name.substr(form_name.size() + 1);
    const auto found = std::ranges::find(form.items, item, &protocols::FormItem::name);
    if (found != form.items.end()) {
      correction.form = form_name;
      correction.item = item;
      return &*found;
    }
  }
  std::vector<std::string> forms;
  for (const auto& [form_name, form] : protocol.forms) {
    forms.push_back(form_name);
  }
  throw core::InvalidInput{
      fmt::format("'{}': no form has such an item (correct FORM.ITEM ANSWER; forms: {})", name,
                  fmt::join(forms, ", "))};
}

const protocols::FormItem& item_of(const protocols::Protocol& protocol, const std::string& action,
                                   FormCorrection& correction) {
  std::string rest = core::trimmed(action.substr(correct_word.size()));
  const auto end = std::min(rest.find_first_of(" @"), rest.size());
  const protocols::FormItem* const item = item_named(protocol, rest.substr(0, end), correction);
  rest = rest.substr(end);
  if (rest.starts_with('@')) {
    std::vector<std::string> places{"session begin", "session end"};
    for (const protocols::Block& block : protocol.blocks) {
      places.push_back(block.name);
    }
    const auto place = std::ranges::find_if(
        places, [&](const std::string& one) { return rest.starts_with("@" + one + " "); });
    if (place == places.end()) {
      throw core::InvalidInput{fmt::format("after @ stands where the form was asked, one of: {}",
                                           fmt::join(places, ", "))};
    }
    correction.asked = *place;
    rest = rest.substr(place->size() + 1);
  }
  correction.answer = core::trimmed(rest);
  return *item;
}

bool is_about(const std::optional<protocols::AnswerCondition>& condition,
              const FormCorrection& correction) {
  return condition && condition->form == correction.form && condition->item == correction.item;
}

// Empty: nothing depends on it.
std::string what_depends_on(const protocols::Protocol& protocol, const protocols::FormItem& item,
                            const FormCorrection& correction) {
  if (!item.ends_session.empty()) {
    return "whether the participant takes part";
  }
  for (const protocols::Block& block : protocol.blocks) {
    if (is_about(block.presented_if, correction)) {
      return fmt::format("whether block '{}' is presented", block.name);
    }
  }
  for (const auto& [name, form] : protocol.forms) {
    for (const protocols::FormItem& other : form.items) {
      if (is_about(other.asked_if, correction)) {
        return fmt::format("whether '{}' of form '{}' is asked", other.name, name);
      }
    }
  }
  return "";
}

// The latest answer that holds.
results::FormAmendment amendment_of(results::Store& store, const std::string& participant,
                                    const FormCorrection& correction) {
  std::set<std::string> places;
  std::optional<results::FormAmendment> found;
  results::Statement row = store.query(
      std::string{"SELECT session_id, asked, answer FROM "} + results::current_form_answer +
      " JOIN session USING (session_id) WHERE participant_id = ? AND form = ? AND item = ? "
      "AND (? = '' OR asked = ?) ORDER BY form_answer.rowid");
  row.bind(participant).bind(correction.form).bind(correction.item);
  row.bind(correction.asked).bind(correction.asked);
  while (row.step()) {
    places.insert(row.text(1));
    found = results::FormAmendment{
        row.integer(0),   0.0, correction.form, row.text(1), correction.item, row.optional_text(2),
        correction.answer};
  }
  if (!found) {
    throw core::InvalidInput{fmt::format("participant '{}' was not asked '{}' of form '{}'{}",
                                         participant, correction.item, correction.form,
                                         correction.asked.empty() ? "" : " there")};
  }
  if (places.size() > 1) {
    throw core::InvalidInput{fmt::format("which answer? \"correct {}.{}@PLACE …\" (one of: {})",
                                         correction.form, correction.item,
                                         fmt::join(places, ", "))};
  }
  return *found;
}

double seconds_since_begin(results::Store& store, std::int64_t session_id) {
  const auto sessions = store.sessions();
  const auto session = std::ranges::find(sessions, session_id, &results::SessionRow::id);
  return std::max(0.0, std::difftime(std::time(nullptr), time_from(session->started_utc)));
}

FormCorrection checked_correction(const protocols::Protocol& protocol, const std::string& action) {
  FormCorrection correction;
  const protocols::FormItem& item = item_of(protocol, action, correction);
  const std::string wrong = correction.answer.empty() ? std::string{"which answer?"}
                                                      : wrong_with(item, correction.answer);
  if (!wrong.empty()) {
    throw core::InvalidInput{
        fmt::format("'{}' of form '{}': {}", item.name, correction.form, wrong)};
  }
  const std::string depends = what_depends_on(protocol, item, correction);
  if (!depends.empty()) {
    throw core::InvalidInput{fmt::format(
        "'{}' of form '{}' decided {}, which a correction does not undo: add a note instead",
        item.name, correction.form, depends)};
  }
  return correction;
}
}  // namespace

bool corrects_form(const std::string& action) {
  const std::string command = core::trimmed(action);
  const std::string rest = command.starts_with(correct_word)
                               ? core::trimmed(command.substr(correct_word.size()))
                               : std::string{};
  const std::string word = rest.substr(0, rest.find_first_of(" @"));
  return word.find('.') != std::string::npos && !core::number_in<double>(word);
}

std::string amend_form(const std::string& directory, const std::string& participant,
                       const std::string& action) {
  results::StudyRow study;
  FormCorrection correction;
  {  // before anything is written, to the journal either
    results::Store store = results::Store::open_existing(directory);
    study = store.study();
    correction = checked_correction(checked_protocol(store), core::trimmed(action));
    amendment_of(store, participant, correction);
  }
  const ParticipantLock lock{directory, participant};
  results::Store store = results::Store::open_or_create(directory, study);
  results::FormAmendment amendment = amendment_of(store, participant, correction);
  if (amendment.before == amendment.after) {
    throw core::InvalidInput{fmt::format("'{}' of form '{}' is {} already", amendment.item,
                                         amendment.form, amendment.after)};
  }
  amendment.t_s = seconds_since_begin(store, amendment.session_id);
  store.add_operator_action(action_of(store, amendment));
  return fmt::format("'{}' of form '{}' ({}): {}, corrected to {}", amendment.item, amendment.form,
                     amendment.asked, amendment.before.value_or("left out"), amendment.after);
}
}  // namespace tapstudy::runner
