#include "protocols/form.hpp"

#include "protocols/nasa_tlx.hpp"
#include "protocols/read_protocol.hpp"
#include "support/catch.hpp"
#include "support/texts.hpp"
using namespace tapstudy::protocols;

namespace {
FormItem item(ItemKind kind) {
  FormItem one;
  one.kind = kind;
  one.steps = 5;
  one.min = 18;
  one.max = 99;
  one.options = {{"left", "links"}, {"right", "rechts"}};
  return one;
}
bool takes(const FormItem& one, const std::string& answer) {
  return wrong_with(one, answer).empty();
}
}  // namespace

TEST_CASE("an item of a form takes what its kind allows and nothing else", "[protocols][forms]") {
  const FormItem likert = item(ItemKind::likert);
  CHECK((takes(likert, "1") && takes(likert, "5")));
  CHECK_FALSE((takes(likert, "0") || takes(likert, "6") || takes(likert, "2.5") ||
               takes(likert, "nan") || takes(likert, "1 ") || takes(likert, "x")));
  const FormItem scale = item(ItemKind::scale);
  CHECK((takes(scale, "0") && takes(scale, "0.37") && takes(scale, "1")));
  CHECK_FALSE((takes(scale, "-0.01") || takes(scale, "1.01") || takes(scale, "inf")));
  const FormItem number = item(ItemKind::number);
  CHECK((takes(number, "18") && takes(number, "33.5")));
  CHECK_FALSE((takes(number, "17") || takes(number, "1e9") || takes(number, "0x20")));
  const FormItem choice = item(ItemKind::single_choice);
  CHECK(takes(choice, "left"));
  CHECK_FALSE((takes(choice, "Left") || takes(choice, "1")));
  const FormItem text = item(ItemKind::text);
  CHECK(takes(text, "anything, \"quoted\""));
  CHECK_FALSE(takes(text, std::string(6000, 'x')));
}

TEST_CASE("only what is not required may be left out", "[protocols][forms]") {
  for (const ItemKind kind : {ItemKind::likert, ItemKind::scale, ItemKind::number,
                              ItemKind::single_choice, ItemKind::text}) {
    FormItem one = item(kind);
    CHECK_FALSE(takes(one, ""));
    one.is_required = false;
    CHECK(takes(one, ""));
  }
}

TEST_CASE("NASA's task load index has its six scales", "[protocols][forms]") {
  for (const std::string& language : nasa_tlx_languages()) {
    const Form form = nasa_tlx(language);
    REQUIRE(form.items.size() == 6);
    for (std::size_t i = 0; i < 6; ++i) {
      CHECK(form.items[i].name == nasa_tlx("en").items[i].name);
      CHECK(form.items[i].kind == ItemKind::scale);
      CHECK(form.items[i].is_required);
      CHECK_FALSE(form.items[i].question.empty());
    }
  }
}

TEST_CASE("NASA's task load index is asked in the language of the session, else in English",
          "[protocols][forms]") {
  CHECK(nasa_tlx("de").title != nasa_tlx("en").title);
  CHECK(nasa_tlx("fr").title == nasa_tlx("en").title);
  const auto study = tapstudy::testing::shipped("recommended/discrimination.yaml").string();
  CHECK(read_protocol(study, "ja").forms.at("load").title == nasa_tlx("ja").title);
  CHECK(read_protocol(study).forms.at("load").title == nasa_tlx("en").title);
}

TEST_CASE("the ends of a confidence scale without words of its own are in the session's language",
          "[protocols]") {
  const tapstudy::testing::TempDirectory directory;
  const std::string study = directory / "study.yaml";
  tapstudy::testing::write(
      study,
      tapstudy::testing::replaced(
          tapstudy::testing::contents(tapstudy::testing::shipped("paper/discrimination.yaml")),
          "    task: identification", "    task: identification\n    confidence: {steps: 5}"));
  CHECK(read_protocol(study).blocks.front().confidence->low == "guessed");
  CHECK(read_protocol(study, "de").blocks.front().confidence->high == "sicher");
  CHECK(read_protocol(study, "fr").blocks.front().confidence->high == "certain");
}
