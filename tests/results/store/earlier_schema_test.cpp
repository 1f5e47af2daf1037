#include <fmt/format.h>

#include "core/files/sha256.hpp"
#include "results/store/redacted_copy.hpp"
#include "results/store/schema.hpp"
#include "results/store/sqlite.hpp"
#include "results/store_error.hpp"
#include "support/stored_study.hpp"
using namespace tapstudy;
using namespace tapstudy::results;
namespace small_study = testing::small_study;

namespace {
// As a program makes it that knows no groups.
void make_without_groups(const std::string& directory) {
  Database database{directory + "/study.db", Database::Access::write};
  database.run(schema_sql_of(first_schema_version));
  database.run(fmt::format("PRAGMA application_id = {}; PRAGMA user_version = {}", application_id,
                           first_schema_version));
  Statement{database, "INSERT INTO study VALUES (1, ?, ?, ?, ?, '')"}
      .bind(small_study::study.title)
      .bind(small_study::study.protocol_file)
      .bind(small_study::study.protocol_text)
      .bind(small_study::study.protocol_sha256)
      .finish();
}

std::int64_t version_of(const std::string& directory) {
  return Database{directory + "/study.db", Database::Access::read}.pragma("user_version");
}
}  // namespace

TEST_CASE("a store from before there were groups is read and goes on as it is",
          "[results][store][groups]") {
  // of the text that programs of that version make their stores by
  CHECK(core::sha256(schema_sql_of(first_schema_version)) ==
        "7e77cbb73ce6c7294ccac40232ca5317a3f2b615c31fc0f46dc8cdcbed082e7f");
  CHECK(core::sha256(schema_sql_of(first_version_with_groups)) ==
        "6ecb5af0567783bc20ac24202e82238d73133c53422cc2c40c888bd5fda735da");
  const testing::TempDirectory directory;
  make_without_groups(directory.path());
  {
    auto [store, row] = small_study::begun_study(directory.path());
    store.add_trial(small_study::trial(row.id, 1, "a"));
    CHECK_FALSE(store.has_groups());
    SessionRow grouped = small_study::session("P02");
    grouped.group = GroupRow{"trained"};
    CHECK_THROWS_AS(store.add_session(grouped), StoreError);
  }
  CHECK(version_of(directory.path()) == first_schema_version);
  Store store = Store::open_existing(directory.path());
  REQUIRE(store.sessions().size() == 1);
  CHECK_FALSE(store.sessions().front().group);
  CHECK(store.answered_trials("P01") == std::vector<int>{1});
  const testing::TempDirectory copy;
  write_redacted_copy(directory.path(), copy.path(), {});
  CHECK(Store::open_existing(copy.path()).answered_trials("person-001") == std::vector<int>{1});
}

TEST_CASE("a participant's group is stored, journalled and kept in a redacted copy",
          "[results][store][groups]") {
  const testing::TempDirectory directory;
  SessionRow drawn = small_study::session("P01");
  drawn.group = GroupRow{"trained", false};
  SessionRow given = small_study::session("P02");
  given.participant_index = 1;
  given.group = GroupRow{"untrained", true};
  {
    Store store = Store::open_or_create(directory.path(), small_study::study);
    store.add_session(drawn);
    store.add_session(given);
  }
  const testing::TempDirectory copy;
  write_redacted_copy(directory.path(), copy.path(), {});
  for (const std::string& path : {directory.path(), copy.path()}) {
    Store store = Store::open_existing(path);
    CHECK(store.has_groups());
    CHECK(store.sessions()[0].group == drawn.group);
    CHECK(store.sessions()[1].group == given.group);
    const auto journalled = read_journal(path).sessions;
    CHECK(journalled[0].group == drawn.group);
    CHECK(journalled[1].group == given.group);
  }
}
