#pragma once
#include <string>
namespace tapstudy::runner {
// One of so many shares of a simulation, which are computed each for itself, on whatever machines,
// and merged. The whole is the one share of one.
struct Share {
  int number{1};  // from 1
  int of{1};
  bool operator==(const Share& other) const = default;
};
// "2/5". Throws InvalidInput if the text is no such pair.
Share share_from(const std::string& text);
std::string to_text(const Share& share);

// Those of `count` participants or studies, counted from 0, that a share has: as many as any other
// or one more, one after the other.
struct SharedOut {
  int first{};
  int end{};  // not among them
};
// Throws InvalidInput if there are more shares than are shared out; `what`: "participants".
SharedOut part_of(const Share& share, int count, const std::string& what);
}  // namespace tapstudy::runner
