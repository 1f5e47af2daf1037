// What answers are read from, at the terminal and from pages alike.
#include "protocols/tasks/answers.hpp"

#include <map>
#include <string>

#include "support/catch.hpp"
using namespace tapstudy;
using protocols::answer_in;
using protocols::AnswerKind;
using protocols::Answers;

TEST_CASE("a magnitude is a number above 0 in decimal notation, and nothing else is",
          "[protocols][tasks]") {
  const Answers numbers{AnswerKind::number};
  const std::map<std::string, double> read{{"12", 12.0},  {" 0.5 ", 0.5}, {"007", 7.0},
                                           {".25", 0.25}, {"3.", 3.0},    {"1000000", 1e6},
                                           {"2.50", 2.5}};
  for (const auto& [text, number] : read) {
    CAPTURE(text);
    REQUIRE(answer_in(text, numbers));
    CHECK(std::stod(*answer_in(text, numbers)) == number);
  }
  for (const char* const text : {"",
                                 " ",
                                 "0",
                                 "0.0",
                                 "-3",
                                 "+3",
                                 "nan",
                                 "NaN",
                                 "inf",
                                 "infinity",
                                 "1e3",
                                 "0x10",
                                 "twelve",
                                 "1,500",
                                 "1 2",
                                 "1/2",
                                 "1.2.3",
                                 ".",
                                 "12 cm",
                                 "\u0661",
                                 "100000000000000000000",
                                 "0.0000000000000000001"}) {
    CAPTURE(text);
    CHECK_FALSE(answer_in(text, numbers));
  }
  CHECK_FALSE(answer_in(std::string(100'000, '9'), numbers));
}

TEST_CASE("the same magnitude is stored as the same text, however it was written",
          "[protocols][tasks]") {
  const Answers numbers{AnswerKind::number};
  CHECK(answer_in("2.50", numbers) == answer_in(" 02.5", numbers));
}

TEST_CASE("an option is read from its place and told by its label", "[protocols][tasks]") {
  const Answers answers{AnswerKind::option, {{"mdf", "wood fibre"}, {"acrylic", "acrylic"}}};
  CHECK(answer_in("1", answers) == "mdf");
  CHECK(answer_in(" 2 ", answers) == "acrylic");
  CHECK(label_of_answer("mdf", answers) == "wood fibre");
  for (const char* const text : {"", "0", "3", "-1", "1.0", "mdf", "18446744073709551617"}) {
    CAPTURE(text);
    CHECK_FALSE(answer_in(text, answers));
  }
}

TEST_CASE("an order names every option once, by its place", "[protocols][tasks]") {
  const Answers answers{AnswerKind::order, {{"A", "A"}, {"B", "B"}, {"C", "sea"}}};
  CHECK(answer_in("3 1 2", answers) == "C A B");
  CHECK(answer_in(" 3,1, 2 ", answers) == "C A B");
  CHECK(label_of_answer("C A B", answers) == "sea A B");
  for (const char* const text : {"", "1", "1 2", "1 2 2", "1 2 4", "1 2 3 1", "123", "A B C"}) {
    CAPTURE(text);
    CHECK_FALSE(answer_in(text, answers));
  }
}

TEST_CASE("a setting is answered by its place, and nothing else is one", "[protocols][tasks]") {
  Answers answers{AnswerKind::setting};
  answers.settings = 12;
  CHECK(answer_in("1", answers) == "1");
  CHECK(answer_in(" 012 ", answers) == "12");
  for (const char* const text : {"", "0", "13", "-1", "+1", "1.5", "=", "A"}) {
    CAPTURE(text);
    CHECK_FALSE(answer_in(text, answers));
  }
  CHECK(protocols::expected_answer(answers) == "a number from 1 to 12");
}

TEST_CASE("a mark on a line is a number from 0 to 1, and nothing else is one",
          "[protocols][tasks]") {
  Answers answers{AnswerKind::line};
  answers.ends = {"soft", "hard"};
  CHECK(answer_in("0", answers) == "0");
  CHECK(answer_in(" .370 ", answers) == "0.37");
  CHECK(answer_in("1.0", answers) == "1");
  for (const char* const text : {"", "1.01", "-0.1", "+0.1", "1e-1", "nan", "0.5 0.6", "soft"}) {
    CAPTURE(text);
    CHECK_FALSE(answer_in(text, answers));
  }
  CHECK(protocols::expected_answer(answers) == "a number from 0 (soft) to 1 (hard)");
}
