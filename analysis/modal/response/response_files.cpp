#include "analysis/modal/response/response_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#include "analysis/modal/response/response_table.hpp"
#include "analysis/modal/response/universal_responses.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
bool is_universal(const std::string& file) {
  const std::string::size_type dot = file.rfind('.');
  const std::string ending = dot == std::string::npos ? "" : file.substr(dot);
  return ending == ".uff" || ending == ".unv" || ending == ".uf" || ending == ".UFF" ||
         ending == ".UNV" || ending == ".UF";
}

void check_axis(const std::string& file, const Eigen::ArrayXd& frequency_hz) {
  for (Eigen::Index i = 1; i < frequency_hz.size(); ++i) {
    if (!(frequency_hz[i] > frequency_hz[i - 1])) {
      throw core::InvalidInput{fmt::format("{}: its frequencies do not ascend: {:g} after {:g} Hz",
                                           file, frequency_hz[i], frequency_hz[i - 1])};
    }
  }
}

bool is_same_axis(const Eigen::ArrayXd& one, const Eigen::ArrayXd& other) {
  if (one.size() != other.size()) {
    return false;
  }
  constexpr double share_of_step = 0.01;
  const double step = (one[one.size() - 1] - one[0]) / static_cast<double>(one.size() - 1);
  return ((one - other).abs() < share_of_step * step).all();
}

std::string axis_in_words(const Eigen::ArrayXd& hz) {
  return fmt::format("{} frequencies from {:g} to {:g} Hz", hz.size(), hz[0], hz[hz.size() - 1]);
}

ResponseKind agreed_kind(const ReadResponse& response, std::optional<ResponseKind> given) {
  if (response.kind && given && *response.kind != *given) {
    throw core::InvalidInput{fmt::format("{}: {} says it is of {}, --response {}", response.place,
                                         name(response.pair), name(*response.kind), name(*given))};
  }
  if (!response.kind && !given) {
    throw core::InvalidInput{fmt::format(
        "{}: does not say what its responses are: --response receptance, mobility or accelerance",
        response.place)};
  }
  return given.value_or(response.kind.value_or(ResponseKind::accelerance));
}

void check_beside(const ReadResponse& response, const std::vector<ReadResponse>& before) {
  if (!response.values.allFinite() || !response.frequency_hz.allFinite()) {
    throw core::InvalidInput{
        fmt::format("{}: {} has values that are not finite", response.place, name(response.pair))};
  }
  if (response.values.norm() == 0.0) {
    throw core::InvalidInput{
        fmt::format("{}: {} is zero everywhere", response.place, name(response.pair))};
  }
  for (const ReadResponse& other : before) {
    if (other.pair == response.pair) {
      throw core::InvalidInput{fmt::format("{}: the response {} is there twice (before: {})",
                                           response.place, name(response.pair), other.place)};
    }
  }
  if (!before.empty() && !is_same_axis(before.front().frequency_hz, response.frequency_hz)) {
    throw core::InvalidInput{
        fmt::format("{}: {} has {}, {} has {}: all must have the same", response.place,
                    name(response.pair), axis_in_words(response.frequency_hz),
                    name(before.front().pair), axis_in_words(before.front().frequency_hz))};
  }
}

// All but a first line at 0 Hz, where nothing vibrates.
Eigen::Index first_line(const Eigen::ArrayXd& frequency_hz) {
  return frequency_hz[0] > 0.0 ? 0 : 1;
}
}  // namespace

bool holds_responses(const std::string& file) {
  return is_universal(file) ? is_universal_of_responses(file) : is_table_of_responses(file);
}

FrequencyResponses read_responses(const std::vector<std::string>& files,
                                  std::optional<ResponseKind> given) {
  FrequencyResponses all;
  std::vector<ReadResponse> read;
  for (const std::string& file : files) {
    std::vector<ReadResponse> of_file = is_universal(file) ? universal_responses(file, all.remarks)
                                                           : responses_of_table(file, all.remarks);
    for (ReadResponse& response : of_file) {
      if (response.frequency_hz.size() < min_response_lines) {
        throw core::InvalidInput{fmt::format("{}: {} has {} frequencies (at least {})",
                                             response.place, name(response.pair),
                                             response.frequency_hz.size(), min_response_lines)};
      }
      check_axis(response.place, response.frequency_hz);
      check_beside(response, read);
      const ResponseKind kind = agreed_kind(response, given);
      if (!read.empty() && kind != all.kind) {
        throw core::InvalidInput{fmt::format("{}: {} is of {}, those before of {}: all must be one",
                                             response.place, name(response.pair), name(kind),
                                             name(all.kind))};
      }
      all.kind = kind;
      read.push_back(std::move(response));
    }
  }
  const Eigen::ArrayXd& axis = read.front().frequency_hz;
  const Eigen::Index first = first_line(axis);
  all.frequency_hz = axis.tail(axis.size() - first);
  all.values.resize(axis.size() - first, std::ssize(read));
  for (std::size_t i = 0; i < read.size(); ++i) {
    all.pairs.push_back(read[i].pair);
    all.values.col(static_cast<Eigen::Index>(i)) = read[i].values.tail(axis.size() - first);
  }
  return all;
}
}  // namespace tapstudy::analysis
