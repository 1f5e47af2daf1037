#include "runner/session/engine/open_study.hpp"

#include "core/error.hpp"
#include "results/journal/journal.hpp"
#include "results/store/sqlite.hpp"
#include "runner/session/engine/session_row.hpp"
#include "runner/studies/study_verification.hpp"
#include "support/blocks.hpp"
#include "support/stored_study.hpp"
using namespace tapstudy;

namespace {
protocols::Protocol asking(const std::string& question, int repetitions = 1) {
  std::string text = testing::text_with_blocks({"test"}, fmt::format("# {} times\n", repetitions));
  const auto change = [&](const std::string& what, const std::string& by) {
    text.replace(text.find(what), what.size(), by);
  };
  change("\"Which?\"", "\"" + question + "\"");
  change("order: williams", fmt::format("order: williams, repetitions: {}", repetitions));
  return protocols::parse_protocol(text, "study.yaml");
}

// Each session opens the study anew, with its own protocol.
void add_session(const std::string& directory, const protocols::Protocol& protocol,
                 const std::string& participant, int index) {
  results::Store store = runner::open_study(directory, protocol, "study.yaml");
  results::SessionRow row = testing::small_study::session(participant);
  row.participant_index = index;
  row.order_index = index;
  row.planned_order = described(protocols::make_schedule(protocol, row.seed, index));
  store.add_session(row);
}
}  // namespace

TEST_CASE("each session is stored with the texts that it ran under, and what they ask stays",
          "[runner][texts]") {
  const testing::TempDirectory directory;
  const protocols::Protocol first = asking("Which?");
  const protocols::Protocol later = asking("Which one?");
  add_session(directory.path(), first, "P1", 0);
  add_session(directory.path(), later, "P2", 1);
  add_session(directory.path(), first, "P3", 2);
  results::Store store = results::Store::open_existing(directory.path());
  const auto sessions = store.sessions();
  REQUIRE(sessions.size() == 3);
  CHECK_FALSE(sessions[0].protocol_text);
  CHECK(sessions[1].protocol_text == later.text);
  CHECK_FALSE(sessions[2].protocol_text);
  CHECK(store.study().protocol_text == first.text);
  CHECK(results::read_journal(directory.path()).sessions[1].protocol_text == later.text);
  CHECK(results::Store::from_journal(directory.path()).sessions()[1].protocol_text == later.text);
  CHECK(runner::verification_of(store, directory.path()).is_sound());
  const auto changes = runner::changes_in(first, *sessions[1].protocol_text);
  REQUIRE(changes.texts.size() == 1);
  CHECK_THAT(runner::described(changes.texts[0]), Contains("'Which one?' (before: 'Which?')"));
}

TEST_CASE("a study goes on with its protocol however it is written", "[runner][texts]") {
  const testing::TempDirectory directory;
  const protocols::Protocol first = asking("Which?", 2);
  add_session(directory.path(), first, "P1", 0);
  const std::string formatted =
      testing::replaced(testing::replaced(first.text, "mass_kg: 0.058", "mass_kg: '5.80e-2'"),
                        "order: williams, repetitions: 2", "repetitions: 0x2, \"order\": williams");
  add_session(directory.path(), protocols::parse_protocol(formatted, "study.yaml"), "P2", 1);
  results::Store store = results::Store::open_existing(directory.path());
  CHECK(store.sessions().at(1).protocol_text == formatted);
  CHECK(runner::verification_of(store, directory.path()).is_sound());
}

TEST_CASE("a protocol that asks for other data is refused by its keys, and nothing is stored",
          "[runner][texts]") {
  const testing::TempDirectory directory;
  add_session(directory.path(), asking("Which?"), "P1", 0);
  CHECK_THROWS_WITH(add_session(directory.path(), asking("Which one?", 2), "P2", 1),
                    Contains("differs in blocks[0].repetitions (") && !Contains("question"));
  CHECK(results::Store::open_existing(directory.path()).sessions().size() == 1);
}

TEST_CASE("verify tells of a session whose protocol is not the study's but for texts",
          "[runner][texts]") {
  const testing::TempDirectory directory;
  add_session(directory.path(), asking("Which?"), "P1", 0);
  add_session(directory.path(), asking("Which one?"), "P2", 1);
  {
    results::Database database{directory.path() + "/study.db", results::Database::Access::write};
    results::Statement{database,
                       "UPDATE session SET protocol_text = ? WHERE protocol_text IS NOT NULL"}
        .bind(asking("Which one?", 2).text)
        .finish();
  }
  results::Store store = results::Store::open_existing(directory.path());
  const auto broken = runner::verification_of(store, directory.path()).broken;
  REQUIRE(broken.size() == 1);
  CHECK_THAT(broken[0], Contains("session 2") && Contains("blocks[0].repetitions differs"));
}
