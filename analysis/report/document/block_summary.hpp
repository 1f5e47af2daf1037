#pragma once
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <ostream>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "analysis/report/document/block_design.hpp"
#include "analysis/report/document/sections.hpp"
#include "analysis/statistics/proportion.hpp"
#include "results/rows.hpp"
namespace tapstudy::analysis {
// What each participant's answers to a block come to, as one number.
struct PersonalValues {
  std::string measure;  // with its unit; blocks of one measure can be compared
  bool is_ratio{};      // values are above 0, and compared by their ratio
  std::map<std::string, double> by_participant;
  // Where the value of somebody lies who has none, such as above all levels that were presented.
  std::map<std::string, Interval> beyond{};
  std::set<std::string> participants{};  // all who took part; those above where it is empty
  std::optional<Interval> scale{};       // beyond whose ends no value can be; unset: there are none
};

std::set<std::string> participants_of(const PersonalValues& values);
// How many took part in both.
int number_in_both(const PersonalValues& first, const PersonalValues& second);

// Of the people for whom value_of gives one.
template <class People, class ValueOf>
PersonalValues personal_values(std::string measure, bool is_ratio, const People& people,
                               const ValueOf& value_of) {
  PersonalValues values{std::move(measure), is_ratio, {}, {}, {}, {}};
  for (const auto& person : people) {
    values.participants.insert(person.participant_id);
    if (const std::optional<double> value = value_of(person)) {
      values.by_participant[person.participant_id] = *value;
    }
  }
  return values;
}

// The same, of shares.
template <class People, class ShareOf>
PersonalValues personal_shares(std::string measure, const People& people, const ShareOf& share_of) {
  PersonalValues values = personal_values(std::move(measure), false, people, share_of);
  values.scale = Interval{0.0, 1.0};
  return values;
}

// Unset without trials.
inline std::optional<double> share_of(const Proportion& proportion) {
  return proportion.trials > 0 ? std::optional{proportion.value()} : std::nullopt;
}

struct HypothesisResult {
  PlannedHypothesis planned;
  std::string test;
  Proportion observed;
  double chance{};
  std::optional<double> p;         // unset where there is no test: `test` says why
  double p_floor{};                // where no draw was as good: p is only known to be no larger
  std::optional<double> p_holm{};  // adjusted for all of the study's hypotheses (Holm 1979)
  std::string finding{};           // in words, where nothing is counted against chance
};

// What a block was made to find out, as one number of the whole sample.
struct MainResult {
  std::string name;  // with its unit
  double estimate{};
  std::optional<Interval> range;   // 95 %, over participants; unset: all have the same value
  std::optional<double> p{};       // of the planned test, where there is one
  std::optional<double> chance{};  // what guessing gives, of a share of right answers
  bool is_ratio{};                 // above 0, a geometric mean: studies are compared by the ratio
  // The range is by t of one degree of freedom less; unset: by the normal distribution.
  std::optional<int> people{};
  std::string of_whom{};  // ", 2 of them beyond the levels"; empty: all have a value of their own
};

// The alternatives of a trial as they were visited one after the other, by position from 0.
struct VisitOrder {
  std::int64_t trial_id{};
  std::vector<int> positions;
};

// Those of these answers' trials.
std::vector<VisitOrder> orders_of(const std::vector<VisitOrder>& all,
                                  const std::vector<results::AnswerRow>& answers);

// The rows of one block.
struct BlockRows {
  std::vector<results::AnswerRow> answers;
  std::vector<results::VisitRow> visits;
  std::vector<VisitOrder> orders{};  // of trials with several alternatives, where they are known
  int missing_replies{};             // trials that were presented, and not answered later
};

// The results of a statistic for a block: the data that every format is made from. Text and HTML
// show the words of the cells, JSON and CSV their values.
class BlockSummary {
 public:
  explicit BlockSummary(const BlockDesign& design)
      : block{design.name}, part_of{design.part_of}, task{design.task}, question{design.question} {}

  // In 100 columns, without the sections of detail.
  void write_text(std::ostream& out, std::size_t most_lines = all_lines) const;
  // Parts of a page: a paragraph for a paper, with the question, what came out of whom and of what
  // was declared; the results; what else the answers say.
  void write_words_html(std::ostream& out, int participants) const;  // of the whole study
  void write_html(std::ostream& out) const;
  void write_details_html(std::ostream& out) const;
  // Links to the parts of the last; empty: there are none.
  std::string details_links() const;
  // {"block", "task", "main_results", what `values` holds, TABLE: [{key: value}],
  // "remarks": [sentence], "hypotheses"}
  nlohmann::ordered_json as_json() const;
  // The publications that the page cites here.
  std::set<core::Source> sources() const;
  std::string anchor() const;       // of the results on the page
  int number_who_answered() const;  // 0: it is not known
  // What the block was made to find out.
  ReportSection& results() { return sections.front(); }
  const ReportSection& results() const { return sections.front(); }

  std::string block;    // empty where only a table of counts is known
  std::string part_of;  // the whole block, of which this is a part; empty: it is whole
  std::string task;
  std::string question;
  std::vector<HypothesisResult> hypotheses;
  std::optional<PersonalValues> personal{};  // unset: none, or they are not to be compared
  std::vector<ReportSection> sections =
      std::vector<ReportSection>(1);  // the results, then what else the answers say
  std::string methods{};  // how it was tested, as a sentence for a methods section; may be empty
  std::vector<MainResult> main_results{};  // empty: the answers do not determine it
  // An object of what programs read that is no table; unset: nothing.
  std::shared_ptr<const nlohmann::ordered_json> values{};
};

struct BlockPart {
  BlockDesign design;
  BlockRows rows;
};
// A block whose threshold depends on further axes, as one part for each combination of values on
// them that was presented, in ascending order, named after the block and the values: what is
// estimated of a part is at these. Any other block, and one without answers, as a whole. Visits
// and missing replies are of all parts.
// Throws InvalidInput where an answer's comparison has no value on a further axis.
std::vector<BlockPart> parts_at_further_values(const BlockDesign& design, const BlockRows& rows);
}  // namespace tapstudy::analysis
