#include <algorithm>

#include "protocols/read_sections.hpp"
namespace tapstudy::protocols {
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
