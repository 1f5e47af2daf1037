#include <fmt/format.h>

#include "analysis/choice/choice_biases.hpp"
#include "analysis/choice/choice_summary.hpp"
namespace tapstudy::analysis {
namespace {
ReportTable biases_table(const ChoiceBiases& biases) {
  ReportTable table{
      "biases",
      "Choices by label and by order of visits, all trials",
      {column("chosen was", "chosen_was"), column("label", "label"),
       counted_column("of trials", "chosen"), column("by chance", "chance"), column("p", "p")}};
  std::int64_t trials = 0;
  for (const int chosen : biases.chosen) {
    trials += chosen;
  }
  for (std::size_t i = 0; i < biases.labels.size(); ++i) {
    table.rows.push_back({word("under the label"), word(biases.labels[i]),
                          counted({biases.chosen[i], trials}), share(biases.chance),
                          i == 0 ? probability(biases.labels_p) : nothing(table.columns[4], "")});
  }
  const auto add_visited = [&](const char* what, const Proportion& chosen) {
    if (chosen.trials > 0) {
      table.rows.push_back({word(what), nothing(table.columns[1], ""), counted(chosen),
                            share(biases.chance),
                            probability(binomial_two_sided_p(chosen, biases.chance))});
    }
  };
  add_visited("visited first", biases.first_visited);
  add_visited("visited last", biases.last_visited);
  return table;
}

ReportTable transitions_table(const std::vector<Item>& stimuli, const BlockRows& rows) {
  ReportTable table{
      "transitions", "Switches while exploring: rows from, columns to", {column("from", "from")}};
  for (const Item& item : stimuli) {
    table.columns.push_back(column(item.label, item.name));
  }
  if (rows.orders.empty()) {
    return table;
  }
  const auto counts = transitions(stimuli, rows);
  for (std::size_t i = 0; i < stimuli.size(); ++i) {
    std::vector<Cell> row{labelled(stimuli[i])};
    for (const std::int64_t switches : counts[i]) {
      row.push_back(count(switches));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::string missing_words(const BlockRows& rows) {
  const auto answered = static_cast<int>(rows.answers.size());
  return rows.missing_replies == 0
             ? fmt::format("No reply is missing of {} trials that were presented.", answered)
             : fmt::format(
                   "Missing replies: {} of {} trials that were presented timed out or were "
                   "skipped, and not answered later. They are in no count.",
                   rows.missing_replies, answered + rows.missing_replies);
}
}  // namespace

ReportSection choosing_section(const BlockDesign& design, const BlockRows& rows) {
  ReportSection section{"How it was chosen"};
  const ChoiceBiases biases = choice_biases(rows);
  section.remarks.push_back(missing_words(rows));
  if (biases.labels.empty()) {
    return section;
  }
  section.tables = {biases_table(biases), transitions_table(design.stimuli, rows)};
  section.remarks.emplace_back(
      "Labels are drawn anew for each trial: without a bias all are equally likely (exact "
      "multinomial test, outcomes by probability), and of trials in which all were visited the "
      "first or last was chosen by chance in one of so many as there are (exact binomial, "
      "two-sided). What was visited last may have been visited again because it was preferred.");
  return section;
}
}  // namespace tapstudy::analysis
