#include "runner/studies/protocol_tables.hpp"

#include <algorithm>

#include "protocols/reader/read_protocol.hpp"
#include "support/catch.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using Meanings = std::vector<std::pair<std::string, std::string>>;

TEST_CASE("an export says what each stored answer meant to those who gave it", "[runner][export]") {
  const protocols::Protocol protocol =
      protocols::read_protocol(testing::source("tests/data/every_task.yaml"));
  const auto meanings_of = [&](const std::string& block) {
    return runner::response_meanings(
        *std::ranges::find(protocol.blocks, block, &protocols::Block::name), protocol);
  };
  const auto label_of = [&](const std::string& stimulus) {
    return std::pair{stimulus, protocol.stimulus(stimulus).label};
  };
  CHECK(meanings_of("paired_or_tied") ==
        Meanings{{"tie", "no difference"}, label_of("one"), label_of("other")});
  CHECK(meanings_of("line") == Meanings{{"0", "not at all"}, {"1", "fully"}});
  CHECK(meanings_of("rating").front() == std::pair<std::string, std::string>{"1", "1 not at all"});
  CHECK(meanings_of("ranking").size() == 3);
  CHECK(meanings_of("magnitude").empty());
  CHECK(meanings_of("adjustment").empty());
}
