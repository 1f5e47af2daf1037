#include "analysis/report/document/block_summary.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <iterator>
#include <map>
#include <span>
#include <unordered_set>

#include "analysis/report/document/formats.hpp"
#include "analysis/report/document/wording.hpp"
#include "core/error.hpp"
#include "core/text/print.hpp"
namespace tapstudy::analysis {
void BlockSummary::write_text(std::ostream& out, std::size_t most_lines) const {
  write_contents_text(out, results(), most_lines);
  write_hypotheses_text(out, hypotheses);
  for (const ReportSection& section : std::span{sections}.subspan(1)) {
    if (!section.is_detail) {
      write_sections_text(out, {&section, 1}, most_lines);
    }
  }
}

int BlockSummary::number_who_answered() const {
  return personal ? static_cast<int>(participants_of(*personal).size()) : 0;
}

std::string BlockSummary::anchor() const {
  return block.empty() ? "answers" : "block-" + block;
}

namespace {
// Empty: it is not known.
std::string who_answered(const BlockSummary& block, int participants) {
  const int known = block.number_who_answered();
  const int answered = known > 0 ? known : participants;
  if (answered == 0) {
    return "";
  }
  const std::string of = answered == participants ? "" : fmt::format(" of {}", participants);
  const std::string asked = block.question.empty() ? "" : fmt::format(" “{}”", block.question);
  const bool has_end = block.question.ends_with('?') || block.question.ends_with('.');
  return fmt::format("{}{} participant{} answered{}{}", answered, of, participants == 1 ? "" : "s",
                     asked, has_end ? "" : ".");
}

// What few people came to, of whom there may be no interval; "" of more.
std::string values_of_few(const BlockSummary& block) {
  constexpr std::size_t most = 3;
  if (!block.personal || block.personal->by_participant.empty() ||
      participants_of(*block.personal).size() > most) {
    return "";
  }
  std::vector<std::string> values;
  for (const auto& [participant, value] : block.personal->by_participant) {
    values.push_back(fmt::format("{} {}", participant, rounded(value)));
  }
  return fmt::format("{}: {}", block.personal->measure, fmt::join(values, ", "));
}

std::string hypothesis_in_words(const HypothesisResult& result) {
  std::string statement = result.planned.statement;
  if (statement.ends_with('.')) {
    statement.pop_back();
  }
  return fmt::format("{}: {} ({}{}{})", statement, p_value(result),
                     result.p ? finding_of(result) + "; " : "", result.test,
                     result.p_holm
                         ? fmt::format("; {} after {}", p_value(*result.p_holm), "Holm 1979"_source)
                         : "");
}
}  // namespace

void BlockSummary::write_words_html(std::ostream& out, int participants) const {
  constexpr std::size_t most_results = 6;
  std::vector<std::string> sentences{who_answered(*this, participants)};
  std::vector<std::string> found;
  const std::size_t shown = std::min(main_results.size(), most_results);
  std::transform(main_results.begin(), main_results.begin() + static_cast<std::ptrdiff_t>(shown),
                 std::back_inserter(found),
                 [&](MainResult one) {  // of how many the sentence before has said
                   if (one.of_whom.empty() && one.people == number_who_answered()) {
                     one.people.reset();
                   }
                   return in_words(one, number_who_answered());
                 });
  if (const std::string few = values_of_few(*this); found.empty() && !few.empty()) {
    found.push_back(few);
  }
  if (!found.empty()) {
    char& first = found.front().front();
    first = static_cast<char>(std::toupper(static_cast<unsigned char>(first)));
    sentences.push_back(
        fmt::format("{}{}.", fmt::join(found, "; "),
                    main_results.size() > most_results ? "; the others stand in the tables" : ""));
  }
  std::vector<std::string> declared;
  std::ranges::transform(hypotheses, std::back_inserter(declared), hypothesis_in_words);
  if (!declared.empty()) {
    sentences.push_back(fmt::format("Declared before the study: {}.", fmt::join(declared, "; ")));
  }
  std::erase(sentences, "");
  core::print(out, "<p>{}{}</p>\n", block.empty() ? "" : fmt::format("<b>{}.</b> ", escaped(block)),
              escaped_numbers(fmt::format("{}", fmt::join(sentences, " "))));
}

namespace {
// Of a block's results: what is seen at once, and the rest.
struct Results {
  ReportSection first;
  ReportSection others;
};
Results split(const ReportSection& whole) {
  constexpr std::size_t most_tables = 2;
  constexpr std::size_t most_charts = 2;
  Results results{{}, {"More of the results"}};
  for (const ReportTable* const table : tables_shown(whole, &ShownIn::page)) {
    auto& tables =
        results.first.tables.size() < most_tables ? results.first.tables : results.others.tables;
    tables.push_back(*table);
  }
  for (const Chart& chart : whole.charts) {
    auto& charts =
        results.first.charts.size() < most_charts ? results.first.charts : results.others.charts;
    charts.push_back(chart);
  }
  results.others.folded_charts = whole.folded_charts;
  results.others.remarks = whole.remarks;
  return results;
}

std::vector<ReportSection> details_of(const BlockSummary& block) {
  std::vector<ReportSection> details = block.sections;
  details.front() = split(block.results()).others;
  return details;
}
}  // namespace

// A matrix is the figure of its block; any other table comes after the figures.
void BlockSummary::write_html(std::ostream& out) const {
  ReportSection first = split(results()).first;
  const bool has_matrix = !first.tables.empty() && first.tables.front().is_matrix;
  if (!has_matrix) {
    ReportSection figures;
    figures.charts.swap(first.charts);
    write_contents_html(out, figures);
  }
  write_contents_html(out, first);
}

void BlockSummary::write_details_html(std::ostream& out) const {
  write_sections_html(out, details_of(*this), anchor(), true);
}

std::string BlockSummary::details_links() const {
  return section_links(details_of(*this), anchor());
}

std::set<core::Source> BlockSummary::sources() const {
  std::set<core::Source> cited;
  for (const ReportSection& section : sections) {
    add_sources(cited, section);
  }
  if (std::ranges::any_of(hypotheses,
                          [](const auto& result) { return result.p_holm.has_value(); })) {
    cited.insert("Holm 1979"_source);
  }
  return cited;
}

std::set<std::string> participants_of(const PersonalValues& values) {
  std::set<std::string> all = values.participants;
  for (const auto& [participant, value] : values.by_participant) {
    all.insert(participant);
  }
  for (const auto& [participant, range] : values.beyond) {
    all.insert(participant);
  }
  return all;
}

int number_in_both(const PersonalValues& first, const PersonalValues& second) {
  const std::set<std::string> others = participants_of(second);
  return static_cast<int>(std::ranges::count_if(
      participants_of(first), [&](const std::string& one) { return others.contains(one); }));
}

std::vector<VisitOrder> orders_of(const std::vector<VisitOrder>& all,
                                  const std::vector<results::AnswerRow>& answers) {
  std::unordered_set<std::int64_t> trials;
  for (const results::AnswerRow& answer : answers) {
    trials.insert(answer.trial_id);
  }
  std::vector<VisitOrder> own;
  std::ranges::copy_if(all, std::back_inserter(own),
                       [&](const VisitOrder& order) { return trials.contains(order.trial_id); });
  return own;
}

namespace {
using results::AnswerRow;

// Nine digits, because values of one stimulus differ in their last ones where they are products.
std::string digits(double value) {
  return fmt::format("{:.9g}", value);
}

// All alternatives of a trial have the same ones.
std::vector<double> further_values(const BlockDesign& design, const AnswerRow& answer) {
  std::vector<double> values;
  for (const AxisName& axis : design.further_axes) {
    const auto& presented = answer.alternatives.front().axis_values;
    const auto value = presented.find(axis.key);
    if (value == presented.end()) {
      throw core::InvalidInput{fmt::format("block '{}': trial {} of {} has no value of '{}'",
                                           design.name, answer.number, answer.participant_id,
                                           axis.key)};
    }
    values.push_back(std::stod(digits(value->second)));
  }
  return values;
}

BlockDesign at(const BlockDesign& whole, const std::vector<double>& values) {
  BlockDesign part = whole;
  part.part_of = whole.name;
  std::vector<std::string> words;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const AxisName& axis = whole.further_axes[i];
    part.name += fmt::format("_at_{}_{}", axis.key, digits(values[i]));
    words.push_back(fmt::format("{} {}{}{}", axis.quantity, digits(values[i]),
                                axis.unit.empty() ? "" : " ", axis.unit));
  }
  part.question += fmt::format(" ({})", fmt::join(words, ", "));
  return part;
}
}  // namespace

std::vector<BlockPart> parts_at_further_values(const BlockDesign& design, const BlockRows& rows) {
  if (design.further_axes.empty() || rows.answers.empty()) {
    return {{design, rows}};
  }
  std::map<std::vector<double>, BlockRows> at_values;
  for (const AnswerRow& answer : rows.answers) {
    at_values[further_values(design, answer)].answers.push_back(answer);
  }
  std::vector<BlockPart> parts;
  for (auto& [values, part] : at_values) {
    part.visits = rows.visits;
    part.orders = orders_of(rows.orders, part.answers);
    part.missing_replies = rows.missing_replies;
    parts.push_back({at(design, values), std::move(part)});
  }
  return parts;
}
}  // namespace tapstudy::analysis
