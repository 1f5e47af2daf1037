// Every value of every table of a study, changed one by one: what verification says of it, and what
// becomes of whoever reads it.
#include "runner/studies/study_verification.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>

#include "core/files/sha256.hpp"
#include "protocols/reader/read_protocol.hpp"
#include "protocols/schedule/schedule.hpp"
#include "results/export/study_export.hpp"
#include "results/journal/journal.hpp"
#include "results/store_error.hpp"
#include "results/traces/trace_codec.hpp"
#include "runner/session/devices/rigs.hpp"
#include "runner/session/engine/alternative_rows.hpp"
#include "runner/session/engine/between_trials.hpp"
#include "runner/session/engine/session_row.hpp"
#include "runner/session/engine/stored_names.hpp"
#include "runner/studies/session_times.hpp"
#include "runner/studies/simulated_study.hpp"
#include "runner/studies/stored_results.hpp"
#include "runner/studies/stored_study.hpp"
#include "runner/studies/study_summary.hpp"
#include "support/catch.hpp"
#include "support/stored_study.hpp"
#include "support/texts.hpp"
using namespace tapstudy;

namespace {
constexpr const char* every_table_once = R"(format: tapstudy/1
title: Every table once
finger: {mass_kg: 0.058, stiffness_n_per_m: 300, damping_n_s_per_m: 3}
rendering:
  rate_hz: 1000
  band_limit_hz: 300
  crossover_hz: [180, 220]
  penalty_stiffness_n_per_m: 3000
  sinusoid: {amplitude_n_s_per_m: 3, decay_per_s: 600, frequency_hz: 250}
placement: {origin_m: [0, 0, 0], lateral_scale: 0.1}
materials:
  mdf: {youngs_modulus_pa: 2.5e9, density_kg_per_m3: 610, poissons_ratio: 0.25, damping: {ratio: 0.02}}
plates:
  held: {size_m: [0.3, 0.3, 0.05], fixations: [{region: disc, at_m: [0.1, 0.1], radius_m: 0.02}]}
  thin: {size_m: [0.3, 0.3, 0.04], fixations: [{region: disc, at_m: [0.1, 0.1], radius_m: 0.02}]}
tapping_points_m: {middle: [0, 0]}
stimuli:
  one: {plate: held, material: mdf, technique: sinusoid}
  other: {plate: thin, material: mdf, technique: none}
  family:
    plate: held
    material: mdf
    technique: sinusoid
    vary: {sinusoid_amplitude_n_s_per_m: {from: 3, to: 6}}
forms:
  about:
    title: About you
    items:
      - {name: hand, kind: single_choice, question: "Which hand?", options: [left, right]}
      - {name: remark, kind: text, question: "What else?", required: false}
forms_before: [about]
blocks:
  - name: main
    task: identification
    question: "Which?"
    stimuli: [one, other]
    order: listed
    explore: {min_contacts: 0}
  - name: strength
    task: magnitude
    question: "How strong?"
    stimuli: [family]
    values: [3, 6]
    order: listed
    explore: {min_contacts: 0}
  - name: mounted
    task: identification
    question: "Which?"
    stimuli: [one, other]
    order: listed
    presented: real
simulation:
  taps: {points: [middle], taps_per_visit: 1, visits: 1}
  observer: {noise_db: 3, reality: sinusoid}
)";

// What verification need not notice, and why.
const std::map<std::string, std::string> kept_once{
    {"study.created_utc", "nothing else says when the study was made"},
    {"session_event.t_s", "beyond its place in the order nothing else says when a state began"},
    {"session_event.detail", "words for people, where it does not name a questionnaire or a fault"},
};

// A participant whose session somebody wrote down by hand: with a questionnaire, an answer that is
// corrected, a trial that is skipped, and a note.
void add_person(const protocols::Protocol& protocol, results::Store& store) {
  runner::SessionPlan plan{"sim-hand", 1, 1, results::Mode::simulated, 7, "none", "virtual", ""};
  const protocols::Schedule schedule = make_schedule(protocol, plan.seed, plan.order_index);
  results::SessionRow session =
      runner::session_row(plan, protocol, runner::simulated_rig(), schedule);
  store.add_session(session);
  const std::int64_t id = session.id;
  store.add_session_events({{id, 0.0, "begun", {}, ""}, {id, 0.5, "form", {}, "about"}});
  store.add_form({{id, 1.0, "about", runner::asked_at_begin, "hand", "left"},
                  {id, 1.0, "about", runner::asked_at_begin, "remark", {}}});
  for (int number = 1; number <= 2; ++number) {
    const protocols::PlannedTrial& planned = schedule[static_cast<std::size_t>(number) - 1];
    results::TrialRecord record = testing::small_study::trial(id, number, "one");
    record.alternatives = runner::alternative_rows(planned, protocol.block(planned.block));
    record.trial.repetition = planned.repetition;
    record.response->is_correct = planned.alternatives.front().stimulus == "one";
    const bool is_skipped = number == 2;
    record.trial.duration_s = 2.0;
    record.statistics.ticks = 2001;
    std::vector<core::TraceSample> trace;
    for (std::int64_t i = 0; i <= 2000; ++i) {
      trace.push_back(testing::small_study::sample(1'000'000 * i, i >= 250));
    }
    testing::small_study::set_trace(record, trace);
    const double t_s = 10.0 * number;
    record.session_events = {{id, t_s, "ready", number, ""},
                             {id, t_s + 1.0, "exploring", number, ""}};
    if (is_skipped) {
      record.response.reset();
      record.trial.status = results::TrialStatus::skipped;
      record.session_events.push_back({id, t_s + 2.0, "skipped", number, ""});
    } else {
      record.session_events.push_back({id, t_s + 2.0, "confirmed", number, ""});
      record.session_events.push_back({id, t_s + 2.0, "saved", number, ""});
    }
    store.add_trial(record);
  }
  store.add_correction({id, 1, "other", false}, {id, 15.0, "correct", 1, "other"});
  store.add_operator_action({id, 16.0, "note", {}, "coughed"});
  store.add_session_events({{id, 40.0, "stopped", {}, "fire alarm"}});
}

// All of a study in one writable store; each change of it is taken back.
class ChangedStudy {
 public:
  ChangedStudy()
      : protocol_{write_protocol()}, store_{results::Store::open_or_create(path(), row())} {
    store_.suspend_sync();
    add_person(protocol_, store_);
    store_.resume_sync();
    store_.query("PRAGMA foreign_keys = OFF").finish();
    before_ = found();
    REQUIRE(before_.is_sound());  // or every change would seem to be noticed
  }
  const runner::Verification& before() const { return before_; }
  results::Store& store() { return store_; }
  std::string path() const { return directory_ / "study"; }

  // Whether verification differs after the statement; unset: the database refuses it, or it changes
  // nothing.
  std::optional<bool> is_noticed(const std::string& statement, const std::string& looked_at,
                                 const std::function<void()>& also = {}) {
    store_.query("BEGIN").finish();
    std::optional<bool> noticed;
    const std::string as_it_was = text(looked_at);
    try {
      store_.query("PRAGMA ignore_check_constraints = ON").finish();
      store_.query(statement).finish();
      store_.query("PRAGMA ignore_check_constraints = OFF").finish();
      if (text(looked_at) != as_it_was) {
        noticed = differs();
        if (also) {
          also();
        }
      }
    } catch (const results::StoreError&) {
      store_.query("PRAGMA ignore_check_constraints = OFF").finish();
    }
    store_.query("ROLLBACK").finish();
    return noticed;
  }
  std::vector<std::vector<std::string>> rows(const std::string& select, int columns) {
    std::vector<std::vector<std::string>> rows;
    store_.each_row(select, [&](results::Statement& row) {
      std::vector<std::string>& cells = rows.emplace_back();
      for (int i = 0; i < columns; ++i) {
        cells.push_back(row.text(i));
      }
    });
    return rows;
  }

 private:
  std::string protocol_file() const { return directory_ / "every_table_once.yaml"; }
  std::string rig_file() const { return directory_ / "rig.yaml"; }
  protocols::Protocol write_protocol() {
    testing::write(protocol_file(), every_table_once);
    protocols::Protocol protocol = protocols::read_protocol(protocol_file());
    results::Store::open_or_create(path(), row_of(protocol));  // with the surface
    testing::write(rig_file(), testing::contents(testing::shipped("rigs/simulated_hand.yaml")) +
                                   "\nactuator: {full_scale_n: 20, max_rms_force_n: 0.2}\n");
    runner::simulate({.protocol_file = protocol_file(),
                      .directory = path(),
                      .participants = 1,
                      .rig_file = rig_file()},
                     protocol);
    return protocol;
  }
  results::StudyRow row_of(const protocols::Protocol& protocol) const {
    results::StudyRow row = runner::study_row(protocol, protocol_file());
    row.surfaces.push_back({"a.stl", core::sha256("solid\n"), "solid\n"});
    return row;
  }
  results::StudyRow row() const { return row_of(protocol_); }
  runner::Verification found() { return runner::verification_of(store_, path()); }
  bool differs() {
    try {
      const runner::Verification now = found();
      return !now.is_sound() || now.remarks != before_.remarks;
    } catch (const core::Error&) {
      return true;
    }
  }
  std::string text(const std::string& select) {
    std::string all;
    store_.each_row(select, [&](results::Statement& row) { all += row.text(0) + "\n"; });
    return all;
  }

  testing::TempDirectory directory_;
  protocols::Protocol protocol_;
  results::Store store_;
  runner::Verification before_;
};

ChangedStudy& changed_study() {
  static ChangedStudy study;
  return study;
}

struct ColumnOfTable {
  std::string table;
  std::string name;
  std::string type;
  bool is_key{};
};
std::vector<ColumnOfTable> columns_of_schema(ChangedStudy& study) {
  std::vector<ColumnOfTable> columns;
  for (const auto& row : study.rows(
           "SELECT one.name, info.name, info.type, info.pk > 0 FROM sqlite_schema AS one "
           "JOIN pragma_table_info(one.name) AS info WHERE one.type = 'table' ORDER BY 1, info.cid",
           4)) {
    columns.push_back({row[0], row[1], row[2], row[3] == "1"});
  }
  return columns;
}

// The first row of a table and the last.
std::set<std::string> some_rows(ChangedStudy& study, const std::string& table) {
  std::set<std::string> some;
  const auto rows = study.rows("SELECT rowid FROM " + table + " ORDER BY rowid", 1);
  REQUIRE_FALSE(rows.empty());  // a table without rows is a table that is not tried
  for (const std::size_t at : {std::size_t{0}, rows.size() - 1}) {
    some.insert(rows[at][0]);
  }
  return some;
}

std::vector<std::string> other_values(const ColumnOfTable& column) {
  const std::string& name = column.name;
  if (column.type == "INTEGER") {
    return {"coalesce(" + name + " + 1, 1)", "coalesce(-1 - " + name + ", 2)", "NULL"};
  }
  if (column.type == "REAL") {
    return {"coalesce(" + name + " + 0.25, 1.0)", "-1.0", "NULL"};
  }
  if (column.type == "TEXT") {
    return {"coalesce(" + name + " || 'x', 'x')",
            fmt::format("(SELECT other.{0} FROM {1} AS other WHERE other.{0} IS NOT {1}.{0})", name,
                        column.table),
            "NULL"};
  }
  return {
      fmt::format("CAST(substr({0}, 1, length({0}) / 2) || x'5a' || "
                  "substr({0}, length({0}) / 2 + 2) AS BLOB)",
                  name)};
}
}  // namespace

TEST_CASE("an untouched study of every table is sound", "[runner][verify]") {
  const runner::Verification& found = changed_study().before();
  CAPTURE(found.broken, found.recomputed.differences, found.study_and_sessions,
          found.not_in_journal, found.not_in_database, found.remarks, found.journal_fault);
  CHECK(found.is_sound());
  CHECK(found.remarks.empty());
  CHECK(found.answers == 7);
}

namespace {
// What verification says once a trial's samples, or the times of its periods, are others.
std::string said_of_actuator(const std::function<void(results::ActuatorTrace&)>& change) {
  ChangedStudy& study = changed_study();
  const std::int64_t trial = std::stol(
      study.rows("SELECT trial_id FROM actuator_chunk ORDER BY length(bytes) DESC", 1)[0][0]);
  results::ActuatorTrace trace = study.store().actuator(trial)->trace;
  change(trace);
  study.store().query("BEGIN").finish();
  study.store().query("DELETE FROM actuator_chunk WHERE trial_id = ?").bind(trial).finish();
  study.store()
      .query("INSERT INTO actuator_chunk VALUES (?, 0, ?, ?, ?, ?)")
      .bind(trial)
      .bind(std::ssize(trace.periods))
      .bind(std::ssize(trace.samples))
      .bind(std::string{results::actuator_codec})
      .bind(std::span<const std::byte>{results::encode_actuator(trace)})
      .finish();
  const runner::Verification found = runner::verification_of(study.store(), study.path());
  study.store().query("ROLLBACK").finish();
  return fmt::format("{}", fmt::join(found.recomputed.differences, "\n"));
}
}  // namespace

TEST_CASE("what an actuator was given follows from the trace and the times of its periods",
          "[runner][verify][actuator]") {
  CHECK(changed_study().before().actuator_samples > 10'000);
  CHECK(said_of_actuator([](auto& /*trace*/) {}).empty());
  const auto loudest = [](results::ActuatorTrace& trace) -> float& {
    return *std::ranges::max_element(trace.samples, {},
                                     [](float sample) { return std::abs(sample); });
  };
  CHECK_THAT(said_of_actuator([&](auto& trace) { loudest(trace) *= 0.999F; }),
             Contains("sample of the actuator at ") && Contains(", recomputed "));
  CHECK_THAT(said_of_actuator([](auto& trace) {
               for (core::ActuatorPeriod& period : trace.periods) {
                 period.heard_at_ns += 50'000;
               }
             }),
             Contains("sample of the actuator at "));
  CHECK_THAT(said_of_actuator([](auto& trace) { trace.periods.back().ticks += 1; }),
             Contains("actuator: ticks told is "));
  CHECK_THAT(said_of_actuator([](auto& trace) {
               trace.samples.resize(trace.samples.size() - trace.periods.back().samples);
               trace.periods.pop_back();
             }),
             Contains("actuator is there in part, recomputed heard to its end"));
}

TEST_CASE("a simulation of which a session never began is called unfinished", "[runner][verify]") {
  ChangedStudy& study = changed_study();
  study.store().query("BEGIN").finish();
  study.store().query("DELETE FROM session_event").finish();
  const runner::Verification found = runner::verification_of(study.store(), study.path());
  study.store().query("ROLLBACK").finish();
  CHECK_THAT(fmt::format("{}", fmt::join(found.remarks, "; ")),
             Contains("2 simulated sessions never began, from sim-01 on"));
}

TEST_CASE("verification notices every value that is changed, but for those that are kept once",
          "[runner][verify]") {
  ChangedStudy& study = changed_study();
  std::set<std::string> unnoticed;
  int tried = 0;
  for (const ColumnOfTable& column : columns_of_schema(study)) {
    for (const std::string& row : some_rows(study, column.table)) {
      for (const std::string& value : other_values(column)) {
        const std::string name = column.table + "." + column.name;
        const auto noticed = study.is_noticed(
            fmt::format("UPDATE {} SET {} = {} WHERE rowid = {}", column.table, column.name, value,
                        row),
            fmt::format("SELECT quote({}) FROM {} ORDER BY rowid", column.name, column.table));
        tried += noticed ? 1 : 0;
        if (noticed == false && !kept_once.contains(name)) {
          unnoticed.insert(fmt::format("{} of row {} = {}", name, row, value));
        }
      }
    }
  }
  CAPTURE(unnoticed);
  CHECK(unnoticed.empty());
  CHECK(tried > 300);
}

TEST_CASE("verification notices every row that is missing or stands twice", "[runner][verify]") {
  ChangedStudy& study = changed_study();
  std::map<std::string, std::vector<ColumnOfTable>> tables;
  for (const ColumnOfTable& column : columns_of_schema(study)) {
    tables[column.table].push_back(column);
  }
  for (const auto& [table, columns] : tables) {
    for (const std::string& row : some_rows(study, table)) {
      CAPTURE(table, row);
      const std::string count = "SELECT count(*) FROM " + table;
      CHECK(study.is_noticed(fmt::format("DELETE FROM {} WHERE rowid = {}", table, row), count) ==
            true);
      std::vector<std::string> copied;
      for (const ColumnOfTable& column : columns) {  // what must differ from row to row does
        const bool must_differ =
            column.is_key || column.name == "participant_index" || column.name == "attempt";
        copied.push_back(!must_differ ? column.name
                         : column.type == "INTEGER"
                             ? "(SELECT max(" + column.name + ") + 1 FROM " + table + ")"
                             : column.name + " || '2'");
      }
      CHECK(study
                .is_noticed(fmt::format("INSERT INTO {0} SELECT {1} FROM {0} WHERE rowid = {2}",
                                        table, fmt::join(copied, ", "), row),
                            count)
                .value_or(true));
    }
  }
}

TEST_CASE("settings within one tick are no fault, unless one stands twice or out of its order",
          "[runner][verify]") {
  ChangedStudy& study = changed_study();
  const auto settings = [&](const std::string& rows) {
    return study.is_noticed(
        "INSERT INTO event SELECT 1, 0.001 * column1, 'setting', column2 FROM (VALUES " + rows +
            ")",
        "SELECT count(*) FROM event");
  };
  CHECK(settings("(0, 1), (5, 2), (5, 1), (5, 2), (6, 1)") == false);
  CHECK(settings("(0, 1), (5, 2), (5, 2)") == true);
  CHECK(settings("(0, 1), (5, 2), (4, 1)") == true);
}

TEST_CASE("verification names what does not fit into the time of its session", "[runner][verify]") {
  ChangedStudy& study = changed_study();
  const std::string of_last = " WHERE session_id = (SELECT max(session_id) FROM session) ";
  const auto what_is_said = [&](const std::string& change, const std::string& of) {
    std::string said;
    study.is_noticed(change, of, [&] {
      const runner::Verification found = runner::verification_of(study.store(), study.path());
      said = fmt::format("{}", fmt::join(found.broken, "\n"));
    });
    return said;
  };
  const std::string states = "SELECT t_s FROM session_event";
  CHECK_THAT(what_is_said("UPDATE session_event SET t_s = t_s + 0.5" + of_last +
                              "AND state = 'ready' AND number = 1",
                          states),
             Contains("a trial is over before what comes after it: not trial ") &&
                 Contains("(2.0 s in 1.5 s of session "));
  CHECK_THAT(
      what_is_said("UPDATE session_event SET t_s = 30.0" + of_last + "AND state = 'saved'", states),
      Contains("ready at 20 s is earlier than what came before") ||
          Contains("'ready' at 20 s is earlier than what came before"));
  CHECK_THAT(
      what_is_said("UPDATE form_answer SET t_s = 12.0" + of_last, "SELECT t_s FROM form_answer"),
      Contains("a questionnaire is sent while it is shown: not about of session ") &&
          Contains("at 12.0 s"));
  CHECK_THAT(what_is_said("UPDATE operator_action SET t_s = -1.0 WHERE action_id = 2",
                          "SELECT t_s FROM operator_action"),
             Contains("times of a session are from its begin on: not action 2"));
}

TEST_CASE(
    "a session that began before the one before it was over is told, and no damage where the "
    "clock was set back",
    "[runner][verify]") {
  const testing::TempDirectory directory;
  results::Store store =
      results::Store::open_or_create(directory.path(), testing::small_study::study);
  const auto begin = [&](const std::string& person, const std::string& utc) {
    results::SessionRow row = testing::small_study::session(person);
    row.participant_index = person == "P01" ? 0 : 1;
    row.started_utc = utc;
    store.add_session(row);
    store.add_session_events({{row.id, 0.0, "begun", {}, ""}, {row.id, 600.0, "ended", {}, ""}});
  };
  const auto checked = [&] { return runner::checked_session_times(store); };
  begin("P01", "2026-03-29T00:55:00Z");
  begin("P02", "2026-03-29T00:56:00Z");  // at another machine
  begin("P01", "2026-03-29T01:05:00Z");  // as the one before ends
  CHECK(checked().unlikely.empty());
  begin("P01", "2026-03-29T00:30:00Z");
  begin("P01", "2026-03-29T00:40:00Z");
  REQUIRE(checked().unlikely.size() == 1);
  CHECK_THAT(checked().unlikely.front(),
             Contains("session 4 of 'P01' began at 2026-03-29T00:30:00Z, 2700 s before session 3 "
                      "of the same participant was over") &&
                 Contains("the clock was set back"));
  CHECK(checked().wrong.empty());
  begin("P02", "yesterday");
  CHECK(checked().wrong ==
        std::vector<std::string>{"session 6: 'yesterday' is no time at which it began"});
}

TEST_CASE("whoever reads a study that was changed reads it, or ends in an error that says why",
          "[runner][verify]") {
  ChangedStudy& study = changed_study();
  const auto read_all = [&] {
    try {
      runner::summary_of_study({{study.path(), &study.store()}}, results::Mode::simulated,
                               runner::Detail::main_results);
      const protocols::Protocol protocol = runner::stored_protocol(study.store());
      runner::check_names(study.store(), protocol);
      for (const results::Table& table : results::study_tables(study.store(), {})) {
        table.each_row([](const results::Row& /*row*/) {});
      }
      runner::tracks_table(protocol, study.store());
    } catch (const core::Error&) {
    }
  };
  for (const ColumnOfTable& column : columns_of_schema(study)) {
    const std::string row = *some_rows(study, column.table).begin();
    const std::string value = other_values(column).front();
    const std::string change =
        fmt::format("UPDATE {} SET {} = {}", column.table, column.name, value);
    CAPTURE(change, row);
    const std::string quoted = fmt::format("SELECT quote({}) FROM {}", column.name, column.table);
    CHECK_NOTHROW(study.is_noticed(change + " WHERE rowid = " + row, quoted, read_all));
  }
}

TEST_CASE("a trial of a block that the protocol lacks is named by whoever reads the study",
          "[runner][verify]") {
  ChangedStudy& study = changed_study();
  study.is_noticed(
      "UPDATE trial SET block = 'nowhere' WHERE trial_id = 2", "SELECT block FROM trial", [&] {
        CHECK_THROWS_WITH(
            runner::summary_of_study({{study.path(), &study.store()}}, results::Mode::simulated),
            Contains("trial 2 is of block 'nowhere', which the protocol lacks"));
        CHECK_THROWS_AS(runner::check_names(study.store(), runner::stored_protocol(study.store())),
                        results::StoreError);
      });
}

TEST_CASE("the unfinished beginning of a study is called so, and is not damaged",
          "[runner][verify]") {
  const testing::TempDirectory directory;
  testing::write(directory / "study.db", "");  // of a program that was killed at once
  CHECK_THROWS_WITH(results::Store::open_existing(directory.path()),
                    Contains("unfinished beginning") && Contains("holds nothing"));
  results::Store store =
      results::Store::open_or_create(directory.path(), testing::small_study::study);
  std::filesystem::remove(directory / "answers.journal");
  const runner::Verification found = runner::verification_of(store, directory.path());
  CHECK(found.broken.empty());
  CHECK_THAT(found.journal_fault, Contains("unfinished beginning"));
}

TEST_CASE("a line of the journal that tapstudy did not write is refused in words of its own",
          "[runner][verify]") {
  const testing::TempDirectory directory;
  testing::small_study::begun_study(directory.path());
  const std::string file = directory / "answers.journal";
  const std::string before = testing::contents(file);
  const std::size_t last = before.rfind('\n', before.size() - 2) + 1;
  const std::string chain =
      results::split_line(before.substr(last, before.size() - last - 1)).chain;
  for (const char* const body : {"{\"kind\":\"session\"}", "{\"kind\":7}", "{", "[1]"}) {
    testing::write(file,
                   before + results::join_line({body, results::chain_of(chain, body)}) + "\n");
    CHECK_THROWS_WITH(results::read_journal(directory.path()),
                      Catch::Matchers::EndsWith("line 3: is not a line as tapstudy writes it") ||
                          Contains("line 3: was changed"));
  }
}

TEST_CASE("a journal whose session is lost makes no study, and says which", "[runner][verify]") {
  const testing::TempDirectory directory;
  results::Journal{directory.path()}.complete([] { return testing::small_study::study; }, {},
                                              {.actions = {{9, 1.0, "note", {}, "coughed"}}});
  CHECK_THROWS_WITH(results::Store::from_journal(directory.path()),
                    Contains("has entries of session 9, but not the session"));
}
