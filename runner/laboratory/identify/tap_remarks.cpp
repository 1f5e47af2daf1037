#include "runner/laboratory/identify/tap_remarks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>
namespace tapstudy::runner {
namespace {
constexpr std::size_t most_places = 5;
}  // namespace

void TapRemarks::add(const std::string& file, const analysis::TapRemark& remark) {
  const auto kind = std::ranges::find_if(kinds_, [&](const std::vector<Noticed>& one) {
    return one.front().remark.kind == remark.kind;
  });
  if (kind == kinds_.end()) {
    kinds_.push_back({{file, remark}});
  } else {
    kind->push_back({file, remark});
  }
}

std::vector<std::string> TapRemarks::sentences(int impacts) const {
  std::vector<std::string> all;
  for (const std::vector<Noticed>& kind : kinds_) {
    std::set<std::pair<std::string, double>> taps;
    std::string places;
    const std::string* file = nullptr;
    for (const Noticed& one : kind) {
      if (!taps.emplace(one.file, one.remark.at_s).second || taps.size() > most_places) {
        continue;
      }
      const bool is_same_file = file != nullptr && *file == one.file;
      places += fmt::format("{}{}{:.3f}",
                            places.empty() ? ""
                            : is_same_file ? ", "
                                           : " s; ",
                            is_same_file ? "" : one.file + " at ", one.remark.at_s);
      file = &one.file;
    }
    const analysis::TapRemark& first = kind.front().remark;
    const bool is_one = taps.size() == 1 && !first.detail.empty();
    all.push_back(fmt::format("{} of {} taps: {}{}{} ({} s{})", taps.size(), impacts, first.kind,
                              is_one ? ", " : "", is_one ? first.detail : "", places,
                              taps.size() > most_places ? " ..." : ""));
  }
  return all;
}
}  // namespace tapstudy::runner
