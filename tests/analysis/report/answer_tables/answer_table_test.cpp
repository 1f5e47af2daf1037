#include "analysis/report/answer_tables/answer_table.hpp"

#include <cmath>
#include <sstream>

#include "analysis/report/summary.hpp"
#include "core/error.hpp"
#include "support/catch.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using namespace tapstudy::analysis;

namespace {
NamedCsv csv_of(const std::string& text, const std::string& file = "answers.csv") {
  std::istringstream stream{text};
  return {file, read_csv(stream, file)};
}
AnswerTable answers_in(const std::string& text, const AnswerReading& reading = {}) {
  return read_answers({csv_of(text)}, reading);
}
std::string refusal(const std::string& text, const AnswerReading& reading = {}) {
  try {
    answers_in(text, reading);
  } catch (const core::InvalidInput& error) {
    return error.what();
  }
  return "accepted";
}
// "P01 acrylic acrylic 1.250"
std::vector<std::string> lines_of(const AnswerTable& table) {
  std::vector<std::string> lines;
  for (const results::AnswerRow& answer : table.answers) {
    std::ostringstream line;
    line << answer.participant_id << ' ' << answer.stimulus << ' ' << answer.response << ' '
         << answer.response_time_s << ' ' << answer.number << ' ' << answer.repetition;
    lines.push_back(line.str());
  }
  return lines;
}
std::string data(const std::string& name) {
  return testing::contents(testing::source("tests/data/answers/" + name));
}
AnswerReading keys_of_plates() {
  AnswerReading reading;
  reading.responses = {{"1", "acrylic"}, {"2", "mdf, 9 mm"}};
  return reading;
}
const char* const plain =
    "participant,stimulus,response,response_time_s\nP01,acrylic,acrylic,1.25\n"
    "P01,acrylic,\"mdf, 9 mm\",0.5\nP01,\"mdf, 9 mm\",\"mdf, 9 mm\",2\n";
}  // namespace

TEST_CASE("PsychoPy's, jsPsych's and a plain table of the same answers read the same",
          "[analysis][answer_tables]") {
  AnswerReading psychopy = keys_of_plates();
  psychopy.columns.stimulus = "plate";
  psychopy.columns.response = "key_resp.keys";
  AnswerReading jspsych = keys_of_plates();
  jspsych.conditions = {{"task", "plate"}};
  const std::vector<std::string> expected = lines_of(answers_in(plain));
  CHECK(expected.size() == 3);
  CHECK(lines_of(answers_in(data("psychopy.csv"), psychopy)) == expected);
  CHECK(lines_of(answers_in(data("jspsych.csv"), jspsych)) == expected);
  std::istringstream json{data("jspsych.json")};
  REQUIRE(is_json_list(json.str()));
  CHECK(lines_of(read_answers({{"jspsych.json", read_json_rows(json, "jspsych.json")}}, jspsych)) ==
        expected);
}

TEST_CASE("JSON that is no list of trials is refused", "[analysis][answer_tables]") {
  for (const char* const text : {"[", "[]", "[1, 2]", "[{\"a\": 1}, 2]", "[{\"a\": 1}] x"}) {
    std::istringstream json{text};
    CHECK_THROWS_WITH(read_json_rows(json, "trials.json"), Contains("trials.json: not "));
  }
}

TEST_CASE("an error in a list of trials names the trial, for it has no lines",
          "[analysis][answer_tables]") {
  std::istringstream json{
      R"([{"stimulus": "a", "response": "a"}, {"stimulus": "", "response": "a"}])"};
  const std::vector<NamedCsv> tables{{"trials.json", read_json_rows(json, "trials.json")}};
  CHECK_THROWS_WITH(read_answers(tables, {}), Contains("trials.json, object 2: has an answer"));
}

TEST_CASE("rows without an answer are counted and left out", "[analysis][answer_tables]") {
  AnswerReading reading = keys_of_plates();
  reading.conditions = {{"task", "plate"}};
  const AnswerTable table = answers_in(data("jspsych.csv"), reading);
  CHECK(table.rows == 4);
  CHECK(table.unanswered == 1);
}

TEST_CASE("columns may be in any order, separated by semicolons, with a byte order mark",
          "[analysis][answer_tables]") {
  const AnswerTable table =
      answers_in("\xEF\xBB\xBFrt_ms;who;said;was\r\n1250;P01;a;a\r\n500;P02;a;b\r\n",
                 {{"was", "said", "who", "rt_ms"}});
  CHECK(lines_of(table) == std::vector<std::string>{"P01 a a 1.25 1 1", "P02 b a 0.5 1 1"});
  CHECK(table.are_participants_known);
}

TEST_CASE("each of several files without a participant's column is one participant's",
          "[analysis][answer_tables]") {
  const AnswerTable table = read_answers({csv_of("stimulus,response\na,a\n", "data/P07.csv"),
                                          csv_of("response,stimulus\na,b\n", "data/P08.csv")},
                                         {});
  CHECK(lines_of(table).front().starts_with("P07 a a"));
  CHECK(lines_of(table).back().starts_with("P08 b a"));
  CHECK(std::isnan(table.answers.front().response_time_s));
}

TEST_CASE("answers without participants make the matrix of their counts",
          "[analysis][answer_tables]") {
  const AnswerTable table = answers_in("stimulus,response\na,a\na,b\nb,b\nb,b\n");
  const Summary summary = summarise(table, "answers", "tell_apart");
  CHECK(summary.participants == 0);
  CHECK_THAT(methods(summary), Contains("participants are not known"));
}

TEST_CASE("answers of known participants are summarised over participants",
          "[analysis][answer_tables]") {
  std::string text = "participant,stimulus,response\n";
  for (const char* const person : {"P1", "P2", "P3"}) {
    for (int i = 0; i < 4; ++i) {
      text += std::string{person} + (i < 3 ? ",a,a\n" : ",b,a\n");
      text += std::string{person} + ",b,b\n";
    }
  }
  const Summary summary = summarise(answers_in(text), "answers", "tell_apart");
  CHECK(summary.participants == 3);
  const auto results = summary.blocks.front()->main_results();
  REQUIRE(results.size() == 1);
  CHECK(results.front().estimate == Approx(7.0 / 8.0).margin(0.001));
  CHECK(results.front().p.has_value());
}

TEST_CASE("a table of answers that cannot be read is refused at its line",
          "[analysis][answer_tables]") {
  CHECK_THAT(refusal("stimulus,response\na,a\nb,bb\n"),
             Contains("answers.csv:3: response 'bb' is not a stimulus"));
  CHECK(refusal("stimulus,response\na,a\nb,bb\n", {{}, {}, {{"bb", "bb"}}}) == "accepted");
  CHECK_THAT(refusal("stimulus,response\na,\n"), Contains("holds no answers"));
  CHECK_THAT(refusal("stimulus,response\na,a,a\n"), Contains("answers.csv:2: has 3 cells"));
  CHECK_THAT(refusal("stimulus,response,response\na,a,a\n"),
             Contains("2 columns 'response'") || Contains("could be meant"));
  CHECK_THAT(refusal("a,b\n1,2\n"), Contains("--stimulus-column"));
  CHECK_THAT(refusal("stimulus,response\na,a\n", {{"shown"}}), Contains("has no column 'shown'"));
  CHECK_THAT(refusal("stimulus,response,response_time_s\na,a,-1\n"),
             Contains("answers.csv:2: '-1'"));
  CHECK_THAT(refusal("stimulus,response,response_time_s\na,a,inf\n"), Contains("'inf'"));
  CHECK_THAT(refusal("stimulus,response\n,a\n"), Contains("no stimulus"));
  CHECK_THAT(refusal("stimulus,response\na,a\n", {{}, {{"task", "x"}}}), Contains("--where"));
  CHECK_THAT(refusal(data("psychopy.csv"), {{"plate"}}), Contains("could be meant"));
}

TEST_CASE("an answer that is right for no stimulus makes chance no smaller",
          "[analysis][answer_tables]") {
  AnswerReading reading;
  reading.responses = {{"unsure", "unsure"}};
  const AnswerTable table = answers_in("stimulus,response\na,a\nb,b\na,b\nb,unsure\n", reading);
  ConfusionMatrix matrix{table.stimuli, table.responses};
  CHECK(matrix.responses.size() == 3);
  CHECK(matrix.chance() == 0.5);
}

TEST_CASE("of an export of its own only answers that count are read, of one block",
          "[analysis][answer_tables]") {
  const std::string header =
      "participant_id,is_practice,is_catch,is_excluded,is_current,block,stimulus,response\n";
  const std::string rows =
      "P01,0,0,0,1,main,a,a\nP01,1,0,0,1,main,a,b\nP01,0,1,0,1,main,a,b\nP02,0,0,1,1,main,a,b\n"
      "P01,0,0,0,0,main,b,a\nP01,0,0,0,1,main,b,b\n";
  const AnswerTable table = answers_in(header + rows);
  CHECK(table.answers.size() == 2);
  CHECK(table.not_counted == 4);
  CHECK_THAT(refusal(header + rows + "P01,0,0,0,1,other,a,a\n"),
             Contains("answers.csv:8: is of block 'other'") && Contains("--where block=main"));
}

TEST_CASE("a missing stimulus is no class, and a column that may hold times is not guessed at",
          "[analysis][answer_tables]") {
  CHECK_THAT(refusal("stimulus,response\na,a\nNA,a\n"), Contains("answers.csv:3: has an answer"));
  CHECK(answers_in("stimulus,response,rt\na,a,500\nb,b,700\n").possible_time == "rt");
  CHECK(answers_in(plain).possible_time.empty());
}

TEST_CASE(
    "of real, pilot and simulated answers those of one kind are read, as a study's report does",
    "[analysis][answer_tables]") {
  const std::string header = "participant,mode,stimulus,response\n";
  const std::string simulated = "P03,simulated,a,b\n";
  const std::string pilots = "P02,pilot,b,b\n";
  const AnswerTable all = answers_in(header + pilots + "P01,real,a,a\n" + simulated);
  REQUIRE(all.answers.size() == 1);
  CHECK(all.answers.front().participant_id == "P01");
  CHECK(all.of_other_modes == 2);
  CHECK(all.modes.empty());
  CHECK(answers_in(header + simulated + pilots).modes == std::set<std::string>{"pilot"});
  CHECK(answers_in(header + simulated + "P04,simulated,b,b\n").modes ==
        std::set<std::string>{"simulated"});
}

TEST_CASE("participants whose names differ only in case or spaces are not two",
          "[analysis][answer_tables]") {
  const std::string header = "participant,stimulus,response\nP01,a,a\n";
  CHECK_THAT(refusal(header + "p01,b,b\n"), Contains("'P01' and 'p01' differ only in case"));
  CHECK_THAT(refusal(header + "\"P01 \",b,b\n"), Contains("differ only in case or spaces"));
}
