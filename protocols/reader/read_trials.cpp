// How long and how often a participant may, and must, feel what a trial presents.
#include <fmt/format.h>

#include <algorithm>

#include "protocols/reader/read_sections.hpp"
#include "protocols/schedule/schedule.hpp"
namespace tapstudy::protocols {
namespace {
using Presence = MapReader::Presence;

void read_intervals(MapReader& explore, ExploreLimits& limits) {
  explore.map("intervals", Presence::optional, [&](MapReader& reader) {
    Intervals intervals;
    intervals.seconds = reader.number("seconds", Range::positive(60.0));
    intervals.gap_seconds = reader.number("gap_seconds", {0.0, 60.0}, intervals.gap_seconds);
    intervals.max_replays = reader.integer("max_replays", 0, 100, intervals.max_replays);
    limits.intervals = intervals;
  });
}

void read_scripted_taps(MapReader& explore, const Protocol& protocol, Presented presented,
                        ExploreLimits& limits) {
  explore.map("scripted_taps", Presence::optional, [&](MapReader& reader) {
    ScriptedTaps taps;
    taps.point = reader.word("point", "tapping point", keys_of(protocol.tapping_points_m));
    taps.speed_m_s = reader.number("speed_m_s", {0.02, 1.0});
    taps.dwell_s = reader.number("dwell_s", {0.02, 10.0}, taps.dwell_s);
    taps.pause_s = reader.number("pause_s", {0.2, 10.0}, taps.pause_s);
    limits.scripted_taps = taps;
  });
  if (limits.scripted_taps && presented == Presented::real_plates) {
    explore.reject("scripted_taps", "are felt through the device: real plates are tapped by hand");
  }
}

}  // namespace

// How often a real plate is touched is not measured.
ExploreLimits read_explore(MapReader& block, const Protocol& protocol, Presented presented) {
  ExploreLimits limits;
  if (presented == Presented::real_plates) {
    limits.min_contacts = 0;
  }
  block.map("explore", Presence::optional, [&](MapReader& reader) {
    limits.min_contacts = reader.integer("min_contacts", 0, 1000, limits.min_contacts);
    if (presented == Presented::real_plates && limits.min_contacts > 0) {
      reader.reject("min_contacts", "is 0 with real plates: their contacts are not measured");
    }
    limits.must_visit_all = reader.yes_or_no("visit_all", limits.must_visit_all);
    limits.min_seconds = reader.number("min_seconds", {0.0, 3600.0}, limits.min_seconds);
    if (reader.has("max_seconds")) {
      limits.max_seconds = reader.number("max_seconds", Range::positive(3600.0));
      if (*limits.max_seconds <= limits.min_seconds) {
        reader.reject("max_seconds", "is not above min_seconds");
      }
    }
    limits.at_limit = reader.one_of<AtLimit>(
        "at_limit", {{"requeue", AtLimit::requeue}, {"give_up", AtLimit::give_up}}, "requeue");
    read_intervals(reader, limits);
    read_scripted_taps(reader, protocol, presented, limits);
  });
  return limits;
}

// What is one after the other cannot be of one thing, nor be changed while it is felt; and an
// answer is possible only after the last.
void check_intervals(MapReader& reader, const Block& block) {
  if (!block.explore.intervals) {
    return;
  }
  const auto trials = block.task->trials(block, {});
  if (trials.empty()) {
    return;
  }
  const bool is_of_several = trials.front().alternatives.size() > 1;
  if (!is_of_several || block.task->settings(trials.front(), block)) {
    reader.reject("explore",
                  fmt::format("intervals: the alternatives of {} cannot come one after the "
                              "other: {}",
                              block.task->name(),
                              is_of_several ? "the last is changed while it is felt"
                                            : "a trial has only one"));
    return;
  }
  const Intervals& intervals = *block.explore.intervals;
  const double all_s = static_cast<double>(trials.front().alternatives.size()) *
                       (intervals.seconds + intervals.gap_seconds);
  if (block.explore.max_seconds && *block.explore.max_seconds <= all_s) {
    reader.reject("explore", fmt::format("max_seconds: is over before an answer is possible: the "
                                         "intervals take {:.4g} s",
                                         all_s));
  }
}

namespace {
// Where the protocol has no words of its own, those of the pages' languages.
void read_ends(MapReader& reader, Confidence& confidence) {
  const std::vector<std::string> languages{"en", "de", "ja"};
  const auto end = [&](const char* key, const std::vector<std::string>& usual) {
    const bool is_given = reader.has(key);
    const auto spoken = is_given
                            ? languages.begin()
                            : std::ranges::find(languages, reader.language_among(key, languages));
    return reader.translated(key, usual.at(static_cast<std::size_t>(spoken - languages.begin())));
  };
  confidence.low = end("low", {"guessed", "geraten", "当て推量"});
  confidence.high = end("high", {"certain", "sicher", "確信がある"});
}

using Presence = MapReader::Presence;

Breaks read_breaks(MapReader& reader) {
  Breaks breaks;
  if (reader.has("every_trials")) {
    breaks.every_trials = reader.integer("every_trials", 1, 1000);
  }
  if (reader.has("every_seconds")) {
    breaks.every_seconds = reader.number("every_seconds", {10.0, 36000.0});
  }
  if (!breaks.every_trials && !breaks.every_seconds) {
    reader.reject("every_trials", "is missing, and so is every_seconds (give one of them)");
  }
  breaks.min_seconds = reader.number("min_seconds", {0.0, 3600.0}, breaks.min_seconds);
  if (reader.has("max_seconds")) {
    breaks.max_seconds = reader.number("max_seconds", Range::positive(3600.0));
    if (*breaks.max_seconds < breaks.min_seconds) {
      reader.reject("max_seconds", "is below min_seconds");
    }
  }
  return breaks;
}
}  // namespace

void read_between_trials(MapReader& reader, Block& block) {
  block.instructions = reader.translated_paragraphs("instructions", "");
  reader.map("confidence", Presence::optional, [&](MapReader& inner) {
    Confidence confidence;
    confidence.steps = inner.integer("steps", 2, 7, confidence.steps);
    read_ends(inner, confidence);
    block.confidence = confidence;
  });
  reader.map("breaks", Presence::optional,
             [&](MapReader& inner) { block.breaks = read_breaks(inner); });
  block.gives_feedback = reader.yes_or_no("feedback", false);
  if (block.gives_feedback && !block.is_practice) {
    reader.reject("feedback", "is for practice: elsewhere it would train participants");
  }
}
}  // namespace tapstudy::protocols
