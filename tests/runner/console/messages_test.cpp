// The catalogue of what the pages say.
#include <nlohmann/json.hpp>
#include <set>

#include "support/catch.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using Json = nlohmann::json;

TEST_CASE("every language of the pages has the same messages, each once", "[runner][console]") {
  std::vector<std::set<std::string>> open_maps;
  const auto note = [&](int /*depth*/, Json::parse_event_t event, Json& parsed) {
    if (event == Json::parse_event_t::object_start) {
      open_maps.emplace_back();
    } else if (event == Json::parse_event_t::object_end) {
      open_maps.pop_back();
    } else if (event == Json::parse_event_t::key) {
      CAPTURE(parsed.dump());
      CHECK(open_maps.back().insert(parsed.get<std::string>()).second);
    }
    return true;
  };
  const Json catalogue =
      Json::parse(testing::contents(testing::source("runner/console/pages/messages.json")), note);
  REQUIRE(catalogue.size() == 3);
  for (const Json& language : catalogue) {
    REQUIRE(language.size() == catalogue.front().size());
    for (const auto& [key, text] : language.items()) {
      CAPTURE(key);
      CHECK(catalogue.front().contains(key));
    }
  }
}
