#include "protocols/form.hpp"

#include <catch2/catch.hpp>
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
  REQUIRE(nasa_tlx().items.size() == 6);
  for (const FormItem& scale : nasa_tlx().items) {
    CHECK(scale.kind == ItemKind::scale);
    CHECK(scale.is_required);
  }
}
