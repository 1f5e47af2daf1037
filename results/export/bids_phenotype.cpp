#include "results/export/bids_phenotype.hpp"

#include <algorithm>
#include <set>

#include "results/export/bids_labels.hpp"
#include "results/export/bids_sidecars.hpp"
#include "results/export/tsv.hpp"
namespace tapstudy::results {
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
      "SELECT form, asked, participant_id, item, answer FROM form_answer JOIN v_sessions USING "
      "(session_id) ORDER BY form_answer.rowid",
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
