#pragma once
#include <functional>
#include <utility>
#include <vector>

#include "results/rows.hpp"
namespace tapstudy::runner {
// What happens in a trial beside its trace: kept, and told as it happens.
class TrialEvents {
 public:
  using Tell = std::function<void(const results::EventRow&)>;
  explicit TrialEvents(Tell tell = {}) : tell_{std::move(tell)} {}
  void add(results::EventRow event) {
    rows_.push_back(std::move(event));
    if (tell_) {
      tell_(rows_.back());
    }
  }
  const std::vector<results::EventRow>& rows() const { return rows_; }

 private:
  Tell tell_;
  std::vector<results::EventRow> rows_;
};
}  // namespace tapstudy::runner
