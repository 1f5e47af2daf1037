#include "analysis/statistics/confusion_matrix.hpp"

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "analysis/report/answer_tables/counts_csv.hpp"
#include "analysis/report/blocks/choices.hpp"
#include "analysis/report/confusion/confusion_summary.hpp"
#include "analysis/report/document/formats.hpp"
#include "analysis/report/document/wording.hpp"
#include "analysis/report/summary.hpp"
#include "analysis/report/writers.hpp"
#include "core/error.hpp"
#include "support/catch.hpp"
#include "support/reference_programs.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using namespace tapstudy::analysis;

namespace {
ConfusionMatrix matrix_from(const std::string& text) {
  std::istringstream stream{text};
  return read_counts(read_csv(stream, "counts.csv"), "counts.csv", false, {"unsure"});
}
std::string refusal(const std::string& text) {
  try {
    matrix_from(text);
  } catch (const core::InvalidInput& error) {
    return error.what();
  }
  return "accepted";
}
ConfusionMatrix table2() {
  return matrix_from(testing::contents(testing::shipped("paper/table2.csv")));
}
bool is(const Proportion& proportion, int successes, int trials) {
  return proportion.successes == successes && proportion.trials == trials;
}
}  // namespace

TEST_CASE("the paper's Table 2 says what the paper says", "[analysis][confusion]") {
  const ConfusionMatrix matrix = table2();
  CHECK(is(overall_accuracy(matrix), 43, 80));
  CHECK(is(factor_accuracy(matrix, "structure"), 65, 80));
  CHECK(is(factor_accuracy(matrix, "material"), 48, 80));
  CHECK(is(conditional_accuracy(matrix, "material", "structure"), 43, 65));
  CHECK(matrix.chance() == 0.25);
}

TEST_CASE("a matrix that is written is read back the same", "[analysis][confusion]") {
  std::ostringstream text;
  write_table_csv(text, IdentificationSummary{BlockDesign{}, table2()}.results().tables.front());
  CHECK(matrix_from(text.str()).counts == table2().counts);
  CHECK(factors_of(matrix_from(text.str())) == std::vector<std::string>{"material", "structure"});
}

TEST_CASE("a matrix of R's and pandas' is read by rows or by columns, as is said, and not guessed",
          "[analysis][confusion]") {
  const std::string with_corner =
      GENERATE("\"\",\"oak\",\"steel\"\n\"oak\",7,3\n\"steel\",1,9\n",  // R: write.csv(table(…))
               "plate,oak,steel\noak,7,3\nsteel,1,9\n",                 // pandas: crosstab
               "oak,steel\noak,7,3\nsteel,1,9\n");                      // R: write.table
  std::istringstream stream{with_corner};
  const CsvText csv = read_csv(stream, "counts.csv");
  const ConfusionMatrix by_rows = read_counts(as_matrix(csv, MatrixRows::stimuli), "counts.csv");
  const ConfusionMatrix by_columns =
      read_counts(as_matrix(csv, MatrixRows::responses), "counts.csv");
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t j = 0; j < 2; ++j) {
      CHECK(by_rows.counts[i][j] == by_columns.counts[j][i]);
    }
  }
  CHECK(by_rows.counts[0][1] == 3);
  if (!with_corner.starts_with("oak")) {
    CHECK_THAT(refusal(with_corner), Contains("--rows stimuli or --rows responses"));
  }
}

TEST_CASE("what rows stand for is not said against the corner", "[analysis][confusion]") {
  const auto read = [](const std::string& corner, MatrixRows rows) {
    std::istringstream stream{corner + ",oak,steel\noak,7,3\nsteel,1,9\n"};
    return read_counts(as_matrix(read_csv(stream, "counts.csv"), rows), "counts.csv").counts[0][1];
  };
  CHECK(read("Predicted", MatrixRows::responses) == 1);
  CHECK(read("true", MatrixRows::stimuli) == 3);
  CHECK(read("Actual\\Predicted", MatrixRows::stimuli) == 3);
  CHECK_THROWS_WITH(read("response", MatrixRows::stimuli), Contains("begins with 'response'"));
  CHECK_THROWS_WITH(read("stimulus", MatrixRows::responses), Contains("as if rows were stimuli"));
}

TEST_CASE("a printed matrix has the exact interval and binomial test of R's binom.test",
          "[analysis][confusion]") {
  const auto r = testing::r_numbers(
      "b <- binom.test(43, 80, .25, 'greater'); out(binom.test(43, 80)$conf.int, b$p.value, "
      "prop.test(43, 80, correct = FALSE)$conf.int)");
  const auto row =
      IdentificationSummary{BlockDesign{}, table2()}.as_json().at("independent_accuracy").at(0);
  INFO(row.dump());
  CHECK(row.at("exact_low").get<double>() == Approx(r[0]).epsilon(1e-9));
  CHECK(row.at("exact_high").get<double>() == Approx(r[1]).epsilon(1e-9));
  CHECK(row.at("p").get<double>() == Approx(r[2]).epsilon(1e-9));
  CHECK(row.at("right_share_low").get<double>() == Approx(r[3]).epsilon(1e-9));
  CHECK(row.at("right_share_high").get<double>() == Approx(r[4]).epsilon(1e-9));
}

TEST_CASE("a cell in quotes may hold commas, quotes and line ends, and is written back so",
          "[analysis][confusion]") {
  const ConfusionMatrix matrix = matrix_from(
      "# \"a comment, with a quote\nstimulus,\"wood, hard\",\"say \"\"b\"\"\"\n"
      "\"wood, hard\",3, 1 \n\n\"say \"\"b\"\"\",0,2\n");
  CHECK(matrix.responses.at(0).name == "wood, hard");
  CHECK(matrix.responses.at(1).name == "say \"b\"");
  CHECK(is(overall_accuracy(matrix), 5, 6));
  std::ostringstream text;
  write_table_csv(text, IdentificationSummary{BlockDesign{}, matrix}.results().tables.front());
  CHECK(matrix_from(text.str()).counts == matrix.counts);
  CHECK(matrix_from(text.str()).stimuli.at(1).name == "say \"b\"");
  CHECK_THAT(refusal("stimulus,a,b\na,1,2\nb,\"1,2\n"), Contains("counts.csv:3: a quote"));
}

TEST_CASE("an answer that names no stimulus counts as an answer", "[analysis][confusion]") {
  const ConfusionMatrix matrix =
      matrix_from("stimulus,factor:material,a,b,unsure\na,wood,11,3,6\nb,metal,2,5,13\n");
  CHECK(is(overall_accuracy(matrix), 16, 40));
  CHECK(is(factor_accuracy(matrix, "material"), 16, 40));
}

TEST_CASE("chance is what guessing gives to those who say as often that they do not know",
          "[analysis][confusion]") {
  // 19 of 40 answers are "unsure": of the 21 others a guess is right half of the time
  const ConfusionMatrix matrix =
      matrix_from("stimulus,factor:material,a,b,unsure\na,wood,11,3,6\nb,metal,2,5,13\n");
  CHECK(matrix.chance() == Approx(21.0 / 40.0 / 2.0).epsilon(1e-9));
  CHECK(factor_chance(matrix, "material", "") == Approx(matrix.chance()).epsilon(1e-9));
  const Summary summary = summarise(matrix, "a table", "tell_apart");
  std::ostringstream html;
  write_html(html, summary);
  CHECK_THAT(html.str(), Contains("the choice was not forced"));
}

TEST_CASE("a factor of one level is left out with a word", "[analysis][confusion]") {
  const ConfusionMatrix matrix =
      matrix_from("stimulus,factor:m,factor:n,a,b\na,x,u,5,3\nb,x,v,2,6\n");
  CHECK(factors_of(matrix) == std::vector<std::string>{"n"});
  CHECK(factors_of_one_level(matrix) == std::vector<std::string>{"m"});
  std::ostringstream html;
  write_html(html, summarise(matrix, "a table", "tell_apart"));
  CHECK_THAT(html.str(), Contains("Factor m is left out"));
}

TEST_CASE("a column is a factor only if its header says so", "[analysis][confusion]") {
  const ConfusionMatrix matrix = matrix_from("stimulus,unsure,a,b\na,9,1,0\nb,6,0,1\n");
  CHECK(is(overall_accuracy(matrix), 2, 17));
  CHECK_THAT(refusal("stimulus,material,a,b\na,wood,1,2\nb,metal,1,2\n"),
             Contains("counts.csv:2: 'wood' is not a count") && Contains("factor:NAME"));
  CHECK_THAT(refusal("stimulus,a,factor:m,b\na,1,x,2\nb,1,y,2\n"), Contains("counts.csv:1"));
}

TEST_CASE("a stimulus may be called #1, and only comments above the header are skipped",
          "[analysis][confusion]") {
  const ConfusionMatrix matrix = matrix_from("# a comment\nstimulus,#1,b\n#1,3,1\nb,0,2\n");
  CHECK(is(overall_accuracy(matrix), 5, 6));
}

TEST_CASE("what is no text is refused at its line", "[analysis][confusion]") {
  CHECK_THAT(refusal("stimulus,a,b\na,1,2\n\xff\xfe,1,2\n"),
             Contains("counts.csv:3: is not UTF-8"));
  CHECK_THAT(refusal("stimulus,a,b\na\x1b[2J,1,2\nb,1,2\n"),
             Contains("counts.csv:2: has a control character"));
  std::ifstream endless{"/dev/zero"};
  CHECK_THROWS_AS(read_csv(endless, "/dev/zero"), core::InvalidInput);
}

TEST_CASE("a table of simulated participants says so, and so does a report made of it",
          "[analysis][report]") {
  std::istringstream stream{"# mode: simulated\nstimulus,a,b\na,1,2\nb,1,2\n"};
  const CsvText table = read_csv(stream, "counts.csv");
  CHECK_THAT(
      banner(summarise(read_counts(table, "counts.csv"), "a table", "tell_apart", modes_in(table))),
      Contains("SIMULATED"));
  std::istringstream mixed{"# mode: pilot, real\nstimulus,a,b\na,1,2\nb,1,2\n"};
  CHECK(modes_in(read_csv(mixed, "counts.csv")) == std::set<std::string>{"pilot", "real"});
}

TEST_CASE("the largest table is added up without overflow", "[analysis][confusion]") {
  std::string text = "stimulus";
  for (int i = 0; i < 47; ++i) {
    text += ",s" + std::to_string(i);
  }
  for (int i = 0; i < 47; ++i) {
    text += "\ns" + std::to_string(i);
    for (int j = 0; j < 47; ++j) {
      text += ",1000000";
    }
  }
  const ConfusionMatrix matrix = matrix_from(text + "\n");
  CHECK(matrix.total() == 2'209'000'000);
  CHECK(overall_accuracy(matrix).value() == Approx(1.0 / 47.0).epsilon(1e-9));
}

TEST_CASE(
    "an interval's ends are told apart, a factor of one level and an empty block are left out",
    "[analysis][report]") {
  const ConfusionMatrix matrix =
      matrix_from("stimulus,factor:material,a,b\na,wood,250000,750000\nb,wood,750000,250000\n");
  CHECK(factors_of(matrix).empty());
  CHECK(with_interval(overall_accuracy(matrix)) == "500000/2000000 = 25.0 % (95 % CI 24.9–25.1 %)");
  const BlockDesign block{"empty",
                          "tell_apart",
                          "Which?",
                          "confusion",
                          matrix.stimuli,
                          matrix.responses,
                          {{"h", "better than chance", ""}},
                          {},
                          ""};
  const Summary summary = summarise({"study", "", {block}}, {}, {});
  std::ostringstream text;
  write_text(text, summary);
  CHECK_THAT(text.str(), Contains("block 'empty' is left out: it has no answer; hypothesis 'h' is "
                                  "not tested") &&
                             !Contains("p = "));
}

TEST_CASE("the chance of a factor weighs stimuli as they were presented", "[analysis][confusion]") {
  // three of four responses are wood; wood was presented 10 times, metal 40
  const ConfusionMatrix matrix = matrix_from(
      "stimulus,factor:material,a,b,c,d\na,wood,10,0,0,0\nb,wood,0,0,0,0\nc,wood,0,0,0,0\n"
      "d,metal,0,0,0,40\n");
  CHECK(factor_chance(matrix, "material", "") ==
        Approx((10 * 0.75 + 40 * 0.25) / 50).epsilon(1e-9));
}

TEST_CASE("a table that is no confusion matrix is refused at its line", "[analysis][confusion]") {
  CHECK_THAT(refusal(""), Contains("counts.csv:1"));
  CHECK_THAT(refusal("a,b\n1,2\n"), Contains("starts with 'stimulus'"));
  CHECK_THAT(refusal("stimulus,a,b\na,1\n"), Contains("counts.csv:2: has 2 cells"));
  CHECK_THAT(refusal("stimulus,a,b\na,1,x\nb,1,2\n"), Contains("counts.csv:2: 'x' is not a count"));
  CHECK_THAT(refusal("stimulus,a,b\na,1,-1\nb,1,2\n"), Contains("'-1' is not a count"));
  CHECK_THAT(refusal("stimulus,a,b\na,1,2\na,1,2\n"), Contains("is there twice"));
  CHECK_THAT(refusal("stimulus,a,b\na,0,0\nb,0,0\n"), Contains("no answers"));
  CHECK_THAT(refusal("stimulus,factor:material\na,wood\nb,metal\n"), Contains("fewer than two"));
  CHECK_THAT(refusal("stimulus,a,a,b\na,1,2,3\nb,1,2,3\n"), Contains("'a' is there twice"));
  CHECK_THAT(refusal("stimulus,a,b\na,2147483647,1\nb,1,2\n"), Contains("is not a count"));
  CHECK_THAT(refusal("stimulus,mdf_tree,b\nmdf_three,3,1\nb,1,2\n"),
             Contains("counts.csv:2: no response is called 'mdf_three'") && Contains("mdf_tree"));
  CHECK_THAT(refusal("stimulus,a,b\na,3,1\n"), Contains("counts.csv:2: is the only stimulus"));
}

TEST_CASE("sums beside or below a matrix are refused, for they would count every answer twice",
          "[analysis][confusion]") {
  CHECK_THAT(refusal("stimulus,a,b,total\na,3,1,4\nb,2,5,7\n"),
             Contains("counts.csv:1: column 'total' is the sum of the others"));
  CHECK_THAT(refusal("stimulus,a,b,Sum\na,3,1,0\nb,2,5,0\nSum,5,6,0\n"),
             Contains("counts.csv:4: row 'Sum' is the sum of the others"));
  CHECK_THAT(
      refusal("stimulus,a,b\na,3,1\nb,2,5\nTotal,5,6\n"),
      Contains("counts.csv:4: row 'Total' is the sum of the others") && Contains("--are-counts"));
  CHECK(refusal("stimulus,a,b\na,3,3\nb,2,2\n") == "accepted");
  CHECK(refusal("stimulus,a,b,none\na,0,0,0\nb,2,1,3\n") != "accepted");
}

TEST_CASE("a matrix of percentages is refused, unless they are said to be counts",
          "[analysis][confusion]") {
  const std::string text = "stimulus,a,b,c\na,85,10,5\nb,33,33,33\nc,0,0,100\n";
  CHECK_THAT(refusal(text), Contains("counts.csv:1: each row adds up to 100, as percentages do") &&
                                Contains("--are-counts"));
  std::istringstream stream{text};
  CHECK(read_counts(read_csv(stream, "counts.csv"), "counts.csv", true).total() == 299);
  CHECK_THAT(refusal("stimulus,a,b,c\na,70,10,15\nb,20,60,5\nc,10,30,80\n"),
             Contains("each column adds up"));
  CHECK_THAT(refusal("stimulus,a,b,c\na,22,3,8\nb,0,28,6\nc,6,3,25\n"),
             Contains("all numbers together add up to 100") && Contains("--are-counts"));
  CHECK(refusal("stimulus,a,b,c\na,22,3,8\nb,0,28,6\nc,6,3,29\n") == "accepted");
  CHECK_THAT(refusal("stimulus,a,b\na,0.85,0.15\nb,0.5,0.5\n"), Contains("shares are no counts"));
  CHECK_THAT(refusal("stimulus,a,b\na,8,\nb,4,5\n"), Contains("counts.csv:2: has an empty cell"));
  CHECK(refusal("stimulus,a,b\na,85,15\nb,40,50\n") == "accepted");
  CHECK(refusal("stimulus,a,b\na,8.0,1.0\nb,4.0,5.0\n") == "accepted");
}

TEST_CASE("a column of a matrix that is no stimulus is an answer only where that is said",
          "[analysis][confusion]") {
  const std::string name =
      GENERATE("NA", "accuracy", "% correct", "rt", "d'", "id", "correct", "unsure?");
  const std::string text = "stimulus,a,b," + name + "\na,8,2,5\nb,3,7,2\n";
  CHECK_THAT(refusal(text), Contains("counts.csv:1: column '" + name + "' is no stimulus") &&
                                Contains("--responses '" + name + "'"));
  std::istringstream stream{text};
  CHECK(read_counts(read_csv(stream, "counts.csv"), "counts.csv", false, {name}).total() == 27);
}

TEST_CASE("names of a matrix that read alike are refused", "[analysis][confusion]") {
  CHECK_THAT(refusal("stimulus,a,b,A\na,8,2,5\nb,3,7,2\n"), Contains("'a' and 'A' read alike"));
  CHECK_THAT(refusal("stimulus,a,b,1,01\na,8,2,5,1\nb,3,7,2,1\n1,0,0,3,1\n"),
             Contains("'1' and '01' read alike"));
}

TEST_CASE("a row for each participant and stimulus is no matrix, and the refusal says what to do",
          "[analysis][confusion]") {
  CHECK_THAT(refusal("participant,stimulus,a,b\n1,a,3,1\n1,b,0,4\n2,a,4,0\n2,b,2,2\n"),
             Contains("has a row for each 'participant' and stimulus") && Contains("stack()"));
}

TEST_CASE("reports of an empty row or an unanswered block say so", "[analysis][report]") {
  ConfusionMatrix matrix{{{"a", "A & <b>", {}}, {"b", "B", {}}}, {{"a", "A", {}}, {"b", "B", {}}}};
  matrix.add("a", "a");
  const Summary summary = summarise(matrix, "one answer", "tell_apart");
  std::ostringstream html;
  write_html(html, summary);
  CHECK_THAT(html.str(), Contains("A &amp; &lt;b&gt;"));
  CHECK_THAT(html.str(), Contains("–"));
  CHECK_THAT(html.str(), !Contains(">nan"));
  CHECK_THAT(html.str(), !Contains("\"nan"));
  CHECK_THAT(html.str(), !Contains("http"));  // self-contained
  std::ostringstream json;
  write_json(json, summary);
  CHECK(nlohmann::json::parse(json.str())["schema_version"] == 1);
}

TEST_CASE("a summary counts by participant, block and task", "[analysis][summary]") {
  const Item a{"a", "A", {{"material", "wood"}}};
  const Item b{"b", "B", {{"material", "metal"}}};
  const StudyDesign design{
      "study",
      "",
      {{"tell",
        "tell_apart",
        "Which?",
        "confusion",
        {a, b},
        {a, b},
        {{"h", "better than chance", ""}},
        [](const analysis::Place& /*place*/, std::uint64_t draw) {
          return draw % 2 == 0 ? std::vector<int>{0, 1} : std::vector<int>{1, 0};
        },
        ""},
       {"pick", "pick_one", "Best?", "choices", {a, b}, {}, {{"h2", "a is best", "a"}}, {}, ""}}};
  std::vector<results::AnswerRow> answers;
  const auto add = [&](const char* who, const char* block, const char* stimulus,
                       const char* response) {
    results::AnswerRow row;
    row.participant_id = who;
    row.mode = results::Mode::simulated;
    row.block = block;
    row.stimulus = stimulus;
    row.response = response;
    row.number = row.stimulus == "b" ? 2 : 1;
    row.place_in_block = row.number - 1;
    if (!row.stimulus.empty()) {
      row.is_correct = row.stimulus == row.response;
    }
    answers.push_back(row);
  };
  add("P1", "tell", "a", "a");
  add("P1", "tell", "b", "a");
  add("P2", "tell", "a", "a");
  add("P1", "pick", "", "a");
  add("P2", "pick", "", "b");
  add("P2", "pick", "", "a");
  const Summary summary = summarise(design, answers, {{"P1", "pick", "a", 3, 4.5}});
  CHECK(summary.participants == 2);
  CHECK(summary.modes == std::set<std::string>{"simulated"});
  const auto& tell = static_cast<const IdentificationSummary&>(*summary.blocks.at(0));
  CHECK(is(tell.accuracy, 2, 3));
  CHECK(is(tell.participants.at(0).accuracy, 1, 2));
  CHECK(is(tell.participants.at(1).accuracy, 1, 1));
  REQUIRE(tell.hypotheses.size() == 1);
  CHECK(tell.hypotheses.at(0).chance == Approx(tell.matrix.chance()).epsilon(1e-9));
  CHECK(tell.as_json()["task"] == "tell_apart");
  const auto& pick = static_cast<const ChoiceSummary&>(*summary.blocks.at(1));
  CHECK(is(pick.alternatives.at(0).chosen, 1, 2));  // P2's first of two equals is b
  CHECK(pick.alternatives.at(0).visits == 3);
  CHECK(pick.has_repeated_choices);
  StudyDesign first = design;
  first.blocks.at(1).vote = Vote::first;
  add("P3", "pick", "", "a");
  add("P3", "pick", "", "b");
  add("P3", "pick", "", "b");
  const auto chosen_a = [&](const StudyDesign& declared) {
    const Summary voted = summarise(declared, answers, {});
    return static_cast<const ChoiceSummary&>(*voted.blocks.at(1)).alternatives.at(0).chosen;
  };
  CHECK(is(chosen_a(design), 1, 3));
  CHECK(is(chosen_a(first), 2, 3));
  CHECK(pick.as_json()["task"] == "pick_one");
  CHECK(pick.hypotheses.at(0).p.value() == Approx(0.75).epsilon(1e-9));
  std::ostringstream text;
  write_text(text, summary);
  CHECK_THAT(text.str(), Contains("SIMULATED"));
}
