#include "results/store.hpp"

#include <catch2/catch.hpp>
#include <filesystem>

#include "core/error.hpp"
#include "core/sha256.hpp"
#include "results/recorder.hpp"
#include "results/store_error.hpp"
#include "results/trace_codec.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using namespace tapstudy::results;
using Catch::Matchers::Contains;
using tapstudy::core::sha256;

namespace {
const StudyRow study{
    "a study", "study.yaml", "format: tapstudy/1", sha256("format: tapstudy/1"), {}};

SessionRow session(const std::string& participant, Mode mode = Mode::real) {
  SessionRow row;
  row.participant_id = participant;
  row.mode = mode;
  row.seed = 0xfedcba9876543210ULL;  // does not fit a signed integer
  row.planned_order = "1 main 1 a\n";
  row.rate_hz = 1000.0;
  return row;
}

TrialRecord trial(std::int64_t session_id, int number, const std::string& response) {
  TrialRecord record;
  record.trial = {session_id, number, 1, "main", "identification", false, 1, "answered", 2.0};
  record.alternatives = {{0, "", "a"}};
  record.response = ResponseRow{response, response == "a", 1.5, 1.25};
  record.events = {{0.1, "contact", 0.0}};
  record.trace = {{0, 3, encode_trace(std::vector<core::TraceSample>(3))}};
  record.statistics.ticks = 3;
  return record;
}
}  // namespace

TEST_CASE("what is stored comes back", "[results][store]") {
  const testing::TempDirectory directory;
  {
    Store store = Store::open_or_create(directory.path(), study);
    SessionRow row = session("P01");
    store.add_session(row);
    store.add_trial(trial(row.id, 1, "a"));
    store.add_trial(trial(row.id, 2, "b"));
  }
  Store store = Store::open_existing(directory.path());
  CHECK(store.study().protocol_text == study.protocol_text);
  const auto sessions = store.sessions();
  REQUIRE(sessions.size() == 1);
  CHECK(sessions[0].seed == 0xfedcba9876543210ULL);
  const auto answers = store.answers();
  REQUIRE(answers.size() == 2);
  CHECK(answers[1].stimulus == "a");
  CHECK(answers[1].response == "b");
  CHECK(answers[1].response_time_s == 1.5);
  CHECK(store.trace(1).size() == 3);
  CHECK(store.answered_trials("P01") == std::vector<int>{1, 2});
}

TEST_CASE("a trial is there whole or not at all", "[results][store]") {
  const testing::TempDirectory directory;
  Store store = Store::open_or_create(directory.path(), study);
  SessionRow row = session("P01");
  store.add_session(row);
  TrialRecord broken = trial(row.id, 1, "a");
  broken.trace.push_back(broken.trace.front());  // the same ticks twice: refused after other rows
  CHECK_THROWS_AS(store.add_trial(broken), StoreError);
  CHECK(store.answers().empty());
  CHECK(store.answered_trials("P01").empty());
  store.add_trial(trial(row.id, 1, "a"));
  CHECK(store.answers().size() == 1);
}

TEST_CASE("a trial cannot be stored over another", "[results][store]") {
  const testing::TempDirectory directory;
  Store store = Store::open_or_create(directory.path(), study);
  SessionRow row = session("P01");
  store.add_session(row);
  store.add_trial(trial(row.id, 1, "a"));
  CHECK_THROWS_AS(store.add_trial(trial(row.id, 1, "b")), StoreError);
  CHECK(store.answers().front().response == "a");
}

TEST_CASE("the study of another protocol is left alone", "[results][store]") {
  const testing::TempDirectory directory;
  { Store::open_or_create(directory.path(), study); }
  const StudyRow other{"another", "other.yaml", "x", sha256("x"), {}};
  CHECK_THROWS_AS(Store::open_or_create(directory.path(), other), core::InvalidInput);
  CHECK(Store::open_existing(directory.path()).study().title == "a study");
}

TEST_CASE("what is not a study is refused", "[results][store]") {
  const testing::TempDirectory directory;
  CHECK_THROWS_AS(Store::open_existing(directory.path()), core::InvalidInput);
  testing::write(directory / "study.db",
                 "this is not a database, but it is long enough to be read");
  CHECK_THROWS_AS(Store::open_or_create(directory.path(), study), StoreError);
  CHECK_THAT(testing::contents(directory / "study.db"), Contains("this is not a database"));
}

TEST_CASE("participants are counted once and keep to one mode", "[results][store]") {
  const testing::TempDirectory directory;
  Store store = Store::open_or_create(directory.path(), study);
  CHECK(store.index_of("P01", Mode::real) == 0);
  SessionRow first = session("P01");
  store.add_session(first);
  CHECK(store.index_of("P01", Mode::real) == 0);
  CHECK(store.index_of("P02", Mode::real) == 1);
  CHECK_THROWS_AS(store.index_of("P01", Mode::pilot), core::InvalidInput);
}

TEST_CASE("the recorder saves from its own thread and hands failures back",
          "[results][recorder][threads]") {
  const testing::TempDirectory directory;
  Store store = Store::open_or_create(directory.path(), study);
  SessionRow row = session("P01");
  store.add_session(row);
  core::SpscRing<core::TraceSample> ring{64};
  TraceCollector collector{ring};
  {
    Recorder recorder{store};
    recorder.follow(collector);
    for (int tick = 0; tick < 5000; ++tick) {  // far more than fits at once
      core::TraceSample sample{};
      sample.t_ns = tick;
      while (!ring.try_push(sample)) {
        std::this_thread::yield();
      }
    }
    recorder.leave();
    TrialRecord record = trial(row.id, 1, "a");
    auto collected = collector.finish();
    record.trace = std::move(collected.chunks);
    recorder.save(record).get();
    CHECK_THROWS_AS(recorder.save(record).get(), StoreError);
    recorder.save(trial(row.id, 2, "a"));  // not waited for
  }
  CHECK(store.answered_trials("P01") == std::vector<int>{1, 2});
  CHECK(store.trace(1).size() == 5000);
  CHECK(store.trace(1).back().t_ns == 4999);
}

TEST_CASE("SHA-256 agrees with sha256sum", "[results]") {
  const testing::TempDirectory directory;
  testing::write(directory / "text", "tapstudy\n");
  const auto result = testing::run_program({"/usr/bin/sha256sum", directory / "text"});
  CHECK_THAT(result.standard_output, Catch::StartsWith(sha256("tapstudy\n")));
}
