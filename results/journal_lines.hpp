#pragma once
#include <string>

#include "results/journal.hpp"
namespace tapstudy::results {
// A line of a journal: a JSON object without its chain, and the chain.
struct JournalLine {
  std::string body;
  std::string chain;  // empty where the line has none
};
JournalLine split_line(const std::string& line);
std::string join_line(const JournalLine& line);
std::string chain_of(const std::string& chain_before, const std::string& body);

// Bodies.
std::string to_line(const StudyRow& study);
std::string to_line(const SessionRow& session);
}  // namespace tapstudy::results
