#pragma once
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "analysis/statistics/confusion_matrix.hpp"
#include "analysis/statistics/proportion.hpp"
#include "core/text/citations.hpp"
namespace tapstudy::analysis {
using core::CitingText;
using core::operator""_source;

// A value as programs read it; unset where there is none. Infinite numbers are "inf" and "-inf".
using Value = std::variant<std::monostate, bool, std::int64_t, double, std::string>;

// heading: as people read it; empty: the column is in JSON and CSV only.
// keys: of its values in JSON and CSV (a value and its interval are three).
struct Column {
  CitingText heading;
  std::vector<std::string> keys;
};

// A share with its interval, drawn on a scale from 0 to 100 % with chance as a line.
struct Dot {
  double share{};
  Interval interval;
  double chance{};
};

// text: as people read it, in text and HTML. values: as many as the column has keys.
struct Cell {
  CitingText text;
  std::vector<Value> values;
  std::optional<Dot> dot{};  // drawn beside the text on the page
  std::string style{};       // a class of the page; of a matrix, "correct": counts right answers
  std::string anchor{};      // of what the text is about, on the page
};

// The formats that a table is written in.
struct ShownIn {
  bool text{true};
  bool page{true};
  bool latex{true};
  bool json{true};
  bool csv{true};
};
inline constexpr ShownIn programs_only{false, false, false, true, true};
inline constexpr ShownIn page_only{false, true, false, false, false};

struct ReportTable {
  std::string name;  // its key in JSON, its file in CSV
  CitingText title;
  std::vector<Column> columns;
  std::vector<std::vector<Cell>> rows{};
  ShownIn shown_in{};  // programs_only: people see a figure
  CitingText note{};   // below it on the page
  // Counts of answers to each stimulus: shaded by their share of the row on the page; a terminal
  // shows the names of stimuli and answers, which are shorter than their labels.
  bool is_matrix{};
};

// Of a table on a terminal, if it is not cut.
inline constexpr std::size_t all_lines = std::numeric_limits<std::size_t>::max();

// "0.123", with so many significant digits; "–" for NaN
std::string rounded(double value, int significant_digits = 3);
// "0.12 (0.1 to 0.15)"
std::string with_interval(double value, const Interval& interval);

Cell word(const CitingText& text);
Cell labelled(const Item& item);  // its label for people, its name for programs
Cell count(std::int64_t number);
Cell flag(bool is_so);
Cell number(double value, int significant_digits = 3);
Cell number(const std::optional<double>& value);  // "–" if unset
Cell share(double value);                         // "54 %"
Cell probability(const std::optional<double>& p);
Cell interval(double value, const Interval& interval);
// Of one that may have no interval.
Cell interval(double value, const std::optional<Interval>& interval);
// Of two values a difference or, by the logarithms' difference, their ratio.
Cell difference_or_ratio(double difference, const std::optional<Interval>& interval, bool is_ratio);
// "6 of 8" where nothing is known of some who took part, else "8". Values: both numbers.
Cell people_known(std::int64_t known, std::int64_t took_part);
// Of one that is cut off at 0: without its interval where nothing is left of it, which would look
// like certainty.
Cell interval_above_zero(double value, const Interval& interval);
// Of the mean of one value or more; by t of two or more.
Cell mean_with_interval(const std::vector<double>& values);
// The same of what is never below 0, such as times and forces: positive_interval.
Cell mean_of_positive(const std::vector<double>& values);
// Values: successes, trials, their ratio and its 95 % score interval.
Cell proportion(const Proportion& proportion);
// Values: successes, trials, their ratio. "43/80 = 54 %"
Cell counted(const Proportion& proportion);
Cell nothing(const Column& column, const std::string& text = "–");

Column column(const CitingText& heading, const std::string& key);
Column interval_column(const CitingText& heading, const std::string& key);
Column counted_column(const CitingText& heading, const std::string& key);
// Of people: KEY and KEY_of.
Column people_column(const CitingText& heading, const std::string& key);
Column proportion_column(const CitingText& heading, const std::string& key);
}  // namespace tapstudy::analysis
