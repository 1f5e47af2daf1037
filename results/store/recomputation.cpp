#include "results/store/recomputation.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "results/store_error.hpp"
#include "results/traces/trace_collector.hpp"
namespace tapstudy::results {
namespace {
struct StoredAnswer {
  std::int64_t id{};
  std::optional<std::int64_t> supersedes;  // unset: the first
  std::string given_by;
  ResponseRow row;
};

}  // namespace

std::vector<StoredTrial> stored_trials(Store& store) {
  std::vector<StoredTrial> trials;
  store.each_row(
      "SELECT trial_id, participant_id, session_id, number, attempt, block, task, is_practice, "
      "repetition, status, duration_s, is_catch, presented = 'real', ticks, saturated, "
      "dropped_samples, ticks IS NOT NULL FROM trial_context "
      "LEFT JOIN tick_statistics USING (trial_id) ORDER BY trial_id",
      [&](Statement& row) {
        trials.push_back(
            {row.integer(0),
             row.text(1),
             {row.integer(2), row.small_integer(3), row.small_integer(4), row.text(5), row.text(6),
              row.flag(7), row.small_integer(8), trial_status_from(row.text(9)), row.real(10),
              row.flag(11), row.flag(12)},
             row.integer(13),
             row.integer(14),
             row.integer(15),
             row.flag(16)});
      });
  return trials;
}

std::string difference_in(const StoredTrial& trial, const std::string& what,
                          const std::string& stored, const std::string& recomputed) {
  return fmt::format("trial {} (participant {}, number {}): {} is {}, recomputed {}", trial.id,
                     trial.participant_id, trial.row.number, what, stored, recomputed);
}

namespace {
std::vector<EventRow> stored_events(Store& store, std::int64_t trial_id) {
  std::vector<EventRow> events;
  store.each_row(
      fmt::format("SELECT t_s, kind, value FROM event WHERE trial_id = {} AND kind IN {} "
                  "ORDER BY rowid",
                  trial_id, TraceEvents::kinds),
      [&](Statement& row) {
        events.push_back({row.real(0), row.text(1), row.real(2)});
      });
  return events;
}

std::vector<StoredAnswer> responses_to(Store& store, std::int64_t trial_id) {
  std::vector<StoredAnswer> answers;
  store.each_row(
      fmt::format("SELECT response_id, response, is_correct, response_time_s, "
                  "time_from_first_contact_s, confidence, supersedes, given_by FROM response "
                  "WHERE trial_id = {} ORDER BY response_id",
                  trial_id),
      [&](Statement& row) {
        answers.push_back({row.integer(0),
                           row.is_null(6) ? std::nullopt : std::optional{row.integer(6)},
                           row.text(7),
                           {row.text(1), row.optional_flag(2), row.real(3), row.optional_real(4),
                            row.optional_int(5)}});
      });
  return answers;
}

std::string to_text(const std::optional<bool>& is_correct) {
  return is_correct ? (*is_correct ? "1" : "0") : "NULL";
}
template <class Number>
std::string to_text(const std::optional<Number>& number) {
  return number ? fmt::format("{}", *number) : "NULL";
}
std::string to_text(const EventRow& event) {
  return fmt::format("{} {} at {} s", event.kind, event.value, event.t_s);
}
bool are_equal(const EventRow& a, const EventRow& b) {
  return a.t_s == b.t_s && a.kind == b.kind && a.value == b.value;
}

class Comparison {
 public:
  Comparison(Store& store, const TaskRule& rule) : store_{&store}, rule_{&rule} {}

  void compare(const StoredTrial& trial, const std::vector<AlternativeRow>& alternatives) {
    trial_ = &trial;
    const std::vector<EventRow> events = stored_events(*store_, trial.id);
    note("tick_statistics", trial.has_statistics ? "there" : "missing", "there");
    compare_positions(alternatives);
    compare_chunks();
    try {
      compare_trace(events);
    } catch (const StoreError& error) {  // those after it are checked all the same
      result_.differences.emplace_back(error.what());
    }
    const StoredAnswer* before = nullptr;
    const std::vector<StoredAnswer> answers = responses_to(*store_, trial.id);
    for (const StoredAnswer& answer : answers) {
      compare_times(answer, events);
      compare_rule(answer, alternatives);
      compare_with(before, answer);
      before = &answer;
    }
  }

  // A row of a table that refers to one that is not there.
  void note_lost_references() {
    store_->each_row("SELECT \"table\", coalesce(rowid, 0), parent FROM pragma_foreign_key_check",
                     [&](Statement& row) {
                       result_.differences.push_back(
                           fmt::format("{}: row {} refers to a row of {} that is missing",
                                       row.text(0), row.integer(1), row.text(2)));
                     });
  }
  Recomputation result() { return std::move(result_); }

 private:
  void note(const std::string& what, const std::string& stored, const std::string& recomputed) {
    if (stored != recomputed) {
      result_.differences.push_back(difference_in(*trial_, what, stored, recomputed));
    }
  }

  void compare_positions(const std::vector<AlternativeRow>& alternatives) {
    for (std::size_t i = 0; i < alternatives.size(); ++i) {
      note("alternative.position", fmt::format("{}", alternatives[i].position),
           fmt::format("{}", i));
    }
  }

  // One after the other, from the first tick.
  void compare_chunks() {
    std::int64_t next_tick = 0;
    store_->each_row(fmt::format("SELECT first_tick, ticks FROM trace_chunk WHERE trial_id = {} "
                                 "ORDER BY first_tick",
                                 trial_->id),
                     [&](Statement& row) {
                       note("trace_chunk.first_tick", fmt::format("{}", row.integer(0)),
                            fmt::format("{}", next_tick));
                       next_tick += row.integer(1);
                     });
  }

  void compare_trace(const std::vector<EventRow>& stored) {
    const std::vector<core::TraceSample> trace = store_->trace(trial_->id);
    if (trace.empty()) {
      const bool is_left_out =
          trial_->row.is_of_real_plate || trial_->ticks == 0 ||
          std::ranges::find(stored, untraced_event, &EventRow::kind) != stored.end();
      note("its trace", is_left_out ? "left out" : "missing", "left out");
      if (trial_->ticks == 0) {
        note("tick_statistics.saturated", fmt::format("{}", trial_->saturated), "0");
      }
      return;
    }
    std::vector<EventRow> events;
    TraceEvents extracted;
    for (const core::TraceSample& sample : trace) {
      extracted.add(sample, events);
    }
    result_.ticks += std::ssize(trace);
    result_.events += std::ssize(events);
    note("tick_statistics.ticks", fmt::format("{}", trial_->ticks),
         fmt::format("{}", trace.size()));
    if (trial_->dropped == 0) {
      const auto saturated = std::ranges::count_if(
          trace, [](const core::TraceSample& sample) { return sample.saturated; });
      note("tick_statistics.saturated", fmt::format("{}", trial_->saturated),
           fmt::format("{}", saturated));
    }
    note("trial.duration_s", fmt::format("{}", trial_->row.duration_s),
         fmt::format("{}", time_s(trace.back())));
    const auto [a, b] = std::ranges::mismatch(stored, events, are_equal);
    note("event", a == stored.end() ? "missing" : to_text(*a),
         b == events.end() ? "missing" : to_text(*b));
  }

  void compare_times(const StoredAnswer& answer, const std::vector<EventRow>& events) {
    std::optional<double> expected;
    if (const auto contact_s = first_contact_s(events)) {
      expected = answer.row.response_time_s - *contact_s;
    }
    note(fmt::format("response {}: time_from_first_contact_s", answer.id),
         to_text(answer.row.time_from_first_contact_s), to_text(expected));
  }

  // A correction supersedes the answer before it and takes over what the participant did.
  void compare_with(const StoredAnswer* before, const StoredAnswer& answer) {
    const auto of = [&](const char* column) {
      return fmt::format("response {}: {}", answer.id, column);
    };
    note(of("supersedes"), to_text(answer.supersedes),
         before == nullptr ? "NULL" : fmt::format("{}", before->id));
    if (before == nullptr) {
      note(of("given_by"), answer.given_by, results::to_text(GivenBy::participant));
      return;
    }
    note(of("response_time_s"), fmt::format("{}", answer.row.response_time_s),
         fmt::format("{}", before->row.response_time_s));
    note(of("confidence"), to_text(answer.row.confidence), to_text(before->row.confidence));
  }

  void compare_rule(const StoredAnswer& answer, const std::vector<AlternativeRow>& alternatives) {
    if (!rule_->knows(trial_->row)) {
      ++result_.unknown_blocks;
      return;
    }
    ++result_.answers;
    note(fmt::format("response {}: is_correct", answer.id), to_text(answer.row.is_correct),
         to_text(rule_->is_correct(trial_->row, alternatives, answer.row.response)));
  }

  Store* store_;
  const TaskRule* rule_;
  const StoredTrial* trial_{};
  Recomputation result_;
};
}  // namespace

Recomputation recompute(Store& store, const TaskRule& rule, const core::CountHook& count) {
  Comparison comparison{store, rule};
  AlternativesOfTrials alternatives = store.alternatives();
  comparison.note_lost_references();
  const std::vector<StoredTrial> trials = stored_trials(store);
  for (std::size_t i = 0; i < trials.size(); ++i) {
    comparison.compare(trials[i], alternatives[trials[i].id]);
    core::tell_count(count, i + 1, trials.size());
  }
  return comparison.result();
}
}  // namespace tapstudy::results
