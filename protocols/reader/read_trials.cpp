// How long and how often a participant may, and must, feel what a trial presents.
#include <fmt/format.h>

#include <algorithm>

#include "protocols/reader/read_sections.hpp"
#include "protocols/schedule/schedule.hpp"
namespace tapstudy::protocols {
namespace {
using Presence = MapReader::Presence;

void read_intervals(MapReader& explore, ExploreLimits& limits) {
  explore.map({"intervals",
               "alternatives come one after the other, in the trial's order; unset: the "
               "participant switches among them"},
              Presence::optional, [&](MapReader& reader) {
                Intervals intervals;
                intervals.seconds =
                    reader.number({"seconds",
                                   "how long an alternative can be felt from its go signal on; "
                                   "longer until it was tapped min_contacts times"},
                                  Range::positive(60.0));
                intervals.gap_seconds =
                    reader.number({"gap_seconds", "before each interval; nothing is rendered then"},
                                  {0.0, 60.0}, intervals.gap_seconds);
                intervals.max_replays = reader.integer(
                    {"max_replays",
                     "how often the participant may have all of them again before answering"},
                    0, 100, intervals.max_replays);
                limits.intervals = intervals;
              });
}

void read_scripted_taps(MapReader& explore, const Protocol& protocol, Presented presented,
                        ExploreLimits& limits) {
  explore.map({"scripted_taps",
               "simulation.hand taps in the participant's place, again and again, each tap alike, "
               "and anew with each switch and interval; the participant holds the device still and "
               "feels the whole force; unset: the participant taps"},
              Presence::optional, [&](MapReader& reader) {
                ScriptedTaps taps;
                taps.point = reader.word({"point", "tapping point at which all taps are"},
                                         "tapping point", keys_of(protocol.tapping_points_m));
                taps.speed_m_s =
                    reader.number({"speed_m_s", "of the hand's aim before contact"}, {0.02, 1.0});
                taps.dwell_s = reader.number({"dwell_s", "how long the plate is pressed"},
                                             {0.02, 10.0}, taps.dwell_s);
                taps.pause_s = reader.number({"pause_s", "until the next tap begins"}, {0.2, 10.0},
                                             taps.pause_s);
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
  block.map(
      {"explore", "what must be felt before an answer is taken"}, Presence::optional,
      [&](MapReader& reader) {
        limits.min_contacts = reader.integer({"min_contacts",
                                              "taps before an answer is taken, on each alternative "
                                              "that must be visited; unset: 1, with real plates 0"},
                                             0, 1000, limits.min_contacts);
        if (presented == Presented::real_plates && limits.min_contacts > 0) {
          reader.reject("min_contacts", "is 0 with real plates: their contacts are not measured");
        }
        limits.must_visit_all = reader.yes_or_no(
            {"visit_all", "choice: every alternative must be tapped, not just the chosen one"},
            limits.must_visit_all);
        limits.min_seconds = reader.number({"min_seconds", "before an answer is taken"},
                                           {0.0, 3600.0}, limits.min_seconds);
        if (reader.has("max_seconds")) {
          limits.max_seconds = reader.number(
              {"max_seconds",
               "then the trial ends without answer; above min_seconds; unset: no limit"},
              Range::positive(3600.0));
          if (*limits.max_seconds <= limits.min_seconds) {
            reader.reject("max_seconds", "is not above min_seconds");
          }
          constexpr double most_a_second = 10.0;  // of taps by one hand
          if (limits.min_contacts > most_a_second * *limits.max_seconds) {
            reader.reject("max_seconds", fmt::format("is too short: nobody taps {} times in {:g} s",
                                                     limits.min_contacts, *limits.max_seconds));
          }
        }
        limits.at_limit = reader.one_of<AtLimit>(
            {"at_limit",
             "requeue: the trial comes again at the end of its block, so that its order may no "
             "longer be balanced or as constrained; give_up: it is stored without answer"},
            {{"requeue", AtLimit::requeue}, {"give_up", AtLimit::give_up}}, "requeue");
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
  const auto end = [&](const Key& key, const std::vector<std::string>& usual) {
    const bool is_given = reader.has(key.name);
    const auto spoken =
        is_given ? languages.begin()
                 : std::ranges::find(languages, reader.language_among(key.name, languages));
    return reader.translated(key, usual.at(static_cast<std::size_t>(spoken - languages.begin())));
  };
  confidence.low = end({"low", "what 1 means"}, {"guessed", "geraten", "当て推量"});
  confidence.high = end({"high", "what the highest means"}, {"certain", "sicher", "確信がある"});
}

using Presence = MapReader::Presence;

Breaks read_breaks(MapReader& reader) {
  Breaks breaks;
  if (reader.has("every_trials")) {
    breaks.every_trials = reader.integer(
        {"every_trials", "trials of the block between two rests; unset: rests come by time only"},
        1, 1000);
  }
  if (reader.has("every_seconds")) {
    breaks.every_seconds = reader.number(
        {"every_seconds",
         "time since the last rest, or the block's begin, after which the next trial waits for a "
         "rest; with every_trials: whichever is first; unset: rests come by trials only"},
        {10.0, 36000.0});
  }
  if (reader.count_given({"every_trials", "every_seconds"}, Presence::at_least_one) == 0) {
    reader.reject("every_trials", "is missing, and so is every_seconds (give one of them)");
  }
  breaks.min_seconds = reader.number({"min_seconds", "before the participant may go on"},
                                     {0.0, 3600.0}, breaks.min_seconds);
  if (reader.has("max_seconds")) {
    breaks.max_seconds = reader.number(
        {"max_seconds", "after which the rest ends by itself; unset: the participant ends it"},
        Range::positive(3600.0));
    if (*breaks.max_seconds < breaks.min_seconds) {
      reader.reject("max_seconds", "is below min_seconds");
    }
  }
  return breaks;
}
}  // namespace

void read_between_trials(MapReader& reader, Block& block) {
  block.instructions = reader.translated_paragraphs(
      {"instructions", "for participants, shown before the block's first trial; paragraphs"}, "");
  reader.map(
      {"confidence", "how sure the participant is, asked after each answer; unset: not asked"},
      Presence::optional, [&](MapReader& inner) {
        Confidence confidence;
        confidence.steps = inner.integer({"steps", "from 1 to this"}, 2, 7, confidence.steps);
        read_ends(inner, confidence);
        block.confidence = confidence;
      });
  reader.map({"breaks", "rests: after so many trials, so much time, or both; unset: none"},
             Presence::optional, [&](MapReader& inner) { block.breaks = read_breaks(inner); });
  block.gives_feedback = reader.yes_or_no(
      {"feedback", "practice of a task with right answers only: says which answer was right"},
      false);
  if (!block.is_practice) {
    reader.check("feedback", !block.gives_feedback, R"({"const": false})",
                 "is for practice: elsewhere it would train participants");
  }
}
}  // namespace tapstudy::protocols
