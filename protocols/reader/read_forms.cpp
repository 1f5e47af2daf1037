// Questionnaires, and what answers to them decide.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

#include "core/text/plain_text.hpp"
#include "protocols/form.hpp"
#include "protocols/reader/read_sections.hpp"
namespace tapstudy::protocols {
namespace {
using Presence = MapReader::Presence;

// The answers that can be conditions. Without a file there is no item that is known by name.
std::vector<std::string> known_answers(const FormItem& item) {
  return item.name.empty() ? std::vector<std::string>{} : answers_that_decide(item);
}

// The items that conditions can be on.
std::map<std::string, FormItem> deciding_items(const Form* form) {
  std::map<std::string, FormItem> deciding;
  for (const FormItem& item : form == nullptr ? std::vector<FormItem>{} : form->items) {
    if (!known_answers(item).empty()) {
      deciding.emplace(item.name, item);
    }
  }
  return deciding;
}

// One mistake is one error: of what was rejected nothing more is said.
class Rejection {
 public:
  explicit Rejection(const MapReader& reader)
      : reader_{reader}, earlier_{reader.problems_in_file()} {}
  explicit operator bool() const { return reader_.problems_in_file() > earlier_; }

 private:
  const MapReader& reader_;
  std::size_t earlier_;
};

// The keys `item` and `is` of a condition whose form is read; nullptr without a file.
void read_answers(MapReader& reader, const Form* form, AnswerCondition& condition) {
  const auto items = deciding_items(form);
  const Rejection rejected{reader};
  condition.item = reader.word({"item", "an item of kind single_choice, multiple_choice or likert"},
                               "item with such answers", keys_of(items));
  if (rejected) {
    reader.leave("is");
    return;
  }
  const auto item = items.find(condition.item);
  condition.answers =
      reader.words({"is", "answers, one of which must be given or among the choices"}, "answer",
                   item == items.end() ? std::vector<std::string>{} : known_answers(item->second));
}

// The same of a form that is one of these.
void read_answers_to(MapReader& reader, const Key& key, const std::string& kind,
                     const std::vector<std::string>& allowed, const Protocol& protocol,
                     AnswerCondition& condition) {
  const Rejection rejected{reader};
  condition.form = reader.word(key, kind, allowed);
  if (rejected) {
    reader.leave("item");
    reader.leave("is");
    return;
  }
  const auto form = protocol.forms.find(condition.form);
  read_answers(reader, form == protocol.forms.end() ? nullptr : &form->second, condition);
}

std::optional<AnswerCondition> read_asked_if(MapReader& item_reader, const Form& own,
                                             const Protocol& protocol) {
  std::optional<AnswerCondition> condition;
  item_reader.map({"asked_if", "asked only after such an answer to an earlier item; unset: always"},
                  Presence::optional, [&](MapReader& reader) {
                    condition.emplace().form = own.name;
                    if (reader.has("form")) {
                      read_answers_to(reader, {"form", "that the item is of; unset: this one"},
                                      "form that stands before", keys_of(protocol.forms), protocol,
                                      *condition);
                    } else {
                      read_answers(reader, &own, *condition);
                    }
                  });
  return condition;
}

// One for each option, or none.
void read_option_pictures(MapReader& reader, const ReadFile& read_file, Protocol& protocol,
                          FormItem& item) {
  const std::vector<Picture> pictures = read_pictures(
      reader,
      {"option_pictures",
       "single_choice, multiple_choice: beside the options, one for each in their order"},
      item.options.size(), read_file, protocol);
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    item.options[i].picture = pictures[i];
  }
}

void read_options(MapReader& reader, FormItem& item) {
  for (const auto& [option, label] : reader.translated_list(
           {"options",
            "single_choice, multiple_choice: to choose from; unset: not of these kinds"})) {
    item.options.push_back({option, label, {}});
    if (item.kind == ItemKind::multiple_choice && option.find(between_choices) != option.npos) {
      reader.reject("options", fmt::format("'{}' has a '{}', which stands between the choices in "
                                           "the data",
                                           option, between_choices));
    }
  }
  if (const auto why = why_not_told_apart(item.options)) {
    reader.reject("options", *why);
  }
  reader.check("options", item.options.size() >= 2, R"({"minItems": 2})",
               "a choice has at least two options");
}

void read_ending(MapReader& reader, FormItem& item) {
  if (item.kind == ItemKind::single_choice || item.kind == ItemKind::multiple_choice ||
      item.kind == ItemKind::likert) {
    item.ends_session = reader.words(
        {"ends_session",
         "answers after which the participant takes no part: the session ends, and of this form "
         "nothing but that answer is stored; unset: none"},
        "answer", known_answers(item), std::vector<std::string>{});
    const std::set<std::string> ending{item.ends_session.begin(), item.ends_session.end()};
    if (!ending.empty() && ending.size() == known_answers(item).size()) {
      reader.reject("ends_session", "names every answer: nobody could take part");
    }
  }
}

// The columns of participants.tsv that the Brain Imaging Data Structure (1.8) defines, and their
// values; a value may also be its first letter, in capitals, or begin with one.
struct BidsColumn {
  const char* name;
  std::vector<std::string> values;  // empty: a number
};
const std::vector<BidsColumn>& bids_columns() {
  static const std::vector<BidsColumn> columns{{"age", {}},
                                               {"sex", {"male", "female", "other"}},
                                               {"handedness", {"left", "right", "ambidextrous"}}};
  return columns;
}

bool is_value_of(const BidsColumn& column, const std::string& option) {
  const std::string small = core::lower_case(option);
  return std::ranges::any_of(column.values, [&](const std::string& value) {
    return small == value || small == value.substr(0, 1);
  });
}

void read_bids(MapReader& reader, FormItem& item) {
  std::vector<std::string> names;
  std::ranges::transform(bids_columns(), std::back_inserter(names), &BidsColumn::name);
  item.bids = reader.word({"bids",
                           "number: age, in years; single_choice: sex (male, female, other) or "
                           "handedness (left, right, ambidextrous; options are these words or "
                           "their first letters): a column of participants.tsv in exports to BIDS"},
                          "column", names, "");
  const auto column = std::ranges::find(bids_columns(), item.bids, &BidsColumn::name);
  if (column == bids_columns().end()) {
    return;
  }
  const bool is_number = column->values.empty();
  if (item.kind != (is_number ? ItemKind::number : ItemKind::single_choice)) {
    reader.reject("bids",
                  fmt::format("'{}' is of an item of kind {}", item.bids,
                              name(is_number ? ItemKind::number : ItemKind::single_choice)));
  } else if (!std::ranges::all_of(item.options, [&](const Option& option) {
               return is_value_of(*column, option.name);
             })) {
    reader.reject("options", fmt::format("are not all among {}, as bids: {} has them",
                                         fmt::join(column->values, ", "), item.bids));
  }
}

FormItem read_item(MapReader& reader, const Form& form, const ReadFile& read_file,
                   Protocol& protocol) {
  constexpr double any = 1e12;
  FormItem item;
  const Rejection rejected{reader};
  item.name = reader.name({"name", "unique in its form"});
  const bool has_name = !rejected;
  item.kind =
      reader.one_of<ItemKind>({"kind",
                               "steps from 1; a mark on a line, stored as 0 to 1; a "
                               "number; one of several options; one or more of them; free text"},
                              item_kind_names);
  item.question = reader.translated({"question", "text that participants are asked"});
  item.picture =
      read_picture(reader, {"picture", "beside the question; unset: none"}, read_file, protocol);
  item.is_required = reader.yes_or_no({"required", "must be answered"}, true);
  if (item.kind == ItemKind::likert) {
    item.steps = reader.integer({"steps", "likert: from 1 to this"}, 2, 11, item.steps);
  }
  if (item.kind == ItemKind::likert || item.kind == ItemKind::scale) {
    item.low =
        reader.translated({"low", "likert, scale: what the lowest means; unset: not of this kind"});
    item.high = reader.translated(
        {"high", "likert, scale: what the highest means; unset: not of this kind"});
  }
  if (item.kind == ItemKind::number) {
    item.min =
        reader.number({"min", "number: the lowest allowed; unset: not of this kind"}, {-any, any});
    item.max =
        reader.number({"max", "number: the highest allowed; unset: not of this kind"}, {-any, any});
    if (item.max <= item.min) {
      reader.reject("max", "is not above min");
    }
  }
  if (item.kind == ItemKind::single_choice || item.kind == ItemKind::multiple_choice) {
    read_options(reader, item);
    read_option_pictures(reader, read_file, protocol, item);
  }
  read_bids(reader, item);
  item.asked_if = read_asked_if(reader, form, protocol);
  if (has_name) {
    read_ending(reader, item);
  } else {
    reader.leave("ends_session");
  }
  return item;
}

Form read_form(const std::string& name, MapReader& reader, const ReadFile& read_file,
               Protocol& protocol) {
  Form form;
  if (reader.has("shipped")) {
    reader.word(
        {"shipped",
         "instead of the rest; nasa_tlx: the raw task load index, in English, German "
         "and Japanese (translations are ours, not validated); unset: the form is given here"},
        "form", {"nasa_tlx"});
    form = nasa_tlx(reader.language_among("shipped", nasa_tlx_languages()));
  } else {
    form.name = name;
    form.title = reader.translated({"title", "above the questions; unset: of a shipped form"});
    form.text = reader.translated_paragraphs({"text", "before the questions; paragraphs"}, "");
    form.picture =
        read_picture(reader, {"picture", "after the text; unset: none"}, read_file, protocol);
    reader.list({"items", "the questions; unset: of a shipped form"}, Presence::at_least_one,
                [&](MapReader& inner) {
                  const FormItem item = read_item(inner, form, read_file, protocol);
                  check_name_is_new(inner, form.items, item.name, "item");
                  form.items.push_back(item);
                });
  }
  form.name = name;
  return form;
}

// A condition on a form that is not asked before could not be met.
void check_is_asked_before(MapReader& top, const Protocol& protocol) {
  const std::vector<std::string>& begin = protocol.forms_before;
  for (const auto& [name, form] : protocol.forms) {
    const auto own = std::ranges::find(begin, name);
    for (const FormItem& item : form.items) {
      if (item.asked_if && item.asked_if->form != name && !item.asked_if->item.empty() &&
          std::find(begin.begin(), own, item.asked_if->form) == own) {
        top.reject("forms_before",
                   fmt::format("must have '{}' before '{}', whose item '{}' is asked_if an answer "
                               "to it",
                               item.asked_if->form, name, item.name));
      }
    }
  }
}
void check_bids_columns(MapReader& top, const Protocol& protocol) {
  std::set<std::string> filled;
  for (const auto& [name, form] : protocol.forms) {
    for (const FormItem& item : form.items) {
      if (!item.bids.empty() && !filled.insert(item.bids).second) {
        top.reject("forms", fmt::format("bids: {} is given for two items", item.bids));
      }
    }
  }
}
}  // namespace

void read_forms(MapReader& top, const ReadFile& read_file, Protocol& protocol) {
  top.each({"forms", "questionnaires, by name"}, Presence::optional,
           [&](const std::string& name, MapReader& reader) {
             protocol.forms.emplace(name, read_form(name, reader, read_file, protocol));
           });
  protocol.forms_before = read_form_names(
      top, {"forms_before", "names of forms, asked before the first trial"}, protocol);
  protocol.forms_after =
      read_form_names(top, {"forms_after", "names of forms, asked after the last trial"}, protocol);
  check_is_asked_before(top, protocol);
  check_bids_columns(top, protocol);
}

std::optional<AnswerCondition> read_presented_if(MapReader& block_reader,
                                                 const Protocol& protocol) {
  std::optional<AnswerCondition> condition;
  block_reader.map(
      {"presented_if",
       "only to participants who answered so before the first trial; simulated ones answer no "
       "forms and get all blocks; unset: to all"},
      Presence::optional, [&](MapReader& reader) {
        read_answers_to(reader, {"form", "one of forms_before"}, "form of forms_before",
                        protocol.forms_before, protocol, condition.emplace());
      });
  return condition;
}

std::vector<std::string> read_form_names(MapReader& reader, const Key& key,
                                         const Protocol& protocol) {
  return reader.words(key, "form", keys_of(protocol.forms), std::vector<std::string>{});
}
}  // namespace tapstudy::protocols
