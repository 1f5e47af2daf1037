#include "analysis/report/answer_tables/answer_columns.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

#include "core/error.hpp"
#include "core/text/plain_text.hpp"
namespace tapstudy::analysis {
bool is_same_word(std::string_view one, std::string_view other) {
  return core::lower_case(one) == core::lower_case(other);
}

namespace {
using Header = std::vector<std::string>;
using Names = std::vector<std::string_view>;

// Each list is tried in turn; ".keys" stands for the one column whose name ends so.
struct AnswerFormat {
  Names marks;  // columns by which it is known
  Names stimulus;
  Names response;
  Names participant;
  Names time;
  double time_unit_s;
  Names correct;
  Names runs;
  std::vector<RowCondition> counted{};  // of the columns that there are
  std::string_view block{};
};

Names usual_participants() {
  return {
      "participant_id", "participant", "participantid", "subject_id",   "subject",
      "subjectid",      "subject_nr",  "ppid",          "prolific_pid", "participant private id"};
}

const std::vector<AnswerFormat>& formats() {
  static const std::vector<AnswerFormat> table{
      {{"participant_id", "is_practice", "is_catch", "is_excluded"},
       {"stimulus"},
       {"response"},
       {"participant_id"},
       {"response_time_s"},
       1.0,
       {"is_correct"},
       {},  // a session that was resumed is no second run
       {{"is_practice", "0"},
        {"is_catch", "0"},
        {"is_excluded", "0"},
        {"is_current", "1"},
        {"status", "answered"}},
       "block"},
      // psychopy.org, "Long-wide" data files
      {{"expName", "psychopyVersion"},
       {"stimulus"},
       {".keys"},
       {"participant"},
       {".rt"},
       1.0,
       {},  // X.corr beside X.keys
       {"date", "session"}},
      // jspsych.org, "Data storage": rt and time_elapsed are in milliseconds
      {{"trial_type", "trial_index", "time_elapsed"},
       {"stimulus"},
       {"response"},
       usual_participants(),
       {"rt"},
       1e-3,
       {"correct"},
       {"run_id", "session_id", "date", run_of_file}},
      {{},
       {"stimulus"},
       {"response"},
       usual_participants(),
       {"response_time_s"},
       0.0,  // each program has its own
       {"correct", "is_correct", "iscorrect", "accuracy", "acc", "corr"},
       {"date", "session", "session_id", "run", "run_id", run_of_file}}};
  return table;
}

bool has(const Header& header, std::string_view name) {
  return std::ranges::any_of(header,
                             [&](const std::string& one) { return is_same_word(one, name); });
}

const AnswerFormat& format_of(const Header& header) {
  return *std::ranges::find_if(formats(), [&](const AnswerFormat& format) {
    return std::ranges::all_of(format.marks,
                               [&](std::string_view mark) { return has(header, mark); });
  });
}

[[noreturn]] void refuse(const std::string& where, const std::string& what) {
  throw core::InvalidInput{fmt::format("{}: {}", where, what)};
}

std::size_t place_of_named(const Header& header, std::string_view name, const std::string& where) {
  const auto found = std::ranges::count(header, name);
  if (found != 1) {
    refuse(where, found == 0
                      ? fmt::format("has no column '{}' (it has {})", name, fmt::join(header, ", "))
                      : fmt::format("has {} columns '{}'", found, name));
  }
  return static_cast<std::size_t>(std::ranges::find(header, name) - header.begin());
}

std::vector<std::string> columns_like(const Header& header, std::string_view pattern) {
  std::vector<std::string> found;
  for (const std::string& name : header) {
    if (pattern.starts_with('.') ? name.ends_with(pattern) : is_same_word(name, pattern)) {
      found.push_back(name);
    }
  }
  return found;
}

struct Wanted {
  std::string_view option;
  std::string chosen;
  Names usual;
  bool may_be_none{false};  // by the option's value `no_column`
};

// A column is there once, whatever is not asked for by its name.
std::optional<std::size_t> find(const Header& header, const Wanted& wanted,
                                const std::string& where) {
  if (wanted.may_be_none && wanted.chosen == no_column) {
    return std::nullopt;
  }
  if (!wanted.chosen.empty()) {
    return place_of_named(header, wanted.chosen, where);
  }
  const std::string otherwise =
      wanted.may_be_none ? fmt::format(" ({} {}: none)", wanted.option, no_column) : "";
  for (const std::string_view pattern : wanted.usual) {
    const std::vector<std::string> found = columns_like(header, pattern);
    if (found.size() > 1 && found.front() == found.back()) {
      refuse(where, fmt::format("has {} columns '{}': rename all but one{}", found.size(),
                                found.front(), otherwise));
    }
    if (found.size() > 1) {
      refuse(where, fmt::format("{} could be meant: name one of them by {}{}",
                                fmt::join(found, ", "), wanted.option, otherwise));
    }
    if (!found.empty()) {
      return place_of_named(header, found.front(), where);
    }
  }
  return std::nullopt;
}

std::size_t need(const Header& header, const Wanted& wanted, const std::string& where) {
  const auto found = find(header, wanted, where);
  if (!found) {
    constexpr std::size_t ends = std::string_view{"-column"}.size();  // --stimulus-column
    refuse(where, fmt::format("no column is known to hold the {}: name one by {} (there are {})",
                              wanted.option.substr(2, wanted.option.size() - 2 - ends),
                              wanted.option, fmt::join(header, ", ")));
  }
  return *found;
}

// A name may say its unit.
double unit_in(std::string_view name, double otherwise) {
  for (const std::string_view end : {"_ms", "(ms)", "[ms]"}) {
    if (name.ends_with(end)) {
      return 1e-3;
    }
  }
  const bool is_in_seconds = std::ranges::any_of(
      std::array{"_s", "(s)", "[s]"}, [&](const char* end) { return name.ends_with(end); });
  return is_in_seconds ? 1.0 : otherwise;
}
}  // namespace

bool is_missing(const std::string& cell) {
  static constexpr std::array known{"",     "NA",   "<NA>", "N/A", "n/a",       "None",
                                    "null", "NULL", "NaN",  "nan", "undefined", "timeout"};
  return std::ranges::find(known, cell) != known.end();
}

bool is_no_count(const std::string& name) {
  static constexpr std::array parts{"trial", "index",    "order",    "time",
                                    "block", "position", "duration", "session"};
  static constexpr std::array words{"rt", "age", "id", "nr", "no", "run", "row", "date", "seed"};
  const std::string small = core::lower_case(name);
  const auto is_within = [&](const char* part) { return small.find(part) != std::string::npos; };
  const auto is_a_word = [&](const std::string& word) {
    const std::size_t at = small.find(word);
    const auto is_letter = [&](std::size_t place) {
      return place < small.size() && std::isalpha(static_cast<unsigned char>(small[place])) != 0;
    };
    return at != std::string::npos && !is_letter(at + word.size()) &&
           (at == 0 || !is_letter(at - 1));
  };
  return std::ranges::any_of(parts, is_within) || std::ranges::any_of(words, is_a_word);
}

bool is_share(const std::string& name) {
  static constexpr std::array known{"percent",  "percentage", "pct",        "perc",
                                    "%",        "share",      "proportion", "proportions",
                                    "prop",     "p.hat",      "fraction",   "frac",
                                    "rel_freq", "rel.freq",   "rate",       "probability"};
  return std::ranges::any_of(known, [&](const char* word) { return is_same_word(name, word); });
}

bool may_be_counts(const std::string& name) {
  static constexpr std::array whole{"", "0", "size", "num", "number", "times", "total", "cases"};
  static constexpr std::array parts{"count", "freq", "anzahl", "weight"};
  const std::string small = core::lower_case(name);
  const auto is_small = [&](const char* word) { return small == word; };
  const auto is_within = [&](const char* word) { return small.find(word) != std::string::npos; };
  return std::ranges::any_of(whole, is_small) || std::ranges::any_of(parts, is_within) ||
         small.starts_with("n_") || small.ends_with("_n");
}

std::string described_column(const std::vector<std::string>& header, std::size_t place) {
  return header[place].empty() ? fmt::format("column {}, which has no name,", place + 1)
                               : fmt::format("column '{}'", header[place]);
}

namespace {
constexpr std::array weight_names{"n", "freq", "frequency", "count", "counts", "weight", "weights"};

// What is noted beside answers under the name of what was asked: key_resp.corr beside
// key_resp.keys, Plate.ACC beside Plate.RESP.
std::vector<std::string> names_beside(const std::string& answered) {
  const std::size_t end = answered.find_last_of("._");
  if (end == std::string::npos || end == 0) {
    return {};
  }
  std::vector<std::string> names;
  for (const char* const suffix : {"corr", "acc", "correct"}) {
    names.push_back(answered.substr(0, end + 1) + suffix);
  }
  return names;
}

void find_what_rows_say(const Header& header, const AnswerColumns& chosen,
                        const AnswerFormat& format, const std::string& where,
                        AnswerPlaces& places) {
  if (!places.is_own_export || !chosen.weight.empty()) {
    places.weight =
        find(header, {"--weights", chosen.weight, {weight_names.begin(), weight_names.end()}, true},
             where);
  }
  const std::vector<std::string> beside = names_beside(header[places.response]);
  Names correct{beside.begin(), beside.end()};
  if (!header[places.response].ends_with(".keys")) {  // else others are of other questions
    correct.insert(correct.end(), format.correct.begin(), format.correct.end());
  }
  places.correct = find(header, {"--correct-column", chosen.correct, correct, true}, where);
  for (const std::string_view name : format.runs) {
    if (const std::vector<std::string> found = columns_like(header, name); found.size() == 1) {
      places.runs.push_back(place_of_named(header, found.front(), where));
    }
  }
}

// Otherwise people who differ would be taken for one.
void check_may_not_tell_people(const Header& header, const AnswerPlaces& places,
                               const std::string& where) {
  constexpr std::array<std::string_view, 6> words{"participant", "subject",  "proband",
                                                  "respondent",  "prolific", "worker"};
  constexpr std::array<std::string_view, 5> names{"vp", "vpn", "pid", "responseid", "observer"};
  for (std::size_t place = 0; place < header.size(); ++place) {
    const std::string small = core::lower_case(header[place]);
    const auto is_within = [&](std::string_view word) {
      return small.find(word) != std::string::npos;
    };
    const bool may_tell =
        std::ranges::any_of(words, is_within) || std::ranges::find(names, small) != names.end();
    if (may_tell && place != places.stimulus && place != places.response) {
      refuse(where, fmt::format("column '{0}' may say whose answers these are: "
                                "--participant-column '{0}', or --participant-column {1} if "
                                "nothing does",
                                header[place], no_column));
    }
  }
}
}  // namespace

AnswerPlaces find_columns(const Header& header, const AnswerColumns& chosen,
                          const std::string& where) {
  const AnswerFormat& format = format_of(header);
  AnswerPlaces places;
  places.stimulus = need(header, {"--stimulus-column", chosen.stimulus, format.stimulus}, where);
  places.response = need(header, {"--response-column", chosen.response, format.response}, where);
  places.participant =
      find(header, {"--participant-column", chosen.participant, format.participant, true}, where);
  if (!places.participant && chosen.participant.empty()) {
    check_may_not_tell_people(header, places, where);
  }
  places.mode = find(header, {"", "", {"mode"}}, where);
  // times of another column than the answers' would be another question's
  Names times = format.time;
  const std::string& answered = header[places.response];
  const std::string own_time = answered.substr(0, answered.rfind('.')) + ".rt";
  if (answered.ends_with(".keys")) {
    times = {own_time};
  }
  places.time = find(header, {"--time-column", chosen.time, times}, where);
  if (places.time) {
    places.time_unit_s = chosen.time_unit_s > 0.0
                             ? chosen.time_unit_s
                             : unit_in(header[*places.time], format.time_unit_s);
    if (!(places.time_unit_s > 0.0)) {
      refuse(where, fmt::format("column '{}' does not say in what its times are: --time-unit s or "
                                "--time-unit ms",
                                header[*places.time]));
    }
  }
  for (const RowCondition& condition : format.counted) {
    if (const auto place = find(header, {"", "", {condition.column}}, where)) {
      places.counted.push_back({*place, condition.value, condition.is_excluded});
    }
  }
  if (!format.block.empty()) {
    places.block = find(header, {"", "", {format.block}}, where);
  }
  const auto usual = std::ranges::find_if(header, [](const std::string& name) {
    return std::ranges::any_of(std::array{"rt", "response_time", "reaction_time"},
                               [&](const char* known) { return is_same_word(name, known); });
  });
  places.possible_time = places.time || usual == header.end() ? "" : *usual;
  places.is_own_export = !format.block.empty();
  find_what_rows_say(header, chosen, format, where, places);
  return places;
}

bool has_answers(const Header& header) {
  return !format_of(header).marks.empty() || (has(header, "stimulus") && has(header, "response"));
}
}  // namespace tapstudy::analysis
