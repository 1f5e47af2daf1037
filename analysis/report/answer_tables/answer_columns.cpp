#include "analysis/report/answer_tables/answer_columns.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

#include "core/error.hpp"
namespace tapstudy::analysis {
bool is_same_word(std::string_view one, std::string_view other) {
  return std::ranges::equal(one, other, [](unsigned char a, unsigned char b) {
    return std::tolower(a) == std::tolower(b);
  });
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
       {"participant_id", "participant", "subject_id", "subject"},
       {"rt"},
       1e-3,
       {"correct"},
       {"run_id", "session_id", "date", run_of_file}},
      {{},
       {"stimulus"},
       {"response"},
       {"participant_id", "participant", "subject_id", "subject", "subject_nr", "ppid"},
       {"response_time_s"},
       1.0,
       {"correct", "is_correct", "accuracy", "acc", "corr"},
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
};

std::optional<std::size_t> find(const Header& header, const Wanted& wanted,
                                const std::string& where) {
  if (!wanted.chosen.empty()) {
    return place_of_named(header, wanted.chosen, where);
  }
  for (const std::string_view pattern : wanted.usual) {
    const std::vector<std::string> found = columns_like(header, pattern);
    if (found.size() > 1) {
      refuse(where, fmt::format("{} could be meant: name one of them by {}", fmt::join(found, ", "),
                                wanted.option));
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
    refuse(where, fmt::format("no column is known to hold it: name one by {} (there are {})",
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
  return name.ends_with("_s") ? 1.0 : otherwise;
}
}  // namespace

bool is_share(const std::string& name) {
  static constexpr std::array known{"percent",    "percentage", "pct",   "%",          "share",
                                    "proportion", "prop",       "p.hat", "probability"};
  return std::ranges::any_of(known, [&](const char* word) { return is_same_word(name, word); });
}

namespace {
constexpr std::array weights{"n", "freq", "frequency", "count", "counts", "weight", "weights"};

// The column of that option; a column of a usual name that is there twice is none.
std::optional<std::size_t> optional_column(const Header& header, const std::string& chosen,
                                           const Names& usual, const std::string& where) {
  if (!chosen.empty()) {
    return chosen == no_column ? std::nullopt
                               : std::optional{place_of_named(header, chosen, where)};
  }
  for (const std::string_view name : usual) {
    const std::vector<std::string> found = columns_like(header, name);
    if (found.size() == 1) {
      return place_of_named(header, found.front(), where);
    }
  }
  return std::nullopt;
}

void find_what_rows_say(const Header& header, const AnswerColumns& chosen,
                        const AnswerFormat& format, const std::string& where,
                        AnswerPlaces& places) {
  if (!places.is_own_export || !chosen.weight.empty()) {
    places.weight = optional_column(header, chosen.weight, {weights.begin(), weights.end()}, where);
  }
  const std::string& answered = header[places.response];
  const std::string beside = answered.substr(0, answered.rfind('.')) + ".corr";
  Names correct = format.correct;
  if (answered.ends_with(".keys")) {
    correct = {beside};
  }
  places.correct = optional_column(header, chosen.correct, correct, where);
  for (const std::string_view name : format.runs) {
    if (const auto place = optional_column(header, "", {name}, where)) {
      places.runs.push_back(*place);
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
      find(header, {"--participant-column", chosen.participant, format.participant}, where);
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
