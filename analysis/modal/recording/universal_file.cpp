#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "analysis/modal/recording/sampling.hpp"
#include "analysis/modal/recording/universal_records.hpp"
#include "core/error.hpp"
#include "core/text/plain_text.hpp"
namespace tapstudy::analysis {
namespace {
std::string refusal_without_times(const std::string& file, const std::vector<DataSet58>& sets) {
  if (sets.empty()) {
    return file + ": holds no data set 58 (a universal file of time records)";
  }
  const DataSet58& first = sets.front();
  if (first.function_type == time_response) {
    return file +
           ": its time records are complex or unevenly spaced: real ones at even times are "
           "read";
  }
  return fmt::format(
      "{}: holds no time record (function type 1), but functions of type {}{}: identify takes the "
      "recordings themselves",
      file, first.function_type, first.function_type == 4 ? ", frequency responses" : "");
}

std::size_t chosen_record(const std::vector<DataSet58>& records, const std::string& column,
                          const std::string& file) {
  const auto named = std::ranges::find(records, column, &DataSet58::response);
  if (!column.empty() && named != records.end()) {
    return static_cast<std::size_t>(named - records.begin());
  }
  const auto number = core::number_in<std::size_t>(column);
  if (number && *number >= 1 && *number <= records.size()) {
    return *number - 1;
  }
  if (column.empty() && records.size() == 1) {
    return 0;
  }
  std::vector<std::string> names;
  std::ranges::transform(records, std::back_inserter(names), &DataSet58::response);
  throw core::InvalidInput{
      fmt::format("{}: has {} time records (choose one by --column 1 ... {}, "
                  "or by node and direction: {})",
                  file, records.size(), records.size(), fmt::join(names, ", "))};
}
}  // namespace

Recording read_universal_file(const std::string& file, const ReadingOptions& options) {
  std::vector<DataSet58> sets = read_data_sets_58(file);
  std::vector<DataSet58> records;
  std::ranges::copy_if(sets, std::back_inserter(records),
                       [](const DataSet58& set) { return !set.samples.empty(); });
  if (records.empty()) {
    throw core::InvalidInput{refusal_without_times(file, sets)};
  }
  const std::size_t chosen = chosen_record(records, options.column, file);
  const DataSet58& record = records[chosen];
  Recording recording{
      file,
      record.response.empty() ? fmt::format("record {}", chosen + 1) : record.response,
      0.0,
      record.samples,
      {}};
  recording.unit = record.unit;
  check_samples(recording);
  const double rate_hz = record.increment > 0.0 ? 1.0 / record.increment : 0.0;
  recording.rate_hz = agreed_rate(rate_hz, options, file, "says", recording.remarks);
  return recording;
}
}  // namespace tapstudy::analysis
