#pragma once
#include <optional>
#include <string>

#include "analysis/modal/response/frequency_responses.hpp"
namespace tapstudy::analysis {
// One response as a file has it.
struct ReadResponse {
  std::string place;  // "file" or "file:line", for messages
  ResponsePair pair;
  std::optional<ResponseKind> kind;  // unset: the file does not say
  Eigen::ArrayXd frequency_hz;
  Eigen::VectorXcd values;  // as many
};
}  // namespace tapstudy::analysis
