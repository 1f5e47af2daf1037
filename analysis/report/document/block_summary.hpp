#pragma once
#include <functional>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "analysis/report/document/block_design.hpp"
#include "analysis/report/document/cells.hpp"
#include "analysis/report/document/chart.hpp"
#include "analysis/statistics/proportion.hpp"
#include "results/rows.hpp"
namespace tapstudy::analysis {
// What each participant's answers to a block come to, as one number.
struct PersonalValues {
  std::string measure;  // with its unit; blocks of one measure can be compared
  bool is_ratio{};      // values are above 0, and compared by their ratio
  std::map<std::string, double> by_participant;
};

// Of the people for whom value_of gives one.
template <class People, class ValueOf>
PersonalValues personal_values(std::string measure, bool is_ratio, const People& people,
                               const ValueOf& value_of) {
  PersonalValues values{std::move(measure), is_ratio, {}};
  for (const auto& person : people) {
    if (const std::optional<double> value = value_of(person)) {
      values.by_participant[person.participant_id] = *value;
    }
  }
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
};

// What a block was made to find out, as one number of the whole sample.
struct MainResult {
  std::string name;  // with its unit
  double estimate{};
  Interval range;                  // 95 %, over participants
  std::optional<double> p{};       // of the planned test, where there is one
  std::optional<double> chance{};  // what guessing gives, of a share of right answers
  bool is_ratio{};                 // above 0, a geometric mean: studies are compared by the ratio
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

// A separate CSV table: its file name suffix and its writer.
struct CsvTable {
  std::string name;
  std::function<void(std::ostream&)> write;
};

// The results of a statistic for a block, with its output in each format. Writers only format; they
// compute nothing.
class BlockSummary {
 public:
  explicit BlockSummary(const BlockDesign& design)
      : block{design.name}, part_of{design.part_of}, task{design.task}, question{design.question} {}
  virtual ~BlockSummary() = default;
  BlockSummary(const BlockSummary&) = default;
  BlockSummary& operator=(const BlockSummary&) = default;
  BlockSummary(BlockSummary&&) = default;
  BlockSummary& operator=(BlockSummary&&) = default;

  virtual void write_text(std::ostream& out) const = 0;  // for a terminal
  virtual void write_html(std::ostream& out) const = 0;  // a part of a page
  virtual nlohmann::ordered_json as_json() const = 0;
  virtual std::vector<CsvTable> tables() const = 0;
  // Those for people.
  virtual std::vector<ReportTable> report_tables() const = 0;
  // Its figures; marks within tables are none.
  virtual std::vector<Chart> figures() const { return {}; }
  // How it was tested, as a sentence for a methods section; may be empty.
  virtual std::string methods() const { return {}; }
  // Empty: the answers do not determine it.
  virtual std::vector<MainResult> main_results() const { return {}; }

  std::string block;    // empty where only a table of counts is known
  std::string part_of;  // the whole block, of which this is a part; empty: it is whole
  std::string task;
  std::string question;
  std::vector<HypothesisResult> hypotheses;
  std::optional<PersonalValues> personal{};  // unset: none, or they are not to be compared
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
