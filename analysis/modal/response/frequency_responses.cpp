#include "analysis/modal/response/frequency_responses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
constexpr std::array<std::pair<const char*, ResponseKind>, 3> kinds{
    {{"receptance", ResponseKind::receptance},
     {"mobility", ResponseKind::mobility},
     {"accelerance", ResponseKind::accelerance}}};

std::vector<std::string> distinct(const std::vector<ResponsePair>& pairs,
                                  std::string ResponsePair::*place) {
  std::vector<std::string> all;
  for (const ResponsePair& pair : pairs) {
    if (std::ranges::find(all, pair.*place) == all.end()) {
      all.push_back(pair.*place);
    }
  }
  return all;
}

std::vector<Eigen::Index> columns_of(const std::vector<ResponsePair>& pairs,
                                     const std::string& output,
                                     const std::vector<std::string>& inputs, bool is_transposed) {
  std::vector<Eigen::Index> columns;
  for (const std::string& input : inputs) {
    const ResponsePair wanted =
        is_transposed ? ResponsePair{input, output} : ResponsePair{output, input};
    const auto found = std::ranges::find(pairs, wanted);
    if (found != pairs.end()) {
      columns.push_back(found - pairs.begin());
    }
  }
  return columns;
}
}  // namespace

ResponseKind response_kind_from(const std::string& word) {
  for (const auto& [text, kind] : kinds) {
    if (word == text) {
      return kind;
    }
  }
  throw core::InvalidInput{
      fmt::format("'{}' is no kind of response (receptance, mobility or accelerance)", word)};
}

const char* name(ResponseKind kind) {
  return std::ranges::find(kinds, kind, &std::pair<const char*, ResponseKind>::second)->first;
}

std::string name(const ResponsePair& pair) {
  return pair.reference.empty() ? pair.response : pair.response + "/" + pair.reference;
}

ResponseGrid grid_of(const std::vector<ResponsePair>& pairs) {
  std::vector<std::string> outputs = distinct(pairs, &ResponsePair::response);
  std::vector<std::string> inputs = distinct(pairs, &ResponsePair::reference);
  const bool is_transposed = outputs.size() < inputs.size();
  if (is_transposed) {
    std::swap(outputs, inputs);
  }
  ResponseGrid grid;
  grid.is_complete = outputs.size() * inputs.size() == pairs.size();
  if (grid.is_complete) {
    for (const std::string& output : outputs) {
      grid.columns.push_back(columns_of(pairs, output, inputs, is_transposed));
      grid.places.push_back(output);
    }
    return grid;
  }
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    grid.columns.push_back({static_cast<Eigen::Index>(i)});
    grid.places.push_back(name(pairs[i]));
  }
  return grid;
}

FrequencyResponses within(const FrequencyResponses& responses, const Band& band) {
  std::vector<Eigen::Index> lines;
  for (Eigen::Index i = 0; i < responses.frequency_hz.size(); ++i) {
    if (band.holds(responses.frequency_hz[i])) {
      lines.push_back(i);
    }
  }
  if (std::ssize(lines) < min_response_lines) {
    throw core::InvalidInput{
        fmt::format("{} frequencies of the responses lie within {:g} to {:g} Hz (at least {})",
                    lines.size(), band.low_hz, band.high_hz, min_response_lines)};
  }
  FrequencyResponses inside = responses;
  inside.frequency_hz = responses.frequency_hz(lines).eval();
  inside.values = responses.values(lines, Eigen::all).eval();
  return inside;
}
}  // namespace tapstudy::analysis
