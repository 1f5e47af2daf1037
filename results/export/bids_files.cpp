#include "results/export/bids_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "results/export/csv_file.hpp"
#include "results/store/form_amendments.hpp"
namespace tapstudy::results {
namespace {
using Json = nlohmann::ordered_json;
constexpr const char* bids_version = "1.8.0";

Json described(const DescribedColumn& known) {
  Json json{{"Description", known.column.description}};
  if (!known.column.unit.empty()) {
    json["Units"] = known.column.unit;
  }
  if (known.column.type == CellType::boolean) {
    json["Levels"] = {{"0", "no"}, {"1", "yes"}};
  }
  for (const auto& [level, meaning] : known.levels) {
    json["Levels"][level] = meaning;
  }
  return json;
}

void add_columns(Json& json, const std::vector<DescribedColumn>& columns) {
  for (const DescribedColumn& known : columns) {
    json[known.column.name] = described(known);
  }
}

std::string text_of(const Json& json) {
  return json.dump(2) + "\n";
}
}  // namespace

std::string dataset_description(const Provenance& provenance) {
  return text_of({{"Name", provenance.title},
                  {"BIDSVersion", bids_version},
                  {"DatasetType", "raw"},
                  {"GeneratedBy", {{{"Name", "tapstudy"}, {"Version", provenance.program}}}}});
}

std::string table_sidecar(const std::vector<DescribedColumn>& columns) {
  Json json = Json::object();
  add_columns(json, columns);
  return text_of(json);
}

std::string phenotype_sidecar(const std::string& tool,
                              const std::vector<DescribedColumn>& columns) {
  Json json{{"MeasurementToolMetadata", {{"Description", tool}}}};
  add_columns(json, columns);
  return text_of(json);
}

std::string task_sidecar(const std::string& task, const BlockText& block,
                         const std::vector<DescribedColumn>& columns) {
  Json json{{"TaskName", task}, {"TaskDescription", block.question}};
  if (!block.instructions.empty()) {
    json["Instructions"] = block.instructions;
  }
  add_columns(json, columns);
  return text_of(json);
}

std::string recording_sidecar(double rate_hz, const std::vector<Column>& columns) {
  Json json{{"SamplingFrequency", rate_hz}, {"StartTime", 0.0}, {"Columns", Json::array()}};
  for (const Column& column : columns) {
    json["Columns"].push_back(column.name);
  }
  for (const Column& column : columns) {
    json[column.name] = described({column});
  }
  return text_of(json);
}

namespace {
bool is_letter_or_digit(char c) {
  return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
}
bool is_plain(const std::string& name) {
  return std::ranges::any_of(name, is_letter_or_digit) && std::ranges::all_of(name, [](char c) {
           return is_letter_or_digit(c) || c == '-' || c == '_';
         });
}
std::string cleaned(const std::string& name) {
  std::string label;
  std::ranges::copy_if(name, std::back_inserter(label), is_letter_or_digit);
  return label;
}
// As file systems that ignore case see it.
std::string lowered(std::string label) {
  std::ranges::transform(label, label.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return label;
}
}  // namespace

BidsLabels bids_labels(const std::vector<std::string>& names, const std::string& substitute) {
  BidsLabels labels;
  std::set<std::string> taken;
  int replaced = 0;
  int numbered = 0;
  for (const std::string& name : names) {
    const std::string wanted =
        is_plain(name) ? cleaned(name) : fmt::format("{}{:02}", substitute, ++replaced);
    std::string label = wanted;
    for (int i = 2; !taken.insert(lowered(label)).second; ++i) {
      label = fmt::format("{}x{}", wanted, i);
    }
    numbered += label == wanted ? 0 : 1;
    labels.by_name[name] = label;
  }
  if (replaced > 0) {
    labels.notes.push_back(
        fmt::format("names that are no labels were replaced by {}01 and so on, in order: {}",
                    substitute, replaced));
  }
  if (numbered > 0) {
    labels.notes.push_back(fmt::format(
        "labels that would have been the same were told apart by x2 and so on: {}", numbered));
  }
  return labels;
}

namespace {
struct Event {
  Row row;
  std::optional<std::string> block;
};
struct Session {
  std::string participant;
  std::int64_t id{};
  std::vector<Event> events;  // in their order
};

std::vector<Session> all_sessions(Store& store) {
  std::vector<Session> sessions;
  store.each_row(
      "SELECT session_id, participant_id, t_s, state, number, block FROM session_event "
      "JOIN v_sessions USING (session_id) "
      "LEFT JOIN (SELECT DISTINCT session_id, number, block FROM trial) USING (session_id, number) "
      "ORDER BY session_id, t_s, session_event.rowid",
      [&](Statement& row) {
        if (sessions.empty() || sessions.back().id != row.integer(0)) {
          sessions.push_back({row.text(1), row.integer(0), {}});
        }
        sessions.back().events.push_back({{row.real(2), std::monostate{}, row.text(3),
                                           row.is_null(4) ? Cell{} : Cell{row.integer(4)}},
                                          row.optional_text(5)});
      });
  return sessions;
}

// False if no event has a block.
bool fill_blocks(std::vector<Event>& events) {
  std::optional<std::string> block;
  for (auto event = events.rbegin(); event != events.rend(); ++event) {
    block = event->block ? event->block : block;
    event->block = block;
  }
  for (Event& event : events) {
    block = event.block ? event.block : block;
    event.block = block;
  }
  return block.has_value();
}

std::string header() {
  Row names;
  for (const DescribedColumn& known : event_columns()) {
    names.emplace_back(known.column.name);
  }
  return tsv_line(names);
}
}  // namespace

std::vector<DescribedColumn> event_columns() {
  return {{{"onset", CellType::real, "s", "Time from the session's begin"}},
          {{"duration", CellType::real, "s", "Missing: an event has none"}},
          {{"trial_type", CellType::text, "", "State that the session entered"}},
          {{"trial", CellType::integer, "", "Place of the trial in the participant's order"}}};
}

std::vector<BlockEvents> events_of_blocks(Store& store) {
  std::vector<BlockEvents> found;
  for (Session& session : all_sessions(store)) {
    if (!fill_blocks(session.events)) {
      continue;
    }
    const std::size_t first = found.size();
    for (const Event& event : session.events) {
      auto of =
          std::find_if(found.begin() + static_cast<std::ptrdiff_t>(first), found.end(),
                       [&](const BlockEvents& events) { return events.block == event.block; });
      if (of == found.end()) {
        found.push_back({session.participant, session.id, *event.block, header()});
        of = std::prev(found.end());
      }
      of->table += tsv_line(event.row);
    }
  }
  return found;
}

namespace {
using Answers = std::map<std::string, Cell>;  // by item

// Of one questionnaire at one place.
struct Asked {
  std::string form;
  std::string place;
  std::map<std::string, Answers> answers;  // by participant
};

std::vector<Asked> all_asked(Store& store) {
  std::vector<Asked> all;
  store.each_row(
      fmt::format("SELECT form, asked, participant_id, item, answer FROM {} JOIN v_sessions USING "
                  "(session_id) ORDER BY form_answer.rowid",
                  current_form_answer),
      [&](Statement& row) {
        auto of = std::ranges::find_if(all, [&](const Asked& asked) {
          return asked.form == row.text(0) && asked.place == row.text(1);
        });
        if (of == all.end()) {
          all.push_back({row.text(0), row.text(1), {}});
          of = std::prev(all.end());
        }
        of->answers[row.text(2)][row.text(3)] = row.is_null(4) ? Cell{} : Cell{row.text(4)};
      });
  return all;
}

std::vector<ItemText> shown_items(const FormText& form) {
  std::vector<ItemText> items;
  std::ranges::copy_if(form.items, std::back_inserter(items),
                       [](const ItemText& item) { return !item.is_free_text; });
  return items;
}

std::vector<std::string> people_with_trials(Store& store) {
  std::vector<std::string> people;
  store.each_row("SELECT participant_id FROM trial_context GROUP BY 1 ORDER BY min(trial_id)",
                 [&](Statement& row) { people.push_back(row.text(0)); });
  return people;
}

std::string table_of(const Asked& asked, const std::vector<ItemText>& items,
                     const std::vector<std::string>& people,
                     const std::map<std::string, std::string>& labels) {
  Row header{std::string{"participant_id"}};
  for (const ItemText& item : items) {
    header.emplace_back(item.name);
  }
  std::string lines = tsv_line(header);
  for (const std::string& person : people) {
    Row row{"sub-" + labels.at(person)};
    const auto own = asked.answers.find(person);
    const Answers answers = own == asked.answers.end() ? Answers{} : own->second;
    for (const ItemText& item : items) {
      const auto answer = answers.find(item.name);
      row.push_back(answer == answers.end() ? Cell{} : answer->second);
    }
    lines += tsv_line(row);
  }
  return lines;
}

std::string sidecar_of(const Asked& asked, const FormText& form,
                       const std::vector<ItemText>& items) {
  std::vector<DescribedColumn> columns;
  for (const ItemText& item : items) {
    columns.push_back({{item.name, CellType::text, "", item.question}, item.levels});
  }
  const std::string title = form.title.empty() ? form.name : form.title;
  return phenotype_sidecar(title + " (asked: " + asked.place + ")", columns);
}

// Named by the questionnaire, and by the place where there are several.
std::string name_of(const Asked& asked, const std::vector<Asked>& all) {
  const auto places = std::ranges::count(all, asked.form, &Asked::form);
  return places > 1 ? asked.form + "_" + asked.place : asked.form;
}
}  // namespace

std::vector<ParticipantsColumn> participants_columns(Store& store,
                                                     const std::vector<FormText>& forms) {
  std::vector<ParticipantsColumn> columns;
  for (const FormText& form : forms) {
    for (const ItemText& item : form.items) {
      if (item.participants_column.empty()) {
        continue;
      }
      const bool is_age = item.participants_column == "age";
      ParticipantsColumn own{
          {{item.participants_column, CellType::text, is_age ? "year" : "", item.question},
           item.levels},
          {}};
      Statement row = store.query(
          fmt::format("SELECT participant_id, answer FROM {} JOIN session USING (session_id) "
                      "WHERE form = ? AND item = ? AND answer IS NOT NULL "
                      "ORDER BY form_answer.rowid",
                      current_form_answer));
      row.bind(form.name).bind(item.name);
      while (row.step()) {
        own.answers[row.text(0)] = row.text(1);
      }
      columns.push_back(std::move(own));
    }
  }
  return columns;
}

std::vector<Phenotype> phenotypes(Store& store, const std::vector<FormText>& forms,
                                  const std::map<std::string, std::string>& labels) {
  const std::vector<Asked> all = all_asked(store);
  const std::vector<std::string> people = people_with_trials(store);
  std::vector<std::string> names;
  std::ranges::transform(all, std::back_inserter(names),
                         [&](const Asked& asked) { return name_of(asked, all); });
  const BidsLabels file_names = bids_labels(names, "form");
  std::vector<Phenotype> found;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto form = std::ranges::find(forms, all[i].form, &FormText::name);
    if (form == forms.end()) {
      continue;
    }
    const std::vector<ItemText> items = shown_items(*form);
    if (!items.empty()) {
      found.push_back({file_names.by_name.at(names[i]), table_of(all[i], items, people, labels),
                       sidecar_of(all[i], *form, items)});
    }
  }
  return found;
}
}  // namespace tapstudy::results
