#pragma once
#include <string>
#include <vector>

#include "analysis/modal/recording/taps.hpp"
namespace tapstudy::runner {
// What was noticed about taps: one sentence a kind.
class TapRemarks {
 public:
  void add(const std::string& file, const analysis::TapRemark& remark);
  // "9 of 23 taps: cut at the next one (taps.wav at 0.300, 0.750, 1.200 s ...)", or of one of
  // them its detail, in the order in which kinds appeared.
  std::vector<std::string> sentences(int impacts) const;

 private:
  struct Noticed {
    std::string file;
    analysis::TapRemark remark;
  };
  static std::string places_of(const std::vector<Noticed>& kind);
  static std::string sentence_of(const std::vector<Noticed>& kind, int impacts);

  std::vector<std::vector<Noticed>> kinds_;
};
}  // namespace tapstudy::runner
