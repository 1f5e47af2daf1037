#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "analysis/modal/recording/recording.hpp"
namespace tapstudy::analysis {
// Seconds per unit of what a time column or variable is called: "t", "time_us", "Time (ms)",
// "Zeit [s]", "timestamp_us", "X_Value", "second" ...; 0: that is not the name of a time.
double seconds_per_unit(const std::string& name);

// The rate of the even times nearest to these (least squares) [1 / their unit]. place(i) begins the
// message about one of them, "file:line" or "file". Throws InvalidInput for times that do not
// ascend, or are further from a grid than max_jitter_periods.
double rate_of_times(const std::vector<double>& times,
                     const std::function<std::string(std::size_t)>& place);

// The rate that holds: the file's, the one given if they are the same within 0.1 % or it is to be
// trusted, which adds a remark. place begins the message, stated is how the file says its rate:
// "its times say". Throws InvalidInput for no rate, for two that differ, and for one that is not
// above 0.
double agreed_rate(std::optional<double> of_file_hz, const ReadingOptions& options,
                   const std::string& place, const std::string& stated,
                   std::vector<std::string>& remarks);
}  // namespace tapstudy::analysis
