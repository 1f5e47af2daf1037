#include "protocols/schedule/schedule.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "core/error.hpp"
#include "protocols/reader/read_protocol.hpp"
#include "protocols/schedule/ordering.hpp"
#include "support/blocks.hpp"
#include "support/catch.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using protocols::make_schedule;

namespace {
protocols::Protocol paper(const char* name) {
  return protocols::read_protocol(testing::shipped(std::string{"paper/"} + name).string());
}
}  // namespace

TEST_CASE("every plate is presented as often as the protocol says", "[protocols][schedule]") {
  protocols::Protocol protocol = paper("discrimination.yaml");
  protocol.blocks[0].order =
      GENERATE(protocols::Order::listed, protocols::Order::shuffle,
               protocols::Order::shuffle_within_repetition, protocols::Order::williams);
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    std::map<std::string, int> count;
    std::set<std::pair<std::string, int>> repetitions;
    for (const protocols::PlannedTrial& trial : make_schedule(protocol, seed, 3)) {
      ++count[trial.alternatives.front().stimulus];
      repetitions.insert({trial.alternatives.front().stimulus, trial.repetition});
    }
    CHECK(count == std::map<std::string, int>{
                       {"acrylic_two", 2}, {"mdf_two", 2}, {"acrylic_three", 2}, {"mdf_three", 2}});
    CHECK(repetitions.size() == 8);
  }
}

TEST_CASE("catch trials lie anywhere but first, and stay there in every other draw of the order",
          "[protocols][schedule]") {
  protocols::Protocol protocol = paper("discrimination.yaml");
  protocol.blocks[0].catch_trials = protocols::CatchTrials{2, {{"mdf_two", "mdf_two"}}};
  CHECK(planned_trials(protocol.blocks[0]) == 10);
  const auto places = [&](std::uint64_t seed, int order_index) {
    const auto schedule = make_schedule(protocol, seed, order_index);
    std::pair<int, int> found{-1, -1};
    for (std::size_t i = 0; i < schedule.size(); ++i) {
      if (schedule[i].is_catch) {
        (found.first < 0 ? found.first : found.second) = static_cast<int>(i);
      }
    }
    return found;
  };
  std::map<std::pair<int, int>, int> seen;
  constexpr int participants = 7200;
  for (int i = 0; i < participants; ++i) {
    ++seen[places(1, i)];
  }
  CHECK(places(1, 3) == places(2, 3));
  CHECK(seen.size() == 36);  // pairs of nine places
  for (const auto& [pair, count] : seen) {
    CHECK(pair.first > 0);
    CHECK(count == Approx(participants / 36.0).margin(4.5 * std::sqrt(participants / 36.0)));
  }
}

TEST_CASE("the same seed gives the same order, another seed another", "[protocols][schedule]") {
  const protocols::Protocol protocol = paper("discrimination.yaml");
  const auto order = [&](std::uint64_t seed) {
    return protocols::described(make_schedule(protocol, seed, 0));
  };
  CHECK(order(1) == order(1));
  CHECK(order(1) != order(2));
}

TEST_CASE("every place is equally likely for every plate", "[protocols][schedule]") {
  const protocols::Protocol protocol = paper("discrimination.yaml");
  std::map<std::pair<std::size_t, std::string>, int> seen;
  constexpr int schedules = 8000;
  for (std::uint64_t seed = 0; seed < schedules; ++seed) {
    const auto schedule = make_schedule(protocol, seed, 0);
    for (std::size_t place = 0; place < schedule.size(); ++place) {
      ++seen[{place, schedule[place].alternatives.front().stimulus}];
    }
  }
  for (const auto& [place, count] : seen) {
    CHECK(count == Approx(schedules / 4).margin(4.5 * std::sqrt(schedules * 0.25 * 0.75)));
  }
}

TEST_CASE("within a repetition every plate comes once", "[protocols][schedule]") {
  protocols::Protocol protocol = paper("discrimination.yaml");
  protocol.blocks[0].order = protocols::Order::shuffle_within_repetition;
  const auto schedule = make_schedule(protocol, 9, 0);
  std::set<std::string> first_half;
  for (std::size_t i = 0; i < 4; ++i) {
    first_half.insert(schedule[i].alternatives.front().stimulus);
    CHECK(schedule[i].repetition == 1);
  }
  CHECK(first_half.size() == 4);
}

TEST_CASE("in a Williams square everything follows everything else equally often",
          "[protocols][schedule]") {
  const int n = GENERATE(2, 3, 4, 5, 6, 7);
  std::map<std::pair<int, int>, int> successions;
  std::map<std::pair<int, int>, int> places;
  for (int row = 0; row < protocols::williams_rows(n); ++row) {
    const auto conditions = protocols::williams_row(n, row);
    CHECK(std::set<int>(conditions.begin(), conditions.end()).size() == conditions.size());
    for (int place = 0; place < n; ++place) {
      ++places[{place, conditions[static_cast<std::size_t>(place)]}];
      if (place > 0) {
        ++successions[{conditions[static_cast<std::size_t>(place - 1)],
                       conditions[static_cast<std::size_t>(place)]}];
      }
    }
  }
  const int each = protocols::williams_rows(n) / n;
  CHECK(successions.size() == static_cast<std::size_t>(n * (n - 1)));
  for (const auto& [pair, count] : successions) {
    CHECK(count == each);
  }
  for (const auto& [pair, count] : places) {
    CHECK(count == each);
  }
}

TEST_CASE(
    "over its participants a Williams order is balanced across repetitions, whatever the seed",
    "[protocols][schedule]") {
  const int n = GENERATE(2, 3, 4, 5, 6);
  const int repetitions = GENERATE(1, 2, 3, 4);
  const std::uint64_t seed = GENERATE(1U, 2U);
  CAPTURE(n, repetitions, seed);
  protocols::Block block;
  block.order = protocols::Order::williams;
  block.repetitions = repetitions;
  for (int i = 0; i < n; ++i) {
    block.stimuli.push_back(std::string(1, static_cast<char>('a' + i)));
  }
  std::map<std::pair<std::size_t, std::size_t>, int> successions;
  std::map<std::pair<std::size_t, std::size_t>, int> places;
  const int participants = protocols::williams_sequences(n, repetitions);
  for (int participant = 0; participant < participants; ++participant) {
    core::Rng rng{1};
    const auto order = protocols::ordered_conditions(block, rng, {participant, seed});
    REQUIRE(order.size() == static_cast<std::size_t>(n * repetitions));
    for (std::size_t place = 0; place < order.size(); ++place) {
      ++places[{order[place].condition, place}];
      if (place > 0) {
        ++successions[{order[place - 1].condition, order[place].condition}];
      }
    }
  }
  CHECK(successions.size() == static_cast<std::size_t>(n * (n - 1)));  // none follows itself
  for (const auto& [pair, count] : successions) {
    CHECK(count == successions.begin()->second);
  }
  for (const auto& [place, count] : places) {
    CHECK(count == participants / n);
  }
}

TEST_CASE("each run of participants that fills a Williams square is balanced in every repetition",
          "[protocols][schedule]") {
  const int n = GENERATE(3, 4, 5, 12);
  const std::uint64_t seed = GENERATE(1U, 2U);
  protocols::Block block;
  block.order = protocols::Order::williams;
  block.repetitions = 3;
  for (int i = 0; i < n; ++i) {
    block.stimuli.push_back(std::string(1, static_cast<char>('a' + i)));
  }
  const int rows = protocols::williams_rows(n);
  for (int first = 0; first < 3 * rows; first += rows) {
    std::map<std::pair<std::size_t, std::size_t>, int> places;
    for (int participant = first; participant < first + rows; ++participant) {
      core::Rng rng{1};
      const auto order = protocols::ordered_conditions(block, rng, {participant, seed});
      for (std::size_t place = 0; place < order.size(); ++place) {
        ++places[{order[place].condition, place}];
      }
    }
    CAPTURE(n, seed, first);
    CHECK(places.size() == static_cast<std::size_t>(n * n * block.repetitions));
    CHECK(std::ranges::all_of(places, [&](const auto& one) { return one.second == rows / n; }));
  }
}

TEST_CASE("the seed of the study assigns the balanced orders to participants",
          "[protocols][schedule]") {
  protocols::Protocol protocol = paper("discrimination.yaml");
  protocol.blocks[0].order = protocols::Order::williams;
  const auto order = [&](std::uint64_t seed, int index) {
    protocol.counterbalancing_seed = seed;
    return protocols::described(make_schedule(protocol, 1, index));
  };
  std::set<std::string> first;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    first.insert(order(seed, 0));
  }
  CHECK(first.size() > 5);
  CHECK(order(3, 0) == order(3, 0));
}

TEST_CASE("blind labels are drawn anew for each trial: none has a history",
          "[protocols][schedule]") {
  protocols::Protocol protocol = paper("reality_finger.yaml");
  protocol.blocks[0].repetitions = 4;
  std::set<std::vector<std::string>> mappings;
  int same_as_before = 0;
  constexpr int participants = 400;
  for (std::uint64_t seed = 0; seed < participants; ++seed) {
    const auto schedule = make_schedule(protocol, seed, 0);
    REQUIRE(schedule.size() == 4);
    std::vector<std::string> mapping;
    for (const protocols::Alternative& alternative : schedule[0].alternatives) {
      mapping.push_back(alternative.stimulus);
    }
    mappings.insert(mapping);
    for (std::size_t i = 1; i < 4; ++i) {
      same_as_before +=
          schedule[i].alternatives[0].stimulus == schedule[i - 1].alternatives[0].stimulus ? 1 : 0;
    }
  }
  // one time in three, within four standard deviations
  CHECK(same_as_before == Approx(participants).margin(4.0 * std::sqrt(participants * 2.0 / 3.0)));
  CHECK(mappings.size() == 6);  // all orders of three
}

TEST_CASE("a constrained order is any of those that satisfy it, equally often",
          "[protocols][schedule]") {
  protocols::Block block;
  block.name = "b";
  block.stimuli = {"a", "b", "c"};
  block.repetitions = 2;
  block.constraints = {1, 1};
  // of the 90 orders of aabbcc, 30 have no immediate repetition (inclusion and exclusion)
  std::map<std::string, int> counts;
  core::Rng rng{11};
  constexpr int draws = 9000;
  for (int i = 0; i < draws; ++i) {
    std::string order;
    for (const auto& next : protocols::ordered_conditions(block, rng, {})) {
      order += block.stimuli[next.condition];
    }
    ++counts[order];
  }
  REQUIRE(counts.size() == 30);
  double chi_square = 0.0;
  for (const auto& [order, count] : counts) {
    chi_square += std::pow(count - draws / 30.0, 2) / (draws / 30.0);
    CHECK(std::adjacent_find(order.begin(), order.end()) == order.end());
  }
  CHECK(chi_square < 58.3);  // 29 degrees of freedom, p = .001
}

TEST_CASE("within repetitions too a constrained order is any that satisfies it, equally often",
          "[protocols][schedule]") {
  protocols::Block block;
  block.name = "b";
  block.stimuli = {"a", "b", "c"};
  block.repetitions = 2;
  block.order = protocols::Order::shuffle_within_repetition;
  block.constraints = {1, 1};
  // of the 36 pairs of orders of abc, the second begins in 24 with another than the first ended
  // with
  std::map<std::string, int> counts;
  core::Rng rng{12};
  constexpr int draws = 7200;
  for (int i = 0; i < draws; ++i) {
    std::string order;
    for (const auto& next : protocols::ordered_conditions(block, rng, {})) {
      order += block.stimuli[next.condition];
    }
    ++counts[order];
  }
  REQUIRE(counts.size() == 24);
  double chi_square = 0.0;
  for (const auto& [order, count] : counts) {
    chi_square += std::pow(count - draws / 24.0, 2) / (draws / 24.0);
    CHECK(std::set<char>(order.begin(), order.begin() + 3).size() == 3);
    CHECK(std::adjacent_find(order.begin(), order.end()) == order.end());
  }
  CHECK(chi_square < 49.7);  // 23 degrees of freedom, p = .001
}

TEST_CASE("two presentations of a stimulus are as far apart as is asked, and no run is longer",
          "[protocols][schedule]") {
  protocols::Block block;
  block.name = "b";
  block.stimuli = {"a", "b", "c", "d"};
  block.repetitions = 2;
  core::Rng rng{3};
  block.constraints = {0, 3};
  for (int i = 0; i < 50; ++i) {
    const auto order = protocols::ordered_conditions(block, rng, {});
    for (std::size_t k = 0; k + 2 < order.size(); ++k) {
      CHECK(order[k].condition != order[k + 1].condition);
      CHECK(order[k].condition != order[k + 2].condition);
    }
  }
  block.constraints = {0, 5};  // four stimuli cannot
  CHECK_THROWS_AS(protocols::ordered_conditions(block, rng, {}), core::InvalidInput);
  block.repetitions = 10;
  block.constraints = {1, 1};  // met by one random order in fourteen thousand
  const auto rare = protocols::ordered_conditions(block, rng, {});
  CHECK(rare.size() == 40);
  CHECK(std::ranges::adjacent_find(rare, {}, &protocols::OrderedCondition::condition) ==
        rare.end());
}

namespace {
using Names = std::vector<std::string>;

// Blocks whose names begin with "practice" are practice, those that begin with "fixed" fixed.
protocols::Protocol study(const Names& blocks, const std::string& order) {
  const std::string whole = testing::contents(testing::shipped("paper/discrimination.yaml"));
  std::string text = whole.substr(0, whole.find("\nblocks:")) + "\nblocks:\n";
  for (const std::string& name : blocks) {
    text += "  - {name: " + name + ", task: identification, question: \"Which?\", " +
            "stimuli: [mdf_two, mdf_three], repetitions: 2" +
            (name.starts_with("practice") ? ", practice: true" : "") +
            (name.find("fixed") != std::string::npos ? ", fixed: true}\n" : "}\n");
  }
  text += order.empty() ? "" : "block_order: " + order + "\n";
  return protocols::parse_protocol(text, "study.yaml");
}

Names names_of(const protocols::Protocol& protocol, std::uint64_t seed, int order_index) {
  Names names;
  for (const std::size_t i : protocols::block_sequence(protocol, seed, order_index)) {
    names.push_back(protocol.blocks[i].name);
  }
  return names;
}
}  // namespace

TEST_CASE(
    "over as many participants as there are balanced orders, every block follows every other "
    "equally often",
    "[protocols][schedule]") {
  const Names blocks = GENERATE(Names{"a", "b"}, Names{"a", "b", "c"}, Names{"a", "b", "c", "d"});
  const protocols::Protocol protocol = study(blocks, "{order: williams}");
  const int orders = protocols::balanced_block_orders(protocol, nullptr);
  CHECK(orders == (blocks.size() % 2 == 0 ? 1 : 2) * std::ssize(blocks));
  for (const int first : {0, 5 * orders}) {
    std::map<std::pair<std::string, std::string>, int> followed;
    for (int i = first; i < first + orders; ++i) {
      const Names names = names_of(protocol, 1, i);
      for (std::size_t k = 1; k < names.size(); ++k) {
        ++followed[{names[k - 1], names[k]}];
      }
    }
    CHECK(followed.size() == blocks.size() * (blocks.size() - 1));
    CHECK(std::ranges::all_of(
        followed, [&](const auto& pair) { return pair.second == followed.begin()->second; }));
  }
}

TEST_CASE("random orders of blocks follow from the participant's seed, and all occur",
          "[protocols][schedule]") {
  const protocols::Protocol protocol = study({"a", "b", "c"}, "{order: shuffle}");
  std::set<Names> seen;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    CHECK(names_of(protocol, seed, 0) == names_of(protocol, seed, 1));
    seen.insert(names_of(protocol, seed, 0));
  }
  CHECK(seen.size() == 6);
  CHECK(names_of(study({"a", "b", "c"}, ""), 7, 3) == Names{"a", "b", "c"});
}

TEST_CASE(
    "practice that stands first comes before every counted trial, unless each block has its own",
    "[protocols][schedule]") {
  const std::string order = GENERATE("{order: williams}", "{order: shuffle}");
  const auto orders_of = [&](const Names& blocks) {
    const protocols::Protocol protocol = study(blocks, order);
    std::set<Names> seen;
    for (int i = 0; i < 60; ++i) {
      seen.insert(names_of(protocol, static_cast<std::uint64_t>(i), i));
    }
    return seen;
  };
  for (const Names& names : orders_of({"practice", "practice_2", "a", "b", "practice_c", "c"})) {
    CHECK(names[0] == "practice");
    CHECK(names[1] == "practice_2");
    const auto own = std::ranges::find(names, "practice_c");  // of one block: moves with it
    REQUIRE(own != names.end());
    CHECK(*std::next(own) == "c");
  }
  CHECK(orders_of({"practice_a", "a", "practice_b", "b"}) ==
        std::set<Names>{{"practice_a", "a", "practice_b", "b"},
                        {"practice_b", "b", "practice_a", "a"}});
}

TEST_CASE("a fixed block stays in its place, and so does fixed practice", "[protocols][schedule]") {
  std::set<Names> seen;
  const protocols::Protocol protocol =
      study({"practice_a", "a", "fixed", "practice_fixed", "b"}, "{order: williams}");
  for (int i = 0; i < 2; ++i) {
    seen.insert(names_of(protocol, 1, i));
  }
  CHECK(seen == std::set<Names>{{"practice_a", "a", "fixed", "practice_fixed", "b"},
                                {"practice_a", "b", "fixed", "practice_fixed", "a"}});
}

TEST_CASE("a stored order of blocks is kept, whatever this version would draw",
          "[protocols][schedule]") {
  const protocols::Protocol protocol = study({"practice", "a", "b"}, "{order: williams}");
  // as an earlier version drew it: practice with the block after it
  std::string stored;
  int number = 0;
  std::map<std::string, std::string> lines;  // each block has the trials of its place in the file
  for (const protocols::PlannedTrial& trial : make_schedule(protocol, 9, 0)) {
    lines[trial.block] += "#" + protocols::described({trial}).substr(1 + (trial.number > 9));
  }
  for (const std::string block : {"b", "practice", "a"}) {
    for (const char c : lines.at(block)) {
      stored += c == '#' ? std::to_string(++number) : std::string(1, c);
    }
  }
  CHECK(protocols::described(make_schedule(protocol, 9, 0, stored)) == stored);
  CHECK(protocols::described(make_schedule(protocol, 9, 0)) != stored);
  CHECK(protocols::first_trials(stored).at("practice") > 1);
}

TEST_CASE("practice moves with the block after it, and blocks that are not named stay",
          "[protocols][schedule]") {
  const protocols::Protocol protocol =
      study({"control", "practice_a", "a", "between", "practice_b", "practice_b2", "b", "practice"},
            "{order: williams, blocks: [a, b]}");
  std::set<Names> seen;
  for (int i = 0; i < 2; ++i) {
    seen.insert(names_of(protocol, 1, i));
  }
  CHECK(seen == std::set<Names>{{"control", "practice_a", "a", "between", "practice_b",
                                 "practice_b2", "b", "practice"},
                                {"control", "practice_b", "practice_b2", "b", "between",
                                 "practice_a", "a", "practice"}});
}

TEST_CASE("trials are numbered in the order of the blocks, and each block keeps its own order",
          "[protocols][schedule]") {
  const protocols::Protocol protocol = study({"a", "b"}, "{order: williams}");
  std::map<std::string, std::set<Names>> stimuli;
  for (int i = 0; i < 2; ++i) {
    const auto first =
        protocols::first_trials(protocols::described(protocols::make_schedule(protocol, 9, i)));
    int number = 0;
    std::map<std::string, Names> order;
    for (const protocols::PlannedTrial& trial : protocols::make_schedule(protocol, 9, i)) {
      CHECK(trial.number == ++number);
      order[trial.block].push_back(trial.alternatives.front().stimulus);
      CHECK(trial.number == first.at(trial.block) + std::ssize(order[trial.block]) - 1);
    }
    for (const auto& [block, names] : order) {
      stimuli[block].insert(names);
    }
  }
  CHECK(stimuli.at("a").size() == 1);  // one seed, whatever place the block has
  CHECK(stimuli.at("b").size() == 1);
}

namespace {
// The blocks "m…" are mixed with the one before that is not.
protocols::Protocol study_of_mixed(const Names& blocks, const std::string& order) {
  std::string text = study(blocks, order).text;
  std::string leader;
  for (const std::string& name : blocks) {
    const std::string line = "{name: " + name + ",";
    if (name.starts_with("m")) {
      text.replace(text.find(line), line.size(), line + " mixed_with: " + leader + ",");
    } else {
      leader = name;
    }
  }
  return protocols::parse_protocol(text, "study.yaml");
}

// The letters of the trials' blocks: "aabmm".
std::string sequence_of(const protocols::Schedule& schedule) {
  std::string letters;
  for (const protocols::PlannedTrial& trial : schedule) {
    letters += trial.block.front();
  }
  return letters;
}

}  // namespace

TEST_CASE("every order of mixed trials is equally likely that keeps each block's own",
          "[protocols][schedule]") {
  const protocols::Protocol mixed = study_of_mixed({"practice", "a", "m"}, "");
  const protocols::Protocol apart = study({"practice", "a", "m"}, "");
  constexpr int participants = 7000;
  std::map<std::string, std::int64_t> orders;
  bool agrees = true;
  for (int i = 0; i < participants; ++i) {
    const auto seed = static_cast<std::uint64_t>(i);
    const protocols::Schedule schedule = protocols::make_schedule(mixed, seed, i);
    ++orders[sequence_of(schedule)];
    for (const std::string block : {"practice", "a", "m"}) {
      const auto alone = protocols::make_schedule(apart, seed, i);
      agrees = agrees && testing::stimuli_of(block, schedule) == testing::stimuli_of(block, alone);
    }
  }
  CHECK(agrees);
  CHECK(orders.size() == 70);  // 8 over 4, after the practice
  double chi_squared = 0.0;
  for (const auto& [order, count] : orders) {
    CHECK(order.starts_with("pppp"));
    chi_squared += std::pow(static_cast<double>(count) - 100.0, 2.0) / 100.0;
  }
  CHECK(chi_squared < 111.1);  // the quantile .999 of 69 degrees of freedom
}

TEST_CASE("mixed blocks move together, with the practice before them, and a stored order is kept",
          "[protocols][schedule]") {
  const protocols::Protocol protocol =
      study_of_mixed({"practice_a", "a", "m", "practice_b", "b"}, "{order: williams}");
  std::set<Names> seen;
  for (int i = 0; i < 2; ++i) {
    seen.insert(names_of(protocol, 1, i));
    const protocols::Schedule schedule = protocols::make_schedule(protocol, 9, i);
    const std::string stored = protocols::described(schedule);
    CHECK(protocols::described(protocols::make_schedule(protocol, 9, i, stored)) == stored);
  }
  CHECK(seen == std::set<Names>{{"practice_a", "a", "m", "practice_b", "b"},
                                {"practice_b", "b", "practice_a", "a", "m"}});
  // practice that is for all of them stays first
  const protocols::Protocol shared =
      study_of_mixed({"practice", "a", "m", "b"}, "{order: williams}");
  for (int i = 0; i < 2; ++i) {
    CHECK(names_of(shared, 1, i).front() == "practice");
  }
}

TEST_CASE("a block is mixed with the one before it, and has neither practice nor breaks of its own",
          "[protocols]") {
  const std::string text = study({"practice", "a", "b"}, "").text;
  const auto refused = [&](const std::string& block, const std::string& keys,
                           const std::string& why) {
    std::string changed = text;
    const std::string line = "{name: " + block + ",";
    changed.replace(changed.find(line), line.size(), line + " " + keys + ",");
    CHECK_THROWS_WITH(protocols::parse_protocol(changed, "study.yaml"),
                      Contains("mixed") && Contains(why));
  };
  refused("a", "mixed_with: practice", "practice");
  refused("b", "mixed_with: b", "b");
  refused("b", "mixed_with: a, fixed: true", "fixed");
  refused("b", "mixed_with: a, breaks: {every_trials: 3}", "breaks");
}

TEST_CASE("an order of blocks that is none is refused", "[protocols]") {
  const auto refused = [](const std::string& order, const std::string& why) {
    CHECK_THROWS_WITH(study({"practice", "a", "b"}, order),
                      Contains("block_order") && Contains(why));
  };
  refused("{order: williams, blocks: [a]}", "two blocks or more");
  refused("{order: williams, blocks: [a, c]}", "'c' is not");
  refused("{order: williams, blocks: [practice, a]}", "'practice' is not");
  refused("{order: williams, blocks: [a, a]}", "twice");
  CHECK_THROWS_WITH(study({"a", "fixed", "b"}, "{order: williams, blocks: [a, fixed]}"),
                    Contains("'fixed' is not"));
  CHECK_THROWS_WITH(study({"a", "fixed"}, "{order: williams}"), Contains("two blocks or more"));
  refused("{order: listed}", "'listed' is not");
  refused("{}", "order");
  CHECK_THROWS_WITH(study({"a"}, "{order: shuffle}"), Contains("two blocks or more"));
}

// Constrained orders against the enumeration of all orders.
using Order = std::vector<std::size_t>;

namespace {
struct Case {
  std::size_t stimuli{};
  int repetitions{};
  protocols::OrderConstraints constraints{};
  bool is_within_repetition{};
};

int longest_run(const Order& order) {
  int longest = 0;
  int run = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    run = i > 0 && order[i] == order[i - 1] ? run + 1 : 1;
    longest = std::max(longest, run);
  }
  return longest;
}

std::size_t least_distance(const Order& order) {
  std::size_t least = order.size() + 1;
  for (std::size_t i = 0; i < order.size(); ++i) {
    for (std::size_t j = i + 1; j < order.size(); ++j) {
      least = order[i] == order[j] ? std::min(least, j - i) : least;
    }
  }
  return least;
}

bool has_whole_repetitions(const Order& order, std::size_t stimuli) {
  for (std::size_t from = 0; from < order.size(); from += stimuli) {
    for (std::size_t stimulus = 0; stimulus < stimuli; ++stimulus) {
      const auto begin = order.begin() + static_cast<std::ptrdiff_t>(from);
      if (std::count(begin, begin + static_cast<std::ptrdiff_t>(stimuli), stimulus) != 1) {
        return false;
      }
    }
  }
  return true;
}

std::map<Order, int> enumerated(const Case& of) {
  Order order;
  for (std::size_t stimulus = 0; stimulus < of.stimuli; ++stimulus) {
    order.insert(order.end(), static_cast<std::size_t>(of.repetitions), stimulus);
  }
  std::map<Order, int> all;
  const auto& [max_run, min_distance] = of.constraints;
  do {
    if ((max_run == 0 || longest_run(order) <= max_run) &&
        least_distance(order) >= static_cast<std::size_t>(std::max(1, min_distance)) &&
        (!of.is_within_repetition || has_whole_repetitions(order, of.stimuli))) {
      all[order] = 0;
    }
  } while (std::ranges::next_permutation(order).found);
  return all;
}
}  // namespace

TEST_CASE("constrained orders are those of the enumeration, each drawn equally often",
          "[protocols][schedule]") {
  const Case of =
      GENERATE(Case{3, 3, {1, 1}, false}, Case{2, 4, {2, 1}, false}, Case{3, 2, {2, 1}, false},
               Case{4, 2, {0, 3}, false}, Case{3, 3, {0, 2}, true}, Case{4, 2, {0, 3}, true});
  CAPTURE(of.stimuli, of.repetitions, of.constraints.max_run, of.constraints.min_distance,
          of.is_within_repetition);
  protocols::Block block;
  for (std::size_t i = 0; i < of.stimuli; ++i) {
    block.stimuli.push_back(std::to_string(i));
  }
  block.repetitions = of.repetitions;
  block.constraints = of.constraints;
  block.order = of.is_within_repetition ? protocols::Order::shuffle_within_repetition
                                        : protocols::Order::shuffle;
  auto times = enumerated(of);
  REQUIRE(times.size() > 1);
  protocols::ConstrainedOrders orders{block};
  CHECK(orders.count() == static_cast<double>(times.size()));
  core::Rng rng{7};
  constexpr int mean = 100;
  for (std::size_t i = 0; i < mean * times.size(); ++i) {
    const auto drawn = times.find(orders.draw(rng));
    REQUIRE(drawn != times.end());
    ++drawn->second;
  }
  double chi_squared = 0.0;
  for (const auto& [order, count] : times) {
    chi_squared += std::pow(count - mean, 2.0) / mean;
  }
  const auto degrees_of_freedom = static_cast<double>(times.size() - 1);
  CHECK(chi_squared < degrees_of_freedom + 5.0 * std::sqrt(2.0 * degrees_of_freedom) + 10.0);
}

// Too many orders to enumerate, of which none immediately repeats: 8 stimuli ten times each.
TEST_CASE("ordinary designs are drawn however many orders they have", "[protocols][order]") {
  protocols::Block block;
  for (std::size_t i = 0; i < 8; ++i) {
    block.stimuli.push_back(std::to_string(i));
  }
  block.repetitions = 10;
  block.constraints.max_run = 1;
  protocols::ConstrainedOrders orders{block};
  REQUIRE(orders.count());
  core::Rng rng{3};
  for (int i = 0; i < 20; ++i) {
    const Order order = orders.draw(rng);
    CHECK(longest_run(order) == 1);
    for (std::size_t stimulus = 0; stimulus < 8; ++stimulus) {
      CHECK(std::ranges::count(order, stimulus) == 10);
    }
  }
}
