#include <fmt/format.h>

#include <limits>

#include "analysis/report/document/block_summary.hpp"
#include "analysis/report/document/formats.hpp"
#include "analysis/report/document/sections.hpp"
#include "analysis/report/document/wording.hpp"
#include "analysis/statistics/csv_rows.hpp"
#include "analysis/statistics/population/means.hpp"
#include "core/error.hpp"
#include "support/catch.hpp"
#include "support/formats.hpp"
using namespace tapstudy;
using namespace tapstudy::analysis;

namespace {
BlockSummary small_summary() {
  BlockSummary summary{BlockDesign{}};
  ReportTable table{
      "heights",
      "Heights",
      {column("who", "who"), interval_column("height", "height"), column("", "reason")}};
  table.rows.push_back({word("a, <b>"),
                        interval(1.5, {1.0, std::numeric_limits<double>::infinity()}),
                        word("tall")});
  table.rows.push_back({word("c"), nothing(table.columns[1]), {"", {Value{}}}});
  summary.results().tables.push_back(table);
  summary.results().remarks.emplace_back("Of <two> people.");
  return summary;
}
}  // namespace

TEST_CASE("every format of a table has the same values", "[analysis][tables]") {
  const testing::Formats formats = testing::formats_of(small_summary());
  std::istringstream csv{formats.csv.at("heights.csv")};
  const CsvText read = read_csv(csv, "heights.csv");
  const std::vector<std::string> header{"who", "height", "height_low", "height_high", "reason"};
  CHECK(read.rows[0].cells == header);
  CHECK(read.rows[1].cells == std::vector<std::string>{"a, <b>", "1.5", "1", "inf", "tall"});
  CHECK(read.rows[2].cells == std::vector<std::string>{"c", "", "", "", ""});
  const auto& first = formats.json["heights"][0];
  CHECK(first["who"] == "a, <b>");
  CHECK(first["height"] == 1.5);
  CHECK(first["height_high"] == "inf");
  CHECK(formats.json["heights"][1]["height_low"].is_null());
  CHECK_THAT(formats.text, Contains("a, <b>  1.5 (1 to ∞)"));
  CHECK_THAT(formats.html,
             Contains("a, &lt;b&gt;</th><td data-heading=\"height\">1.5 (1 to ∞)</td>"));
  CHECK_THAT(formats.text, !Contains("tall"));
  CHECK_THAT(formats.html, Contains("Of &lt;two&gt; people."));
}

TEST_CASE("a table without a column for people is in the files for programs alone",
          "[analysis][tables]") {
  BlockSummary summary{BlockDesign{}};
  ReportTable table{"notes", "Notes", {column("who", "who"), column("", "note")}};
  table.rows.push_back({{"", {Value{}}}, word("nobody")});
  summary.results().tables.push_back(table);
  const testing::Formats formats = testing::formats_of(summary);
  CHECK(formats.json["notes"][0]["note"] == "nobody");
  CHECK_THAT(formats.csv.at("notes.csv"), Contains("nobody"));
  CHECK_THAT(formats.text + formats.html, !Contains("Notes"));
  CHECK(tables_shown(summary.sections.front(), &ShownIn::latex).empty());
}

TEST_CASE("a table for LaTeX shows every character as itself", "[analysis][tables]") {
  ReportTable table{"t", "50 % of A_1", {column("who", "who"), column("n & m", "n")}};
  table.rows.push_back({word("\\input{x} #1 ~ a^b $5"), word("χ² 1–2")});
  std::ostringstream out;
  write_table_latex(out, table, "t");
  CHECK(out.str() ==
        "\\begin{table}[htbp]\n\\centering\n\\caption{50 \\% of A\\_1}\n\\label{tab:t}\n"
        "\\begin{tabular}{ll}\n\\toprule\nwho & n \\& m \\\\\n\\midrule\n"
        "\\textbackslash{}input\\{x\\} \\#1 \\textasciitilde{} a\\textasciicircum{}b \\$5 & "
        "$\\chi$\\textsuperscript{2} 1--2 \\\\\n\\bottomrule\n\\end{tabular}\n\\end{table}\n");
}

TEST_CASE("a table too wide for a terminal is written entry by entry", "[analysis][tables]") {
  BlockSummary summary{BlockDesign{}};
  ReportTable table{"wide", "Wide", {}};
  std::vector<Cell> row;
  for (int i = 0; i < 12; ++i) {
    table.columns.push_back(column("heading " + std::to_string(i), "key" + std::to_string(i)));
    row.push_back(word("value " + std::to_string(i)));
  }
  table.rows.push_back(row);
  summary.results().tables.push_back(table);
  const std::string text = testing::formats_of(summary).text;
  CHECK(testing::longest_line(text) <= 100);
  CHECK_THAT(text, Contains("    heading 11: value 11\n"));
}

TEST_CASE("wrapped text keeps its words and fits", "[analysis][tables]") {
  std::string text;
  for (int i = 0; i < 60; ++i) {
    text += (i == 0 ? "" : " ") + std::string(static_cast<std::size_t>(i % 9 + 1), 'x') + "–";
  }
  const std::string lines = wrapped(text, 4);
  CHECK(testing::longest_line(lines) <= 100);
  CHECK(testing::longest_line(lines) > 88);
  std::istringstream before{text};
  std::istringstream after{lines};
  const std::vector<std::string> words{std::istream_iterator<std::string>{before}, {}};
  const std::vector<std::string> kept{std::istream_iterator<std::string>{after}, {}};
  CHECK(kept == words);
}

TEST_CASE("ticks are few, round and within their range", "[analysis][tables]") {
  for (const Interval& range :
       {Interval{0.0, 1.0}, Interval{-3.0, 17.0}, Interval{0.013, 0.42}, Interval{1e6, 9e9}}) {
    for (const bool is_logarithmic : {false, true}) {
      if (is_logarithmic && range.low <= 0.0) {
        continue;
      }
      const std::vector<double> found = ticks(range, is_logarithmic);
      CHECK(found.size() >= 2);
      CHECK(found.size() <= 6);
      CHECK(std::ranges::is_sorted(found));
      CHECK(found.front() >= range.low);
      CHECK(found.back() <= range.high);
    }
  }
}

TEST_CASE("a figure's marks lie where their values are", "[analysis][tables]") {
  Chart chart{"c", "two <marks>", "x", "y", {0.0, 10.0}, {0.0, 1.0}};
  chart.points = {{5.0, 0.5}, {20.0, 0.5}};
  const std::string svg = inline_svg(chart);
  CHECK_THAT(svg, Contains("aria-label=\"two &lt;marks&gt;\""));
  CHECK_THAT(svg, Contains("cx=\"191.0\" cy=\"95.0\""));  // half way between 52 and 330, 10 and 180
  CHECK_THAT(svg, Contains("cx=\"330.0\" cy=\"95.0\""));  // beyond the range: at its edge
}

namespace {
BlockDesign design() {
  BlockDesign design;
  design.name = "stiffness";
  design.question = "Which is stiffer?";
  design.further_axes = {{"damping_scale", "damping scale", ""}};
  return design;
}

results::AnswerRow answer_at(std::int64_t trial, double damping_scale) {
  results::AnswerRow answer;
  answer.trial_id = trial;
  answer.alternatives = {{0, "A", "plate", {{"damping_scale", damping_scale}}, false},
                         {1, "B", "plate", {{"damping_scale", damping_scale}}, true}};
  return answer;
}
}  // namespace

TEST_CASE("every answer is in the one part that has its values on the further axes",
          "[analysis][report]") {
  BlockRows rows;
  rows.answers = {answer_at(1, 2.0), answer_at(2, 0.5), answer_at(3, 2.0 + 1e-15),
                  answer_at(4, 2.0)};
  rows.orders = {{2, {0, 1}}, {4, {1, 0}}};
  const std::vector<BlockPart> parts = parts_at_further_values(design(), rows);
  REQUIRE(parts.size() == 2);
  CHECK(parts[0].design.name == "stiffness_at_damping_scale_0.5");
  CHECK(parts[1].design.name == "stiffness_at_damping_scale_2");
  CHECK(parts[1].design.question == "Which is stiffer? (damping scale 2)");
  REQUIRE(parts[0].rows.answers.size() == 1);
  CHECK(parts[0].rows.answers[0].trial_id == 2);
  CHECK(parts[1].rows.answers.size() == 3);
  REQUIRE(parts[1].rows.orders.size() == 1);
  CHECK(parts[1].rows.orders[0].trial_id == 4);
}

TEST_CASE("a block without further axes, or without answers, is one part", "[analysis][report]") {
  CHECK(parts_at_further_values(design(), {}).size() == 1);
  BlockDesign simple = design();
  simple.further_axes.clear();
  BlockRows rows;
  rows.answers = {answer_at(1, 2.0), answer_at(2, 0.5)};
  const std::vector<BlockPart> parts = parts_at_further_values(simple, rows);
  REQUIRE(parts.size() == 1);
  CHECK(parts[0].design.name == "stiffness");
  CHECK(parts[0].rows.answers.size() == 2);
}

TEST_CASE("an answer without a value on a further axis is refused", "[analysis][report]") {
  BlockRows rows;
  rows.answers = {answer_at(1, 2.0)};
  rows.answers[0].alternatives[0].axis_values.clear();
  CHECK_THROWS_AS(parts_at_further_values(design(), rows), core::InvalidInput);
}

TEST_CASE("the interval of pooled answers is that over participants, never the score interval",
          "[analysis][participants]") {
  const std::vector<Proportion> people{{8, 8}, {7, 8}, {2, 8}, {1, 8}, {8, 8}, {0, 8}};
  const Cell cell = pooled_proportion(people);
  const auto over = mean_proportion(people);
  REQUIRE(over);
  CHECK(cell.values ==
        std::vector<Value>{26, 48, 26.0 / 48.0, over->interval->low, over->interval->high});
  const Interval score = wilson_interval({26, 48});
  CHECK(over->interval->high - over->interval->low > 1.5 * (score.high - score.low));
  CHECK_THAT(cell.text.words, Contains("26/48 = 54 % (95 % CI over 6 participants "));
  const Cell unequal = pooled_proportion({{8, 8}, {2, 4}, {1, 4}});
  CHECK_THAT(unequal.text.words, Contains("11/16 = 69 % (mean of 3 participants 58 %, 95 % CI "));
  const Cell two = pooled_proportion({{8, 8}, {4, 8}});
  CHECK(two.values == std::vector<Value>{12, 16, 0.75, Value{}, Value{}});
  CHECK_THAT(two.text.words, Contains("no CI for so few"));
}

TEST_CASE("answers of one participant have their score interval, of none no share",
          "[analysis][participants]") {
  CHECK(pooled_proportion({{6, 8}}).values == proportion({6, 8}).values);
  const Cell none = pooled_proportion({{0, 0}, {0, 0}});
  CHECK(none.values == proportion({0, 0}).values);
  const Cell one_of_two = pooled_proportion({{6, 8}, {0, 0}});
  CHECK(one_of_two.values == std::vector<Value>{6, 8, 0.75, Value{}, Value{}});
  CHECK_THAT(one_of_two.text.words, !Contains("CI"));
}
