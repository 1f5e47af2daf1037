#include "runner/studies/stored_study.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "core/error.hpp"
#include "core/text/plain_text.hpp"
#include "protocols/form.hpp"
#include "results/store/program_versions.hpp"
#include "results/store/study_queries.hpp"
#include "runner/session/engine/between_trials.hpp"
#include "runner/session/engine/session_row.hpp"
#include "runner/session/engine/stored_names.hpp"
namespace tapstudy::runner {
bool is_before(const std::string& version, int major, int minor) {
  const auto first_dot = version.find('.');
  const auto second_dot = version.find('.', first_dot + 1);
  if (first_dot == std::string::npos || second_dot == std::string::npos) {
    return false;
  }
  const std::string_view text{version};
  const auto of_major = core::number_in<int>(text.substr(0, first_dot));
  const auto of_minor =
      core::number_in<int>(text.substr(first_dot + 1, second_dot - first_dot - 1));
  return of_major && of_minor && std::pair{*of_major, *of_minor} < std::pair{major, minor};
}

protocols::EarlierDefaults defaults_of(const std::set<std::string>& program_versions) {
  protocols::EarlierDefaults defaults;
  if (std::ranges::any_of(program_versions,
                          [](const std::string& version) { return is_before(version, 0, 3); })) {
    defaults.element_order = 1;
  }
  return defaults;
}

protocols::EarlierDefaults defaults_of(results::Store& store) {
  std::set<std::string> versions;
  for (const results::SessionRow& session : store.sessions()) {
    versions.insert(session.program_version);
  }
  return defaults_of(versions);
}

protocols::Protocol stored_protocol(results::Store& store) {
  const results::StudyRow study = store.study();
  const protocols::ReadFile stored = files_of(study);
  return protocols::parse_protocol({study.protocol_text, study.protocol_file}, {stored, stored},
                                   defaults_of(store));
}

protocols::Protocol checked_protocol(results::Store& store) {
  protocols::Protocol protocol = stored_protocol(store);
  check_names(store, protocol);
  return protocol;
}

protocols::Protocol protocol_to_go_on_with(const std::string& file, const std::string& language,
                                           const std::string& directory) {
  return protocols::read_protocol(file, language,
                                  defaults_of(results::program_versions_in(directory)));
}

protocols::PlannedTrial stored_trial(const results::TrialRow& row,
                                     const std::vector<results::AlternativeRow>& alternatives,
                                     const protocols::Block& block) {
  protocols::PlannedTrial trial;
  trial.number = row.number;
  trial.block = row.block;
  trial.task = block.task;
  trial.is_practice = row.is_practice;
  trial.repetition = row.repetition;
  trial.is_catch = row.is_catch;
  for (const results::AlternativeRow& alternative : alternatives) {
    trial.alternatives.push_back(
        {alternative.stimulus, alternative.axis_values, alternative.is_comparison});
  }
  return trial;
}

DoneBlocks done_blocks(const std::vector<StudyStore>& stores, results::Mode mode) {
  DoneBlocks all;
  for (const StudyStore& each : stores) {
    for (const auto& [block, done] : results::block_courses(*each.store, mode)) {
      results::BlockCourseRow& total = all[block];
      total.participants.insert(done.participants.begin(), done.participants.end());
      total.answered += done.answered;
      total.masked += done.masked;
    }
  }
  return all;
}

std::set<std::string> rendered_stimuli(const protocols::Protocol& protocol,
                                       const DoneBlocks& done) {
  std::set<std::string> names;
  for (const protocols::Block& block : protocol.blocks) {
    if (done.contains(block.name) && block.presented == protocols::Presented::virtual_plates) {
      for (const std::string& name : all_presented(block)) {
        names.insert(name);
      }
    }
  }
  return names;
}

results::Mode mode_to_report(const std::vector<results::SessionRow>& sessions) {
  for (const results::Mode mode : {results::Mode::real, results::Mode::pilot}) {
    if (std::ranges::find(sessions, mode, &results::SessionRow::mode) != sessions.end()) {
      return mode;
    }
  }
  return results::Mode::simulated;
}

std::vector<results::AnswerRow> counted_answers(results::Store& store, results::Mode mode) {
  const std::map<std::string, std::string> excluded = store.excluded_participants();
  std::vector<results::AnswerRow> answers = results::stored_answers(store);
  std::erase_if(answers, [&](const results::AnswerRow& answer) {
    return answer.mode != mode || answer.is_practice || answer.is_catch ||
           excluded.contains(answer.participant_id);
  });
  // simulated participants take part at the same time: sums over them must not depend on who is
  // first
  std::ranges::stable_sort(answers, {}, &results::AnswerRow::participant_index);
  results::AlternativesOfTrials alternatives = store.alternatives();
  for (results::AnswerRow& answer : answers) {
    answer.alternatives = std::move(alternatives[answer.trial_id]);
  }
  return answers;
}

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
    case protocols::ItemKind::multiple_choice:
      return analysis::QuestionnaireKind::choices;
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
