#include "analysis/report/answer_tables/answer_table.hpp"

#include <cmath>
#include <sstream>

#include "analysis/report/answer_tables/foreign_text.hpp"
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
  CHECK(table.unanswered == std::map<std::string, std::size_t>{{"null", 1}});
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
  const auto results = summary.blocks.front()->main_results;
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

TEST_CASE("a file of somebody who was not accepted is asked about, though all of it says so",
          "[analysis][answer_tables]") {
  const std::string text =
      "participant,stimulus,response,status\nP1,a,a,REJECTED\nP1,b,b,REJECTED\n";
  CHECK_THAT(refusal(text), Contains("column 'status' says 'REJECTED': 2 of 2 rows"));
}

TEST_CASE("the unit of times is the format's or stated, and is asked for otherwise",
          "[analysis][answer_tables]") {
  const auto table = [](const std::string& column) {
    return "participant,stimulus,response," + column + "\nP1,a,a,500\nP1,b,b,700\n";
  };
  const auto first_time = [&](const std::string& column, double unit_s) {
    AnswerReading reading;
    reading.columns.time = column;
    reading.columns.time_unit_s = unit_s;
    return answers_in(table(column), reading).answers.front().response_time_s;
  };
  CHECK_THROWS_WITH(first_time("Reaction Time", 0.0), Contains("--time-unit s or --time-unit ms"));
  CHECK(first_time("Reaction Time", 1e-3) == 0.5);
  CHECK(first_time("RT (ms)", 0.0) == 0.5);
  CHECK(first_time("RT [s]", 0.0) == 500.0);
  CHECK(first_time("rt_s", 0.0) == 500.0);
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

TEST_CASE("names that read alike are refused, or one by declaration", "[analysis][answer_tables]") {
  const auto [one, other] = GENERATE(table<std::string, std::string>(
      {{"Oak", "oak"},
       {"oak", "\"oak \""},
       {"oak wood", "oak\u00a0wood"},            // no-break space
       {"gr\u00f6\u00dfe", "gro\u0308\u00dfe"},  // composed, decomposed
       {"\u00c4ste", "\u00e4ste"},
       {"oak wood", "\"oak\nwood\""},
       {"o\u0430k", "oak"},  // of Cyrillic
       {"\u041c\u0421", "MC"},
       {"\u03bfak", "oak"},  // of Greek
       {"01", "1"}}));
  const std::string of_stimuli =
      "stimulus,response\n" + one + ",b\nb,b\n" + other + "," + one + "\n";
  const std::string of_people =
      "participant,stimulus,response\n" + one + ",a,a\n" + other + ",b,b\n";
  AnswerReading merging;
  merging.merges_alike = true;
  for (const std::string& text : {of_stimuli, of_people}) {
    CHECK_THAT(refusal(text), Contains("read alike") && Contains("--merge-alike"));
    CHECK(answers_in(text, merging).merged.size() == 1);
  }
  CHECK(answers_in(of_stimuli, merging).stimuli.size() == 2);
  CHECK(distinct(answers_in(of_people, merging).answers, &results::AnswerRow::participant_id) ==
        std::set<std::string>{one});
  CHECK(refusal("stimulus,response\n10,10\n1,1\n100,10\n") == "accepted");
}

TEST_CASE("a row of a table that was counted stands for as many answers as it says",
          "[analysis][answer_tables]") {
  const std::string column = GENERATE("n", "Freq", "count", "times");
  const std::string counted =
      "participant,stimulus,response," + column + "\nP1,a,a,3\nP1,a,b,1\nP2,b,b,2\nP2,a,b,0\n";
  AnswerReading reading;
  if (column == "times") {
    reading.columns.weight = column;  // no name that tells
  }
  const std::string one_a_row =
      "participant,stimulus,response\nP1,a,a\nP1,a,a\nP1,a,a\nP1,a,b\nP2,b,b\nP2,b,b\n";
  CHECK(lines_of(answers_in(counted, reading)) == lines_of(answers_in(one_a_row)));
  CHECK(answers_in(counted, reading).weight_column == column);
  reading.columns.weight = no_column;
  CHECK(answers_in(counted, reading).answers.size() == 4);
}

TEST_CASE("rows of all files say how often they count, or those of none, in whatever order",
          "[analysis][answer_tables]") {
  const NamedCsv counted = csv_of("participant,stimulus,response,n\nA,a,a,3\nA,b,b,2\n", "one.csv");
  const NamedCsv also = csv_of("participant,stimulus,response,n\nB,a,a,3\nB,b,a,2\n", "also.csv");
  const NamedCsv trials = csv_of("participant,stimulus,response\nB,a,a\nB,b,b\n", "other.csv");
  const NamedCsv asked =
      csv_of("participant,response,many,stimulus\nC,a,4,a\nC,b,2,b\n", "asked.csv");
  CHECK(read_answers({counted, also}, {}).answers.size() == 10);
  for (const auto& files : {std::vector{counted, trials}, std::vector{trials, counted}}) {
    CHECK_THROWS_WITH(read_answers(files, {}),
                      Contains("other.csv: has no column that says how many") &&
                          Contains("'n' of one.csv") && Contains("--weights none"));
  }
  for (const auto& files : {std::vector{asked, trials}, std::vector{trials, asked}}) {
    CHECK_THROWS_WITH(read_answers(files, {}), Contains("asked.csv:2: column 'many' may say"));
  }
  AnswerReading one_each;
  one_each.columns.weight = no_column;
  CHECK(read_answers({counted, trials}, one_each).answers.size() == 4);
}

TEST_CASE("where it is not clear whether rows are counts, it is asked, and shares are none",
          "[analysis][answer_tables]") {
  // the trials' own numbers; the same answer in two rows
  CHECK_THAT(refusal("stimulus,response,n\na,a,1\nb,b,2\na,b,3\n"), Contains("--weights none"));
  CHECK_THAT(refusal("stimulus,response,n\na,a,2\nb,b,2\na,a,3\n"), Contains("--weights n"));
  CHECK_THAT(refusal("stimulus,response,n\na,a,2\nb,b,0.5\n"),
             Contains("answers.csv:3: '0.5' in column 'n' is not a count"));
  CHECK_THAT(refusal("stimulus,response,percent\na,a,90\na,b,10\nb,b,100\n"),
             Contains("'percent' holds shares"));
  CHECK_THAT(refusal("stimulus,response,n\na,a,-1\n"), Contains("'-1'"));
  CHECK_THAT(refusal("stimulus,response,n\na,a,0\nb,b,0\n"), Contains("are 0"));
}

TEST_CASE("a file that calls other answers right than their names do is refused with both figures",
          "[analysis][answer_tables]") {
  const std::string text =
      "stimulus,response,correct\nleft,right,1\nright,left,1\nleft,right,1\nright,right,0\n";
  CHECK_THAT(refusal(text), Contains("answers.csv:2:") && Contains("75 % of 4") &&
                                Contains("by the names of stimuli and answers 25 %"));
  AnswerReading swapped;
  swapped.responses = {{"left", "right"}, {"right", "left"}};
  CHECK(refusal(text, swapped) == "accepted");
  AnswerReading not_looked_at;
  not_looked_at.columns.correct = no_column;
  CHECK(refusal(text, not_looked_at) == "accepted");
  // the right answer itself, or a share, is no such column
  CHECK(refusal("stimulus,response,correct\na,b,a\nb,b,b\n") == "accepted");
  const std::string psychopy =
      "plate,corrAns,key_resp.keys,key_resp.corr,participant,session,date,expName,psychopyVersion\n"
      "a,1,1,1,1,001,2026,taps,2023\nb,2,1,1,1,001,2026,taps,2023\n";
  AnswerReading keys;
  keys.columns.stimulus = "plate";
  keys.responses = {{"1", "a"}, {"2", "b"}};
  CHECK_THAT(refusal(psychopy, keys), Contains("100 % of 2") && Contains("50 %"));
}

TEST_CASE("several runs of one participant are named, and pooled only where that is said",
          "[analysis][answer_tables]") {
  const std::string header = "participant,stimulus,response\n";
  const std::string answers = "1,a,a\n1,b,b\n1,a,b\n1,b,a\n";
  const std::vector<NamedCsv> crashed_and_rerun{csv_of(header + answers, "crashed.csv"),
                                                csv_of(header + answers + "2,a,a\n", "rerun.csv")};
  CHECK_THROWS_WITH(read_answers(crashed_and_rerun, {}),
                    Contains("participant '1' took part 2 times: crashed.csv (4 answers); "
                             "rerun.csv (4 answers)") &&
                        Contains("--pool-runs"));
  AnswerReading pooling;
  pooling.pools_runs = true;
  const AnswerTable pooled = read_answers(crashed_and_rerun, pooling);
  CHECK(pooled.pooled == std::vector<std::string>{"1"});
  CHECK(pooled.answers.size() == 9);
  std::string two_days = "participant,stimulus,response,date\n";
  std::string each_at_its_time = two_days;
  for (int i = 0; i < 8; ++i) {
    two_days += "1,a,a," + std::string{i < 4 ? "Monday\n" : "Tuesday\n"};
    each_at_its_time += "1,a,a,12:0" + std::to_string(i) + "\n";
  }
  CHECK_THAT(refusal(two_days + "1,b,b,Tuesday\n"), Contains("date 'Monday' (4 answers)"));
  CHECK(refusal(each_at_its_time + "1,b,b,13:00\n") == "accepted");
}

TEST_CASE("what stands in the place of an answer is counted by its kind",
          "[analysis][answer_tables]") {
  const AnswerTable table = answers_in(
      "stimulus,response\na,a\nb,b\na,n/a\nb,NA\na,timeout\nb,undefined\na,None\nb,NA\na,\n");
  CHECK(table.answers.size() == 2);
  CHECK(table.unanswered ==
        std::map<std::string, std::size_t>{
            {"", 1}, {"n/a", 1}, {"NA", 2}, {"timeout", 1}, {"undefined", 1}, {"None", 1}});
  AnswerReading an_answer;
  an_answer.responses = {{"None", "None"}};
  CHECK(answers_in("stimulus,response\na,None\nb,b\na,a\n", an_answer).answers.size() == 3);
}

TEST_CASE("labels come in the order of their first appearance, or in the one that is said",
          "[analysis][answer_tables]") {
  const std::string text = "stimulus,response\n10,2\n2,2\n1,10\n";
  const auto names = [](const std::vector<Item>& items) {
    std::string all;
    for (const Item& item : items) {
      all += item.name + " ";
    }
    return all;
  };
  CHECK(names(answers_in(text).stimuli) == "10 2 1 ");
  AnswerReading ordered;
  ordered.order = {"1", "2", "10"};
  CHECK(names(answers_in(text, ordered).stimuli) == "1 2 10 ");
  CHECK(names(answers_in(text, ordered).responses) == "1 2 10 ");
  ordered.order = {"1", "2"};
  CHECK_THAT(refusal(text, ordered), Contains("--order: lacks '10'"));
  ordered.order = {"1", "2", "10", "3"};
  CHECK_THAT(refusal(text, ordered), Contains("--order: '3' is no stimulus"));
}

TEST_CASE("a decimal comma in quotes is one", "[analysis][answer_tables]") {
  CHECK(lines_of(answers_in("participant,stimulus,response,response_time_s\nP1,a,a,\"1,25\"\n"))
            .front() == "P1 a a 1.25 1 1");
}

TEST_CASE("the one answer of a survey is the answer, and each of several has a column",
          "[analysis][answer_tables]") {
  const auto read = [](const std::string& list, const AnswerReading& reading) {
    std::istringstream json{list};
    return read_answers({{"jspsych.json", read_json_rows(json, "jspsych.json")}}, reading);
  };
  const AnswerTable one = read(R"([{"stimulus": "a", "response": {"Q0": "a"}},
                                   {"stimulus": "b", "response": {"Q0": "a"}}])",
                               {});
  CHECK(one.answers[1].response == "a");
  CHECK(only_answer_in("['num_1']") == "num_1");  // as PsychoPy lists keys and what was clicked
  CHECK(only_answer_in("['a', 'b']") == "['a', 'b']");
  AnswerReading second;
  second.columns.response = "response.Q1";
  const AnswerTable several = read(
      R"([{"stimulus": "a", "response": {"Q0": "x", "Q1": "a"}},
          {"stimulus": "b", "response": {"Q0": "x", "Q1": "b"}}])",
      second);
  CHECK(several.answers[1].response == "b");
}

TEST_CASE("runs that stand one a line are read as such", "[analysis][answer_tables]") {
  const std::string run = R"([{"stimulus": "a", "response": "a", "subject": "S"},
                              {"stimulus": "b", "response": "b", "subject": "S"}])";
  std::string line = run;
  std::erase(line, '\n');
  std::string other = line;
  for (auto at = other.find("\"S\""); at != std::string::npos; at = other.find("\"S\"")) {
    other.replace(at, 3, "\"T\"");
  }
  const auto read = [](const std::string& lines) {
    std::istringstream json{lines};
    return read_answers({{"jatos.txt", read_json_rows(json, "jatos.txt")}}, {});
  };
  CHECK(read(line + "\n" + other + "\n").answers.size() == 4);
  CHECK_THROWS_WITH(
      read(line + "\n" + line + "\n"),
      Contains("participant 'S' took part 2 times") && Contains("run of the file '2'"));
}

TEST_CASE("rows below the header that say where questions come from are no answers",
          "[analysis][answer_tables]") {
  NamedCsv csv = csv_of(
      "participant,stimulus,response\nWho,Shown,Said\n"
      "\"{\"\"ImportId\"\":\"\"Q1\"\"}\",\"{\"\"ImportId\"\":\"\"Q2\"\"}\","
      "\"{\"\"ImportId\"\":\"\"Q3\"\"}\"\nP01,a,a\nP01,b,b\n");
  settle_header(csv.text, csv.file);
  CHECK(read_answers({csv}, {}).answers.size() == 2);
}

TEST_CASE("text in another encoding is read where it is said, and the error says so",
          "[analysis][answer_tables]") {
  const std::string cp1252 =
      "stimulus\nGr\xf6\xdf"
      "e\n";
  CHECK(utf8_of(cp1252, "windows-1252", "x.csv") == "stimulus\nGr\u00f6\u00dfe\n");
  CHECK_THROWS_WITH(utf8_of(cp1252, "", "x.csv"), Contains("x.csv: is not UTF-8") &&
                                                      Contains("--encoding") &&
                                                      Contains("windows-1252"));
  const std::string utf16{
      "\xff\xfe"
      "a\0\n\0",
      6};
  CHECK(utf8_of(utf16, "UTF-16", "x.csv") == "a\n");
  CHECK_THROWS_WITH(utf8_of(utf16, "", "x.csv"), Contains("probably UTF-16)"));
  CHECK_THROWS_WITH(utf8_of("a", "klingon", "x.csv"), Contains("'klingon' is not known"));
  CHECK_THROWS_WITH(utf8_of("\xff", "UTF-8", "x.csv"), Contains("is not text in UTF-8"));
  CHECK(utf8_of("sep=;\r\na;b\r\n", "", "x.csv") == "\r\na;b\r\n");
}

TEST_CASE("practice among the answers is asked about, in whatever column other programs note it",
          "[analysis][answer_tables]") {
  const auto [column, practice, test] = GENERATE(
      table<std::string, std::string, std::string>({{"phase", "practice", "test"},
                                                    {"block", "Training", "main"},
                                                    {"trial_part", "warm-up 1", ""},
                                                    {"is_practice", "true", "false"},
                                                    {"practice", "1", "0"},
                                                    {"Procedure[Trial]", "PracProc", "TrialProc"},
                                                    {"Status", "Survey Preview", "IP Address"},
                                                    {"status", "RETURNED", "APPROVED"},
                                                    {"Participant Status", "live", "complete"},
                                                    {"Finished", "False", "True"},
                                                    {"submitdate", "", "2024-05-01 10:00:00"},
                                                    {"practice_loop.thisN", "0", ""}}));
  CAPTURE(column);
  const auto row = [](const std::string& answer, const std::string& part) {
    return "P1,a," + answer + "," + part + "\nP1,b,b," + part + "\n";
  };
  const std::string text = "participant,stimulus,response," + column + "\n" + row("b", practice) +
                           row("a", test) + row("a", test);
  CHECK_THAT(refusal(text), Contains("answers.csv:2: column '" + column + "' says '" + practice +
                                     "': 2 of 6 rows are practice"));
  AnswerReading reading;
  reading.conditions = {{column, practice, true}};
  CHECK(answers_in(text, reading).answers.size() == 4);
  reading.conditions = {{column, practice}};  // nothing else is counted with it
  CHECK(answers_in(text, reading).answers.size() == 2);
  reading = {};
  reading.counts_practice = true;
  CHECK(answers_in(text, reading).answers.size() == 6);
}

TEST_CASE("a stimulus or a person may be called after practice", "[analysis][answer_tables]") {
  CHECK(answers_in("participant,stimulus,response\ntraining,practice,practice\nP2,b,b\n")
            .answers.size() == 2);
}

TEST_CASE("a counted table whose counts have an unusual name is asked about, none is passed over",
          "[analysis][answer_tables]") {
  const std::string name = GENERATE("0", "size", "n_trials", "Anzahl", "count_nonzero", "Freq.x",
                                    "H\u00e4ufigkeit", "Var1");
  const std::string text = "stimulus,response," + name + "\na,a,15\na,b,3\nb,a,1\nb,b,17\n";
  CHECK_THAT(refusal(text), Contains("answers.csv:2: column '" + name + "' may say how many") &&
                                Contains("--weights '" + name + "', or --weights none"));
  AnswerReading reading;
  reading.columns.weight = name;
  CHECK(answers_in(text, reading).answers.size() == 36);
  reading.columns.weight = no_column;
  CHECK(answers_in(text, reading).answers.size() == 4);
  CHECK_THAT(refusal("stimulus,response,\na,a,15\na,b,3\nb,b,18\n"),
             Contains("column 3, which has no name,"));
  // rows of a table that pandas numbered, trials, and ages of people are no counts
  CHECK(refusal(",stimulus,response,number\n0,a,a,3\n1,a,b,1\n2,b,b,2\n") == "accepted");
  CHECK(refusal("participant,age,stimulus,response\nA,31,a,a\nA,31,b,b\nB,25,a,a\n") == "accepted");
  CHECK(refusal("participant,shoes,stimulus,response\nA,41,a,a\nA,41,b,b\nB,39,a,a\n") ==
        "accepted");
  CHECK(refusal("stimulus,response,is_first,rt\na,a,1,700\na,b,1,650\nb,b,0,810\n") == "accepted");
}

TEST_CASE(
    "shares are told by what they add up to, and a sum by what it sums, unless they are counts",
    "[analysis][answer_tables]") {
  const auto table_of = [](const std::string& column, const std::vector<std::string>& cells) {
    std::string text = "stimulus,response," + column + "\n";
    const std::vector<std::string> kinds{"a,a,", "a,b,", "b,a,", "b,b,"};
    for (std::size_t i = 0; i < kinds.size(); ++i) {
      text += kinds[i] + cells[i] + "\n";
    }
    return text;
  };
  CHECK_THAT(refusal(table_of("said", {"0.85", "0.15", "0.1", "0.9"})),
             Contains("'said' holds shares") && Contains("--weights"));
  CHECK_THAT(refusal(table_of("said", {"85", "15", "10", "91"})), Contains("'said' holds shares"));
  CHECK_THAT(refusal(table_of("0", {"0.4", "0.1", "0.15", "0.35"})), Contains("'0' holds shares"));
  const std::string hundreds = table_of("n", {"85", "15", "10", "90"});
  CHECK_THAT(refusal(hundreds),
             Contains("column 'n' looks like shares") && Contains("--are-counts"));
  AnswerReading counts;
  counts.are_counts = true;
  CHECK(answers_in(hundreds, counts).answers.size() == 200);
  counts.are_counts = false;
  counts.columns.weight = "percent";
  CHECK_THAT(refusal(table_of("percent", {"7", "1", "2", "6"}), counts), Contains("--are-counts"));
  const std::string sums = table_of("n", {"5", "1", "2", "4"});
  const std::string of_answers = sums + "a,Sum,6\nb,Sum,6\n";
  CHECK_THAT(refusal(of_answers, {{}, {}, {{"Sum", "Sum"}}}),
             Contains("answers.csv:6: answer 'Sum' is the sum of the others"));
  CHECK_THAT(refusal(of_answers + "Sum,a,7\nSum,b,5\nSum,Sum,12\n"),
             Contains("stimulus 'Sum'") && Contains("--where 'COLUMN!=Sum'"));
  const std::string people =
      "participant,stimulus,response,n\nA,a,a,3\nA,b,b,2\nB,a,a,1\nAll,a,a,4\nAll,b,b,2\n";
  CHECK_THAT(refusal(people), Contains("answers.csv:5: participant 'All' is the sum"));
  counts = {};
  counts.are_counts = true;
  CHECK(answers_in(people, counts).answers.size() == 12);
}

TEST_CASE("a count may be written with a decimal point, but not with a point between thousands",
          "[analysis][answer_tables]") {
  CHECK(answers_in("stimulus,response,n\na,a,3.0\nb,b,2.00\n").answers.size() == 5);
  CHECK(answers_in("stimulus;response;n\na;a;3,0\nb;b;2\n").answers.size() == 5);
  for (const char* const cell : {"1.000", "2.5", "-3", "3.", "many", ""}) {
    CHECK_THAT(refusal(std::string{"stimulus,response,n\na,a,2\nb,b,"} + cell + "\n"),
               Contains("is not a count of answers"));
  }
}

TEST_CASE("whose answers these are is not passed over, and may be said not to be known",
          "[analysis][answer_tables]") {
  const std::string name = GENERATE("Participant.ID", "subject-code", "VP", "ResponseId");
  const std::string text = name + ",stimulus,response\n1,a,a\n2,b,b\n";
  CHECK_THAT(refusal(text), Contains("answers.csv:1: column '" + name + "' may say whose") &&
                                Contains("--participant-column none"));
  AnswerReading reading;
  reading.columns.participant = name;
  CHECK(answers_in(text, reading).are_participants_known);
  reading.columns.participant = no_column;
  CHECK_FALSE(answers_in(text, reading).are_participants_known);
  CHECK_FALSE(answers_in("participant,stimulus,response\nP1,a,a\nP2,b,b\n", reading)
                  .are_participants_known);
}

TEST_CASE("columns that are there twice are not passed over", "[analysis][answer_tables]") {
  const std::string rows = "\na,b,1,0\nb,b,1,1\n";
  CHECK_THAT(refusal("stimulus,response,correct,correct" + rows),
             Contains("2 columns 'correct'") && Contains("--correct-column none"));
  CHECK_THAT(refusal("stimulus,response,n,N" + rows),
             Contains("n, N could be meant") && Contains("--weights none"));
  CHECK_THAT(refusal("stimulus,response,response,x" + rows), Contains("2 columns 'response'"));
  CHECK_THAT(refusal("stimulus,response,part,part" + rows, {{}, {{"part", "1"}}}),
             Contains("several columns 'part', which --where names"));
}

TEST_CASE("right answers are compared in whatever words and beside whatever column they stand",
          "[analysis][answer_tables]") {
  const auto [column, right, wrong] = GENERATE(table<std::string, std::string, std::string>(
      {{"Plate.ACC", "1", "0"}, {"Plate_correct", "T", "F"}, {"correct", "hit", "miss"}}));
  const auto text = [&, &column = column](const std::string& one, const std::string& other) {
    return "stimulus,Plate.RESP," + column + "\na,a," + one + "\na,b," + other + "\nb,b," + one +
           "\n";
  };
  AnswerReading reading;
  reading.columns.response = "Plate.RESP";
  std::string agreeing = text(right, wrong);
  std::string contrary = text(wrong, right);
  if (column == "Plate_correct") {
    reading.columns.response = "Plate_RESP";
    agreeing.replace(agreeing.find("Plate."), 6, "Plate_");
    contrary.replace(contrary.find("Plate."), 6, "Plate_");
  }
  CHECK(refusal(agreeing, reading) == "accepted");
  CHECK(answers_in(agreeing, reading).not_compared.empty());
  CHECK_THAT(refusal(contrary, reading), Contains("33 % of 3") && Contains("67 %"));
  CHECK(answers_in("stimulus,response,correct\na,a,a\nb,a,b\n").not_compared ==
        std::set<std::string>{"correct"});
}

TEST_CASE(
    "an answer that is no stimulus is refused with all that may be meant, and a stimulus may "
    "be called None",
    "[analysis][answer_tables]") {
  CHECK_THAT(refusal("stimulus,response\na,a\nb,A\n"),
             Contains("reads like 'a': --merge-alike") && Contains("--responses"));
  CHECK_THAT(refusal("stimulus,response\na,a\nb,Time out\n"),
             Contains("if it is none, --where 'response!=Time out'"));
  CHECK_THAT(refusal("stimulus,response\nNone,None\na,a\nNone,a\n"),
             Contains("--responses 'None'"));
  AnswerReading named;
  named.responses = {{"None", "None"}};
  CHECK(answers_in("stimulus,response\nNone,None\na,a\nNone,a\n", named).stimuli.size() == 2);
}

TEST_CASE("more names that read alike: dashes, apostrophes, what takes no place, idle zeros",
          "[analysis][answer_tables]") {
  const auto [one, other] = GENERATE(table<std::string, std::string>({{"a-b", "a\u2013b"},
                                                                      {"o'k", "o\u2019k"},
                                                                      {"oak", "o\u200bak"},
                                                                      {"oak", "\u200foak"},
                                                                      {"oak", "oa\u2060k"},
                                                                      {"P01", "P1"},
                                                                      {"2", "2.0"}}));
  CHECK(as_read(one) == as_read(other));
  CHECK(as_read("1.05") != as_read("1.5"));
  CHECK(as_read("10") != as_read("1"));
  CHECK(as_read("P100") != as_read("P1"));
}

TEST_CASE("words of one alphabet that only look alike are told apart",
          "[analysis][answer_tables]") {
  const auto [one, other] = GENERATE(table<std::string, std::string>(
      {{"l1", "ll"},
       {"O", "0"},
       {"s\u0131k", "sik"},                                                      // Turkish
       {"\u0442\u043e\u043d", "\u0442\u043e\u043c"},                             // Russian
       {"\u03c4\u03cc\u03bd\u03bf\u03c2", "\u03c4\u03cc\u03bc\u03bf\u03c2"}}));  // Greek
  CHECK_FALSE(first_alike({one, other}));
}

TEST_CASE("what is proposed to leave practice out leaves it out, and nothing else",
          "[analysis][answer_tables]") {
  const std::string of_loops =
      "participant,stimulus,response,practice_trials.thisN,trials.thisN\n"
      "P1,a,a,0,\nP1,b,a,1,\nP1,b,b,2,\nP1,a,a,,0\nP1,b,b,,1\nP1,a,b,,2\n";
  CHECK_THAT(refusal(of_loops), Contains("Leave them out (--where 'practice_trials.thisN=')"));
  AnswerReading reading;
  reading.conditions = {{"practice_trials.thisN", ""}};
  CHECK(answers_in(of_loops, reading).answers.size() == 3);
  const std::string of_parts =
      "participant,stimulus,response,part\nP1,a,a,training\nP1,b,a,warm-up\nP1,b,b,one\n"
      "P1,a,a,two\n";
  CHECK_THAT(refusal(of_parts), Contains("(--where 'part!=training' --where 'part!=warm-up'), or"));
}

TEST_CASE("JSON that is no list is refused with the command that makes one of it",
          "[analysis][answer_tables]") {
  CHECK_THROWS_WITH(check_is_no_json_object("{\"a\": 1}\n{\"a\": 2}\n", "x.jsonl"),
                    Contains("`jq -s . 'x.jsonl' > list.json`"));
  CHECK_THROWS_WITH(check_is_no_json_object("{\"data\": [{\"a\": 1}]}", "x.json"),
                    Contains("`jq .KEY 'x.json' > list.json`"));
  CHECK_NOTHROW(check_is_no_json_object("{a},b\n1,2\n", "x.csv"));
  CHECK_NOTHROW(check_is_no_json_object("[{\"a\": 1}]", "x.json"));
}

TEST_CASE("R's names of rows have no header, and a title is none", "[analysis][answer_tables]") {
  const auto settled = [](const std::string& text) {
    NamedCsv csv = csv_of(text);
    settle_header(csv.text, csv.file);
    return read_answers({csv}, {});
  };
  const std::string rows = "\n\"1\" \"P 1\" \"a\" \"a\"\n\"2\" \"P 1\" \"b\" \"a\"\n";
  const AnswerTable table = settled("\"participant\" \"stimulus\" \"response\"" + rows);
  CHECK(lines_of(table).front().starts_with("P 1 a a"));
  CHECK(table.answers.size() == 2);
  CHECK_THROWS_WITH(settled("Experiment of today\nparticipant,stimulus,response\nP1,a,a\n"),
                    Contains("answers.csv:1: 'Experiment of today' is no header"));
  CHECK_THROWS_WITH(settled("C:\\Taps.edat3\nSubject\tstimulus\tresponse\nP1\ta\ta\n"),
                    Contains("answers.csv:1: 'C:\\Taps.edat3' is no header"));
  CHECK_THROWS_WITH(settled("*** Header Start ***\nSubject: 1\n*** Header End ***\n"),
                    Contains("is E-Prime's own log") && Contains("E-DataAid"));
}

TEST_CASE("between tabs a quote that does not begin a cell is a character",
          "[analysis][answer_tables]") {
  const std::string header = "who\tinfo\tstimulus\tresponse\n";
  const CsvText read = csv_of(header + "P1\t<?xml version=\"1.0\"?>\ta\ta\n" +
                              "P1\t5\" thick\ta\tb\n" + "P1\t\"a\t\"\"b\"\"\"\tb\tb\n")
                           .text;
  REQUIRE(read.rows.size() == 4);
  CHECK(read.rows[1].cells == std::vector<std::string>{"P1", "<?xml version=\"1.0\"?>", "a", "a"});
  CHECK(read.rows[2].cells[1] == "5\" thick");
  CHECK(read.rows[3].cells[1] == "a\t\"b\"");
  CHECK(csv_of("size (5\" plates)\tstimulus\n1\ta\n").text.rows[1].cells.size() == 2);
  for (const char* const row : {"P1\t\"a\"b\ta\ta\n", "P1\t\"a\ta\ta\n"}) {
    CHECK_THROWS_WITH(csv_of(header + row), Contains("answers.csv:2: a quote is out of place"));
  }
  CHECK_THROWS_WITH(csv_of("stimulus,response\na,5\" thick\n"), Contains("out of place"));
}

TEST_CASE("an answer in an option may have quotes, a semicolon or begin with a hash",
          "[analysis][answer_tables]") {
  using Cells = std::vector<std::string>;
  CHECK(cells_of_option("a=<img src=\"o.png\">,b; c,\"d, e\"", "--responses") ==
        Cells{"a=<img src=\"o.png\">", "b; c", "d, e"});
  CHECK(cells_of_option("#1=oak,#2=ash", "--responses") == Cells{"#1=oak", "#2=ash"});
  CHECK(cells_of_option("", "--responses").empty());
  CHECK_THROWS_WITH(cells_of_option("\"a,b", "--responses"), Contains("--responses:1: a quote"));
}

TEST_CASE("lines that E-Prime and Gorilla add are told and left out, and every row keeps its line",
          "[analysis][answer_tables]") {
  const std::string rows = "Subject\tstimulus\tresponse\n1\ta\ta\n";
  for (const char* const name : {"C:\\Data\\merge.emrg3", "\xEF\xBB\xBFtaps-1-1.edat2", "T.EMRG"}) {
    std::string text = std::string{name} + "\r\n" + rows;
    CHECK(without_lines_of_programs(text).size() == 1);
    const NamedCsv read = csv_of(text);
    CHECK(read.text.separator == '\t');
    REQUIRE(read.text.rows.size() == 2);
    CHECK(read.text.rows.front().line == 2);
  }
  for (const char* const end :
       {"END OF FILE", "END OF FILE\r\n", "END OF FILE,,\n\n", "\"END OF FILE\""}) {
    std::string text = std::string{"Subject,stimulus,response\n1,a,a\n"} + end;
    CHECK(without_lines_of_programs(text) ==
          std::vector<std::string>{"the last line, 'END OF FILE', which Gorilla adds,"});
    CHECK(text == "Subject,stimulus,response\n1,a,a\n");
  }
  for (const std::string& other :
       std::vector<std::string>{rows, "a.txt\n" + rows, rows + "1\ta\tEND OF FILE\n", "END OF FILE",
                                "END OF FILE\n" + rows, "Subject\tx.edat\n1\ta\n", ""}) {
    std::string text = other;
    CHECK(without_lines_of_programs(text).empty());
    CHECK(text == other);
  }
}

TEST_CASE("a file that is no text is told by its first bytes, with what makes a table of it",
          "[analysis][answer_tables]") {
  using namespace std::string_literals;
  struct File {
    std::string bytes;
    const char* told;
  };
  const auto [bytes, told] = GENERATE(values<File>(
      {{"PK\3\4\0\0xl/workbook.xml"s, "is an Excel workbook, not a table of text: save it as CSV"},
       {"PK\3\4\0\0mimetypeapplication/vnd.oasis.opendocument.spreadsheet"s, "of LibreOffice"},
       {"PK\3\4\0\0S01.csv"s, "is a zip archive, not a table of text: unpack it"},
       {"\x1f\x8b\x08\0"s, "gunzip"},
       {"$FL2@(#) SPSS DATA FILE\0"s, "of SPSS"},
       {"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"s, "an old Office program"},
       {"RDX3\nX\n\0\0"s, "a file that R saved"},
       {"X\n\0\0\0\3"s, "write.csv() in R"},
       {"PAR1\x15\4"s, "a Parquet file"},
       {"SQLite format 3\0"s, "by its directory"}}));
  std::istringstream text{bytes + std::string(200, 'x')};
  CHECK_THROWS_WITH(table_text(text, "x.bin"), Contains("x.bin: is ") && Contains(told));
  std::istringstream rows{"PAR1,stimulus,response\n1,a,a\n"};
  CHECK(table_text(rows, "x.csv").size() == 29);
}

TEST_CASE("conditions that no row meets are told, alone or together", "[analysis][answer_tables]") {
  const std::string text = "who,stimulus,response\n1,a,a\n2,b,b\n";
  AnswerReading reading;
  reading.conditions = {{"who", "1"}, {"who", "2"}};
  CHECK_THAT(refusal(text, reading),
             Contains("answers.csv: holds no answers: each condition is met by some rows, and "
                      "--where 'who=1' and --where 'who=2' by none"));
  reading.conditions = {{"who", "1"}, {"stimulus", "c"}, {"who", "2", true}};
  CHECK_THAT(refusal(text, reading),
             Contains("holds no answers: no row meets --where 'stimulus=c'") && !Contains("who"));
  reading.conditions = {{"who", "1", true}, {"who", "2", true}};
  CHECK_THAT(refusal(text, reading), Contains("--where 'who!=1' and --where 'who!=2' by none"));
}
