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

// "taps.wav at 0.300, 0.750 s; more.wav at 0.200": the first taps of a kind, each once.
std::string TapRemarks::places_of(const std::vector<Noticed>& kind) {
  std::set<std::pair<std::string, double>> taps;
  std::string places;
  std::string file;
  for (const Noticed& one : kind) {
    if (taps.size() == most_places || !taps.emplace(one.file, one.remark.at_s).second) {
      continue;
    }
    const bool is_same_file = !places.empty() && file == one.file;
    places += places.empty() ? "" : is_same_file ? ", " : " s; ";
    places += fmt::format("{}{:.3f}", is_same_file ? "" : one.file + " at ", one.remark.at_s);
    file = one.file;
  }
  return places;
}

std::string TapRemarks::sentence_of(const std::vector<Noticed>& kind, int impacts) {
  std::set<std::pair<std::string, double>> taps;
  for (const Noticed& one : kind) {
    taps.emplace(one.file, one.remark.at_s);
  }
  const analysis::TapRemark& first = kind.front().remark;
  const bool has_detail = taps.size() == 1 && !first.detail.empty();
  return fmt::format("{} of {} taps: {}{} ({} s{})", taps.size(), impacts, first.kind,
                     has_detail ? ", " + first.detail : "", places_of(kind),
                     taps.size() > most_places ? " ..." : "");
}

std::vector<std::string> TapRemarks::sentences(int impacts) const {
  std::vector<std::string> all;
  for (const std::vector<Noticed>& kind : kinds_) {
    all.push_back(sentence_of(kind, impacts));
  }
  return all;
}
}  // namespace tapstudy::runner
