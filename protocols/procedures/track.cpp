#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "protocols/procedures/procedure.hpp"
namespace tapstudy::protocols {
std::optional<std::vector<double>> Track::next() const {
  if (is_finished()) {
    return std::nullopt;
  }
  return request();
}

void Track::observe(const std::vector<double>& presented, std::size_t outcome) {
  if (presented.size() != axes_ ||
      !std::ranges::all_of(presented, [](double value) { return std::isfinite(value); })) {
    throw core::InvalidInput{
        fmt::format("a stimulus of this procedure is {} finite values", axes_)};
  }
  if (outcome >= outcomes_) {
    throw core::InvalidInput{
        fmt::format("outcome {}: outcomes of this procedure are 0 to {}", outcome, outcomes_ - 1)};
  }
  if (is_finished()) {
    throw core::InvalidInput{fmt::format("the procedure has ended after {} trials", trials_)};
  }
  take(presented, outcome);
  ++trials_;
}
}  // namespace tapstudy::protocols
