#include "analysis/modal/response/universal_responses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "analysis/modal/recording/universal_records.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
constexpr int displacement = 8;
constexpr int velocity = 11;
constexpr int acceleration = 12;
constexpr int reaction_force = 9;
constexpr int excitation_force = 13;

std::string kind_of_function(int type) {
  switch (type) {
    case time_response:
      return "time record";
    case auto_spectrum:
      return "auto spectrum";
    case cross_spectrum:
      return "cross spectrum";
    case coherence:
      return "coherence";
    default:
      return fmt::format("function of type {}", type);
  }
}

// "2 of kind coherence, 1 of kind auto spectrum"; empty if there is nothing but responses.
std::string other_functions(const std::vector<DataSet58>& sets) {
  std::map<std::string, int> counts;
  for (const DataSet58& set : sets) {
    if (set.function_type != frequency_response) {
      ++counts[kind_of_function(set.function_type)];
    }
  }
  std::string text;
  for (const auto& [kind, count] : counts) {
    text += fmt::format("{}{} of kind {}", text.empty() ? "" : ", ", count, kind);
  }
  return text;
}

std::optional<ResponseKind> kind_of(const DataSet58& set, const std::string& place) {
  const bool is_by_force = set.denominator == excitation_force || set.denominator == reaction_force;
  if (!is_by_force && set.denominator > 1) {  // 0 and 1 are unknown and general
    throw core::InvalidInput{
        fmt::format("{}: its denominator is no force (type {}): responses by forces are read",
                    place, set.denominator)};
  }
  switch (set.numerator) {
    case displacement:
      return ResponseKind::receptance;
    case velocity:
      return ResponseKind::mobility;
    case acceleration:
      return ResponseKind::accelerance;
    default:
      return std::nullopt;
  }
}

ReadResponse response_of(const DataSet58& set, const std::string& file) {
  ReadResponse read;
  read.place = fmt::format("{}:{}", file, set.line);
  if (set.complex_samples.empty()) {
    throw core::InvalidInput{fmt::format(
        "{}: a frequency response must be complex and at even steps of frequency (uneven ones can "
        "be read from a table)",
        read.place)};
  }
  if (set.response.empty() || set.reference.empty()) {
    throw core::InvalidInput{
        fmt::format("{}: a frequency response must state the nodes and "
                    "directions of its response and of its reference",
                    read.place)};
  }
  if (!(set.increment > 0.0)) {
    throw core::InvalidInput{
        fmt::format("{}: its step of frequency is not above 0 ({:g})", read.place, set.increment)};
  }
  read.pair = {set.response, set.reference};
  read.kind = kind_of(set, read.place);
  const auto count = std::ssize(set.complex_samples);
  read.frequency_hz = set.first + set.increment * Eigen::ArrayXd::LinSpaced(
                                                      count, 0.0, static_cast<double>(count - 1));
  read.values = Eigen::Map<const Eigen::VectorXcd>(set.complex_samples.data(), count);
  return read;
}
}  // namespace

bool is_universal_of_responses(const std::string& file) {
  const std::vector<DataSet58> sets = read_data_sets_58(file);
  return !sets.empty() && std::ranges::none_of(sets, [](const DataSet58& set) {
    return set.function_type == time_response;
  });
}

std::vector<ReadResponse> universal_responses(const std::string& file,
                                              std::vector<std::string>& remarks) {
  const std::vector<DataSet58> sets = read_data_sets_58(file);
  std::vector<ReadResponse> all;
  for (const DataSet58& set : sets) {
    if (set.function_type == frequency_response) {
      all.push_back(response_of(set, file));
    }
  }
  const std::string others = other_functions(sets);
  if (all.empty()) {
    throw core::InvalidInput{fmt::format("{}: holds no frequency response (function type 4){}{}",
                                         file, others.empty() ? "" : ", but ", others)};
  }
  if (!others.empty()) {
    remarks.push_back(fmt::format("{}: left out: {}", file, others));
  }
  return all;
}
}  // namespace tapstudy::analysis
