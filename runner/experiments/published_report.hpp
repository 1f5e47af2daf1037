#pragma once
#include <string>
#include <vector>

#include "results/store.hpp"
namespace tapstudy::runner {
// A report that lies in a study's directory, against one made anew from the stored answers.
struct PublishedReport {
  bool is_there{};
  std::string not_compared{};              // why, in words; empty: it was
  std::vector<std::string> differences{};  // "report.json /blocks/0/…: 61, made anew 41", files
};
// Compares what report.json, the tables beside it and the page hold; where it was made is left out,
// and what it leaves out (--only) is not missed; one that differs and is older than the journal's
// last entry is not compared. Throws StoreError if report.json is none.
PublishedReport published_report(const std::string& directory, results::Store& store);
}  // namespace tapstudy::runner
