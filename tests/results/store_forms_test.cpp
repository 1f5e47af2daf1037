#include <filesystem>

#include "results/store.hpp"
#include "support/catch.hpp"
#include "support/small_study.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using namespace tapstudy::results;

TEST_CASE("a form is stored whole, once, and again in the journal", "[results][store][forms]") {
  const testing::TempDirectory directory;
  {
    auto [store, row] = testing::small_study::begun_study(directory.path());
    const std::vector<FormAnswerRow> answers{
        {row.id, 1.0, "about", "session begin", "hand", "left"},
        {row.id, 1.0, "about", "session begin", "age", std::nullopt}};
    store.add_form(answers);
    CHECK_THROWS(store.add_form(answers));
    CHECK_THROWS(store.add_form({{row.id, 2.0, "load", "main", "effort", "0.5"}, answers.front()}));
    store.add_trial(testing::small_study::trial(row.id, 1, "a"));
    CHECK(store.filled_forms("P01") ==
          std::set<std::pair<std::string, std::string>>{{"about", "session begin"}});
    CHECK(store.filled_forms("P02").empty());
  }
  std::filesystem::remove(directory / "study.db");
  Store store = Store::from_journal(directory.path());
  const std::vector<FormAnswerRow> kept = store.entries_for_journal().form_answers;
  REQUIRE(kept.size() == 2);
  CHECK(kept[0].answer == "left");
  CHECK(kept[1].answer == std::nullopt);
}
