#include "analysis/report/study/questionnaires.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "analysis/statistics/population/means.hpp"
#include "analysis/statistics/quantiles.hpp"
#include "core/error.hpp"
#include "core/text/plain_text.hpp"
namespace tapstudy::analysis {
double number_of(const GivenAnswer& answer) {
  const std::string text = answer.answer.value_or("");
  const auto number = core::number_in<double>(text);
  if (!number || !std::isfinite(*number)) {
    throw core::InvalidInput{fmt::format("the answer '{}' of {} to {} of form {} is not a number",
                                         text, answer.participant_id, answer.item, answer.form)};
  }
  return *number;
}

ItemAnswers answers_to(const std::vector<GivenAnswer>& answers, const std::string& form,
                       const std::string& asked, const std::string& item) {
  ItemAnswers found;
  for (const GivenAnswer& answer : answers) {
    if (answer.form == form && answer.asked == asked && answer.item == item) {
      if (answer.answer) {
        found.given.push_back(answer);
      } else {
        ++found.left_out;
      }
    }
  }
  return found;
}

namespace {
struct PartialScore {
  double sum{};
  std::size_t items{};
};

double share_of(const GivenAnswer& answer) {
  const double share = number_of(answer);
  if (share < 0.0 || share > 1.0) {
    throw core::InvalidInput{fmt::format("the answer {} of {} to {} of form {} is not from 0 to 1",
                                         share, answer.participant_id, answer.item, answer.form)};
  }
  return share;
}

// Adds what everybody answered to one item.
void add_item(const std::string& item, const Questionnaire& form, const std::string& asked,
              const std::vector<GivenAnswer>& answers, std::map<std::string, PartialScore>& sums) {
  for (const GivenAnswer& answer : answers) {
    if (answer.form == form.name && answer.asked == asked && answer.item == item) {
      PartialScore& own = sums[answer.participant_id];
      own.sum += answer.answer ? share_of(answer) : 0.0;
      own.items += answer.answer ? 1 : 0;
    }
  }
}
}  // namespace

FormScores scores_of(const Questionnaire& form, const std::string& asked,
                     const std::vector<GivenAnswer>& answers) {
  std::map<std::string, PartialScore> sums;
  for (const QuestionnaireItem& item : form.items) {  // in their order: sums are rounded
    add_item(item.name, form, asked, answers, sums);
  }
  FormScores scores;
  for (const auto& [participant, own] : sums) {
    if (own.items == form.items.size()) {
      scores.of_participants.emplace_back(participant,
                                          100.0 * own.sum / static_cast<double>(own.items));
    } else {
      ++scores.incomplete;
    }
  }
  return scores;
}

namespace {
constexpr int draws = 9999;
constexpr std::uint64_t seed = 1;

const char* name_of(QuestionnaireKind kind) {
  switch (kind) {
    case QuestionnaireKind::steps:
      return "steps";
    case QuestionnaireKind::number:
      return "number";
    case QuestionnaireKind::choice:
      return "single choice";
    case QuestionnaireKind::choices:
      return "multiple choice";
    case QuestionnaireKind::text:
      break;
  }
  return "text";
}

bool is_number(QuestionnaireKind kind) {
  return kind == QuestionnaireKind::steps || kind == QuestionnaireKind::number;
}

void add_items(const Questionnaire& form, const std::string& asked,
               const std::vector<GivenAnswer>& answers, ReportTable& table) {
  for (const QuestionnaireItem& item : form.items) {
    const ItemAnswers own = answers_to(answers, form.name, asked, item.name);
    std::vector<Cell> row{word(form.name),
                          word(asked),
                          word(item.name),
                          word(name_of(item.kind)),
                          count(std::ssize(own.given)),
                          count(own.left_out)};
    if (is_number(item.kind) && !own.given.empty()) {
      std::vector<double> numbers;
      std::ranges::transform(own.given, std::back_inserter(numbers), number_of);
      const Quartiles spread = quartiles(numbers);
      row.push_back(interval(spread.median, {spread.low, spread.high}));
    } else {
      row.push_back(nothing(table.columns.back()));
    }
    table.rows.push_back(row);
  }
}

bool has_chosen(const QuestionnaireItem& item, const std::string& answer,
                const std::string& option) {
  return item.kind == QuestionnaireKind::choices
             ? fmt::format(";{};", answer).find(fmt::format(";{};", option)) != answer.npos
             : answer == option;
}

void add_counts(const Questionnaire& form, const std::string& asked,
                const std::vector<GivenAnswer>& answers, ReportTable& table) {
  for (const QuestionnaireItem& item : form.items) {
    const ItemAnswers own = answers_to(answers, form.name, asked, item.name);
    for (const std::string& option : item.options) {
      const auto people = std::ranges::count_if(own.given, [&](const GivenAnswer& given) {
        return has_chosen(item, given.answer.value_or(""), option);
      });
      table.rows.push_back(
          {word(form.name), word(asked), word(item.name), word(option), count(people)});
    }
  }
}

// Sorted, so that who came first does not matter to the bootstrap.
std::vector<double> sorted_scores(const FormScores& scores) {
  std::vector<double> values;
  for (const auto& [participant, score] : scores.of_participants) {
    values.push_back(score);
  }
  std::ranges::sort(values);
  return values;
}

// Scores are from 0 to 100, and so is their mean.
Cell mean_score(const std::vector<double>& values) {
  constexpr Interval bounds{0.0, 100.0};
  return interval(mean_and_spread(values).mean,
                  values.size() > 1 ? bounded_interval(values, bounds) : std::nullopt);
}

std::vector<Cell> score_row(const Questionnaire& form, const std::string& asked,
                            const FormScores& scores, const ReportTable& table) {
  const std::vector<double> values = sorted_scores(scores);
  std::vector<Cell> row{word(form.name), word(asked), count(std::ssize(values)),
                        count(scores.incomplete)};
  row.push_back(values.empty() ? nothing(table.columns[4]) : mean_score(values));
  const auto bootstrap = values.size() > 1 ? bootstrap_interval(values, draws, seed) : std::nullopt;
  row.push_back(bootstrap ? Cell{rounded(bootstrap->low) + " to " + rounded(bootstrap->high),
                                 {bootstrap->low, bootstrap->high}}
                          : nothing(table.columns[5]));
  return row;
}

void add_scores(const Questionnaire& form, const std::string& asked,
                const std::vector<GivenAnswer>& answers, ReportTable& means, ReportTable& each) {
  if (!form.is_mean_scored) {
    return;
  }
  const FormScores scores = scores_of(form, asked, answers);
  means.rows.push_back(score_row(form, asked, scores, means));
  for (const auto& [participant, score] : scores.of_participants) {
    each.rows.push_back({word(form.name), word(asked), word(participant), number(score)});
  }
}

std::vector<Column> with_form(std::vector<Column> columns) {
  columns.insert(columns.begin(), {column("form", "form"), column("asked", "asked")});
  return columns;
}

std::vector<ReportTable> empty_tables() {
  return {{"questionnaire_items", "Answers to each question, numbers as median (quartiles)",
           with_form({column("item", "item"),
                      column("kind", "kind"),
                      column("answered", "answered"),
                      column("left out", "left_out"),
                      {"median", {"median", "quartile_low", "quartile_high"}}})},
          {"questionnaire_answers", "How often each step and option was chosen",
           with_form({column("item", "item"), column("answer", "answer"),
                      column("participants", "participants")})},
          {"questionnaire_scores", "Scores from 0 to 100, means over participants",
           with_form({column("scored", "scored"),
                      column("incomplete", "incomplete"),
                      interval_column("mean (95 % CI)", "mean"),
                      {"95 % CI, bootstrap", {"bootstrap_low", "bootstrap_high"}}})},
          {"questionnaire_scores_of_participants", "Scores of each participant",
           with_form({column("participant", "participant"), column("score", "score")})}};
}
}  // namespace

ReportSection questionnaires_section(const std::vector<Questionnaire>& forms,
                                     const std::vector<GivenAnswer>& answers) {
  ReportSection section{"Questionnaires", empty_tables()};
  section.name = study_sections::questionnaires;
  if (answers.empty()) {
    if (!forms.empty()) {
      section.remarks.emplace_back("No answers to questionnaires are stored of these sessions.");
    }
    return section;
  }
  bool is_any_scored = false;
  for (const Questionnaire& form : forms) {
    is_any_scored = is_any_scored || form.is_mean_scored;
    for (const std::string& asked : form.asked) {
      add_items(form, asked, answers, section.tables[0]);
      add_counts(form, asked, answers, section.tables[1]);
      add_scores(form, asked, answers, section.tables[2], section.tables[3]);
    }
  }
  section.remarks.emplace_back(
      "Marks on a line are from 0 (low) to 1 (high). Free text is counted, not printed.");
  if (is_any_scored) {
    section.remarks.emplace_back(
        core::citing("Task load is the raw TLX: the mean of the six scales of NASA-TLX without "
                     "weights, from 0 to 100 ({}; {}), of those who answered all six.",
                     "Hart and Staveland 1988"_source, "Hart 2006"_source));
  }
  return section;
}
}  // namespace tapstudy::analysis
