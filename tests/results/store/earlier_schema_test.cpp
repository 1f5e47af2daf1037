#include <fmt/format.h>

#include "core/files/sha256.hpp"
#include "results/export/study_export.hpp"
#include "results/store/redacted_copy.hpp"
#include "results/store/schema.hpp"
#include "results/store/sqlite.hpp"
#include "results/store_error.hpp"
#include "support/stored_study.hpp"
using namespace tapstudy;
using namespace tapstudy::results;
namespace small_study = testing::small_study;

namespace {
// As a program of that version makes it.
void make_store(const std::string& directory, int version) {
  Database database{directory + "/study.db", Database::Access::write};
  database.run(schema_sql_of(version));
  database.run(
      fmt::format("PRAGMA application_id = {}; PRAGMA user_version = {}", application_id, version));
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

TEST_CASE("a store of each earlier schema is read and goes on as it is",
          "[results][store][groups]") {
  // of the text that programs of that version make their stores by
  const auto [version, sha256] = GENERATE(table<int, std::string>(
      {{first_schema_version, "7e77cbb73ce6c7294ccac40232ca5317a3f2b615c31fc0f46dc8cdcbed082e7f"},
       {first_version_with_groups,
        "6ecb5af0567783bc20ac24202e82238d73133c53422cc2c40c888bd5fda735da"},
       {first_version_with_planned_sessions,
        "7da07ac46fd3e5848dcdc62284f8f6b4a431adb564f77ba89026e9a4dfe9fb6e"}}));
  CAPTURE(version);
  CHECK(core::sha256(schema_sql_of(version)) == sha256);
  const bool has_groups = version >= first_version_with_groups;
  const testing::TempDirectory directory;
  make_store(directory.path(), version);
  {
    auto [store, row] = small_study::begun_study(directory.path());
    TrialRecord actuated = small_study::trial(row.id, 1, "a");
    actuated.actuator = ActuatorRow{48'000.0, 0.004, 4.0};
    store.add_trial(actuated);  // without the actuator
    CHECK_FALSE(store.actuator(1));
    SessionRow grouped = small_study::session("P02");
    grouped.participant_index = 1;
    grouped.group = GroupRow{"trained"};
    if (has_groups) {
      store.add_session(grouped);
    } else {
      CHECK_THROWS_AS(store.add_session(grouped), StoreError);
    }
    CHECK(store.has_groups() == has_groups);
  }
  CHECK(version_of(directory.path()) == version);
  Store store = Store::open_existing(directory.path());
  REQUIRE(store.sessions().size() == (has_groups ? 2 : 1));
  CHECK_FALSE(store.sessions().front().group);
  CHECK(store.answered_trials("P01") == std::vector<int>{1});
  const testing::TempDirectory copy;
  write_redacted_copy(directory.path(), copy.path(), {});
  CHECK(Store::open_existing(copy.path()).answered_trials("person-001") == std::vector<int>{1});
  study_tables(store, {});
  CHECK_FALSE(store.has_actuators());
}

TEST_CASE("what an actuator was given is stored with its trial, and kept in a redacted copy",
          "[results][store][actuator]") {
  const testing::TempDirectory directory;
  const ActuatorTrace trace{{{1'000'000, 20833.3, -2'000'000, 3, 2, false, true},
                             {1'041'667, 20833.4, 0, 5, 1, true, false}},
                            {0.5F, -0.25F, 1e-30F}};
  {
    auto [store, row] = small_study::begun_study(directory.path());
    store.add_trial(small_study::trial(row.id, 1, "a"));
    TrialRecord actuated = small_study::trial(row.id, 2, "a");
    actuated.actuator = ActuatorRow{48'000.0, 0.004, 4.0, 0.125, 0.5, 6, 7};
    actuated.actuator_chunks = {{0, 2, 3, encode_actuator(trace)}};
    store.add_trial(actuated);
  }
  const testing::TempDirectory copy;
  write_redacted_copy(directory.path(), copy.path(), {});
  for (const std::string& path : {directory.path(), copy.path()}) {
    Store store = Store::open_existing(path);
    CHECK(store.has_actuators());
    CHECK_FALSE(store.actuator(1));
    const auto stored = store.actuator(2);
    REQUIRE(stored);
    CHECK(stored->row.delay_s == 0.004);
    CHECK(stored->row.last_n == 0.125);
    CHECK(stored->row.mean_square_n2 == 0.5);
    CHECK(stored->row.ticks_lost == 6);
    CHECK(stored->row.dropped_periods == 7);
    CHECK(stored->trace.samples == trace.samples);
    CHECK(stored->trace.periods[1].heard_at_ns == 1'041'667);
    CHECK(stored->trace.periods[1].follows_gap);
    CHECK_FALSE(stored->trace.periods[1].is_heard);
  }
}

TEST_CASE("a store of an unknown schema is refused, and says which are read", "[results][store]") {
  const testing::TempDirectory directory;
  make_store(directory.path(), schema_version);
  const int unknown = GENERATE(first_schema_version - 1, schema_version + 1);
  Database{directory.path() + "/study.db", Database::Access::write}.run(
      fmt::format("PRAGMA user_version = {}", unknown));
  CHECK_THROWS_WITH(Store::open_existing(directory.path()),
                    Contains(fmt::format("has schema {}, this program reads {} to {}", unknown,
                                         first_schema_version, schema_version)));
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
