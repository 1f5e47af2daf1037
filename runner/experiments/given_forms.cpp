#include "runner/experiments/given_forms.hpp"

#include <algorithm>
#include <map>

#include "protocols/nasa_tlx.hpp"
#include "results/stored_answers.hpp"
#include "runner/session/between_trials.hpp"
namespace tapstudy::runner {
namespace {
analysis::QuestionnaireKind kind_of(protocols::ItemKind kind) {
  switch (kind) {
    case protocols::ItemKind::likert:
      return analysis::QuestionnaireKind::steps;
    case protocols::ItemKind::scale:
    case protocols::ItemKind::number:
      return analysis::QuestionnaireKind::number;
    case protocols::ItemKind::single_choice:
      return analysis::QuestionnaireKind::choice;
    case protocols::ItemKind::text:
      break;
  }
  return analysis::QuestionnaireKind::text;
}

analysis::QuestionnaireItem item_of(const protocols::FormItem& item) {
  analysis::QuestionnaireItem made{item.name, kind_of(item.kind), item.question};
  for (const protocols::Option& option : item.options) {
    made.options.push_back(option.name);
  }
  for (int step = 1; item.kind == protocols::ItemKind::likert && step <= item.steps; ++step) {
    made.options.push_back(std::to_string(step));
  }
  return made;
}

std::vector<std::string> places_of(const protocols::Protocol& protocol, const std::string& form) {
  std::vector<std::string> places;
  const auto add = [&](const std::vector<std::string>& forms, const std::string& place) {
    if (std::ranges::find(forms, form) != forms.end()) {
      places.push_back(place);
    }
  };
  add(protocol.forms_before, asked_at_begin);
  for (const protocols::Block& block : protocol.blocks) {
    add(block.forms_after, block.name);
  }
  add(protocol.forms_after, asked_at_end);
  return places;
}
}  // namespace

std::vector<analysis::Questionnaire> questionnaires_of(const protocols::Protocol& protocol) {
  std::vector<analysis::Questionnaire> all;
  for (const auto& [name, form] : protocol.forms) {
    analysis::Questionnaire made{name, {}, places_of(protocol, name), protocols::is_raw_tlx(form)};
    for (const protocols::FormItem& item : form.items) {
      made.items.push_back(item_of(item));
    }
    if (!made.asked.empty()) {
      all.push_back(std::move(made));
    }
  }
  return all;
}

std::vector<analysis::GivenAnswer> given_answers(const std::vector<StudyStore>& stores,
                                                 results::Mode mode) {
  std::vector<analysis::GivenAnswer> answers;
  for (const StudyStore& each : stores) {
    const auto excluded = each.store->excluded_participants();
    std::map<std::int64_t, std::string> participants;  // by session
    for (const results::SessionRow& session : each.store->sessions()) {
      if (session.mode == mode && !excluded.contains(session.participant_id)) {
        participants.emplace(session.id, session.participant_id);
      }
    }
    for (results::FormAnswerRow& row : results::stored_form_answers(*each.store)) {
      const auto participant = participants.find(row.session_id);
      if (participant != participants.end()) {
        answers.push_back({participant->second, std::move(row.form), std::move(row.asked),
                           std::move(row.item), std::move(row.answer)});
      }
    }
  }
  return answers;
}
}  // namespace tapstudy::runner
