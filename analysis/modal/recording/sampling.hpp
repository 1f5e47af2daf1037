#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "analysis/modal/recording/recording.hpp"
namespace tapstudy::analysis {
// Of a time column or variable.
struct TimeUnit {
  double seconds{};  // per unit; 0: it holds no times
  bool is_stated{};  // by its name, as "time" does not, which is taken for seconds
};
// By its name: "t", "time_us", "Time (ms)", "Zeit [s]", "Time Stamp (us)", "millis", "X_Value",
// "second" ...
TimeUnit time_unit_of(const std::string& name);
// The micro sign and the Greek letter mu as u.
std::string with_ascii_micro(const std::string& text);

// Rates that differ by a larger share contradict each other: that is no rounding of times.
inline constexpr double max_rate_difference = 0.001;

// The rate of the even times nearest to these (least squares) [Hz]. place(i) begins the message
// about one of them, "file:line" or "file". Unset, with a remark, for times that do not ascend, are
// too far apart for their unit (unless the given rate is theirs), or are further from a grid than
// max_jitter_periods, if a rate is given that is to be trusted; otherwise throws InvalidInput for
// them.
std::optional<double> rate_of_times(const std::vector<double>& times, const TimeUnit& unit,
                                    const ReadingOptions& options,
                                    const std::function<std::string(std::size_t)>& place,
                                    std::vector<std::string>& remarks);

// The rate that holds: the file's, the one given if they are the same within 0.1 % or it is to be
// trusted, which adds a remark. place begins the message, stated is how the file says its rate:
// "its times say". Throws InvalidInput for no rate, for two that differ, and for one that is not
// above 0.
double agreed_rate(std::optional<double> of_file_hz, const ReadingOptions& options,
                   const std::string& place, const std::string& stated,
                   std::vector<std::string>& remarks);

// Squares of values up to this, and their sums, are finite.
inline constexpr double largest_sample = 1e100;
// Throws InvalidInput for fewer than min_samples, and with its number for a sample that is not
// finite or beyond largest_sample.
void check_samples(const Recording& recording);

// A table's text without a last line that has no line end, because nobody can tell whether its last
// number is whole; a remark says so. A text of a single line stays as it is.
std::string whole_lines(std::string text, std::vector<std::string>& remarks);
}  // namespace tapstudy::analysis
