#pragma once
#include <set>
#include <string>
#include <utility>
namespace tapstudy::results {
struct Redaction {
  std::set<std::pair<std::string, std::string>> kept_items{};  // (form, item)
  std::string prefix = "person";                               // of the participants' new ids
};
// Fills a directory with a copy of a study, study.db and answers.journal, in which
//   participants are called person-001, person-002, … in the order of their first session,
//   what operators wrote (notes, reasons, details of actions, reasons of a stop) is "(removed)",
//   answers to questionnaires are "(removed)", but those of the kept items,
//   the protocol's file has its name without a directory.
// What is removed is never written to the copy; its journal is a new chain. Everything else is the
// same: protocol, rigs, times, traces. Throws InvalidInput if there is no study, StoreError if it
// cannot be read or the copy not written.
void write_redacted_copy(const std::string& directory, const std::string& copy,
                         const Redaction& redaction);
}  // namespace tapstudy::results
