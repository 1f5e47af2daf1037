#pragma once
#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "analysis/modal/decay/free_decay.hpp"
namespace tapstudy::analysis {
// The motion per unit of force that was measured: displacement, velocity or acceleration, which is
// the order of the derivative.
enum class ResponseKind { receptance, mobility, accelerance };

// "receptance" ... Throws InvalidInput for another word.
ResponseKind response_kind_from(const std::string& word);
const char* name(ResponseKind kind);

// Where the motion was measured and where the force acted: node and direction, "12+Z", or any name.
// Of a table without references both may be unknown: the reference is then empty.
struct ResponsePair {
  std::string response;
  std::string reference;
  bool operator==(const ResponsePair& other) const = default;
};
// "12+Z/1+Z", or the response alone.
std::string name(const ResponsePair& pair);

// Frequency responses at the same frequencies.
struct FrequencyResponses {
  ResponseKind kind{};
  Eigen::ArrayXd frequency_hz;  // ascending, above 0
  std::vector<ResponsePair> pairs;
  Eigen::MatrixXcd values;           // a row for each frequency, a column for each pair
  std::vector<std::string> remarks;  // sentences: what was noticed while reading
};

// Which column of FrequencyResponses::values belongs to which output and input. Inputs are the
// references or, where fewer places respond than are struck, by reciprocity the responses. Where
// not every pair was measured, each is an output of one input.
struct ResponseGrid {
  std::vector<std::vector<Eigen::Index>> columns;  // of each output, one for each input
  std::vector<std::string> places;                 // of the outputs
  bool is_complete{};
};
ResponseGrid grid_of(const std::vector<ResponsePair>& pairs);

// The frequencies inside the band. Throws InvalidInput if there are fewer than min_response_lines.
inline constexpr Eigen::Index min_response_lines = 16;
FrequencyResponses within(const FrequencyResponses& responses, const Band& band);
}  // namespace tapstudy::analysis
